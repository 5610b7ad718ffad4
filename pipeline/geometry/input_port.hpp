// The port through which indices and vertices enter the GPU, as what it costs.
//
// On the GeForce 6 and 7 and the Radeon X800 the times of index bytes, vertices and attributes add up (specification
// 004, sections 4.4 and 4.6), as if one engine moved all of them, one after the other. That engine is modelled here:
// indices by their bytes; a vertex by a fixed time, by the lines it misses, and by its attributes, which cost by their
// bytes and, where they lie apart from the position, once more for the further stream. The timed unit that spends this
// is VertexFetch; the estimate adds the same numbers up. All rates off (0): the port limits nothing.
//
// Source: specification 004, section 5 (verdicts C of T3.2 and T3.4, frame-time skeleton with sigma = 1) and 4.6 (rates
// per slot).
#pragma once

#include "pipeline/geometry/host.hpp"
#include "sim/described.hpp"

#include <cstdint>
#include <vector>

namespace pipeline {

struct InputPortParams {
    double index_bytes_per_clk = 0;
    double draw_cycles = 0;
    double vertex_cycles = 0;
    double line_bytes_per_clk = 0;
    double stream_cycles = 0;
    double colour_bytes_per_clk = 0;
    double attribute_bytes_per_clk = 0;
    double interleaved_bytes_per_clk = 0;

    static constexpr auto fields() {
        using P = InputPortParams;
        constexpr auto rate = [](auto field) { return field.unit("bytes/cycle").range(0, 4096); };
        return std::tuple{
            rate(
                sim::field<&P::index_bytes_per_clk>("Indices, in turn with vertices; 0: they have a way of their own")),
            sim::field<&P::draw_cycles>("A draw, before its first vertex").unit("cycles").range(0, 1e6),
            sim::field<&P::vertex_cycles>("A vertex, whatever it consists of").unit("cycles").range(0, 10000),
            rate(sim::field<&P::line_bytes_per_clk>("Lines that the pre-transform cache misses; 0: no limit")),
            sim::field<&P::stream_cycles>("Every attribute that does not lie beside the position of its vertex")
                .unit("cycles")
                .range(0, 10000),
            rate(sim::field<&P::colour_bytes_per_clk>("Colours apart from the position; 0: no limit")),
            rate(sim::field<&P::attribute_bytes_per_clk>(
                "Normals, texture coordinates and generic attributes apart from the position; 0: no limit")),
            rate(sim::field<&P::interleaved_bytes_per_clk>("Attributes beside the position; 0: no limit"))};
    }
    bool limits() const;
};
static_assert(sim::fully_described<InputPortParams>);

/// The attributes of a geometry that are read, by where they lie.
struct InputLayout {
    struct Item {
        Slot slot = Slot::position;
        std::uint32_t bytes = 0; ///< of one vertex
        bool beside_position = false;
    };
    std::vector<Item> items; ///< without the position
};
InputLayout input_layout(const Needs& needs, const Geometry& geometry, const Material& material);

/// What moves through the port cost, in parts of a cycle, driver and bus included.
struct InputCost {
    static constexpr std::uint64_t parts_of_a_cycle = 4096;

    std::uint64_t draw = 0;       ///< of a draw, once
    std::uint64_t vertex = 0;     ///< of a vertex with its attributes, but for its lines
    std::uint64_t line = 0;       ///< of a line that is missed
    std::uint64_t index_byte = 0; ///< of a byte of indices
};

/// What of InputCost::vertex is what, for reports; the same numbers before they are rounded, in cycles.
struct InputCostParts {
    double draw = 0;
    double base = 0, attributes = 0; ///< of a vertex
    double line = 0;                 ///< through the port
    double index_byte = 0;
    double bus_draw = 0, bus_line = 0, bus_index_byte = 0; ///< what crossing the bus adds
    double slowdown = 1;                                   ///< of all of it
};

/// @param line bytes of a line of the pre-transform cache
InputCostParts input_cost_parts(const InputPortParams& params, const HostParams& host, const DrawTerms& terms,
                                const InputLayout& layout, std::uint32_t line, double core_mhz);
InputCost input_cost(const InputCostParts& parts);

} // namespace pipeline
