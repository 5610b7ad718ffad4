// The vertex shader units: a pool that takes vertices in order and gives them back in order.
//
// Modelled: units that are busy with a vertex for the time of its shader and keep the result until it can leave. A draw
// that brings no program takes that of the fixed transformation; one that does as much longer as its program, in the
// mean over the draw's vertices, has more instructions than that.
// Not modelled: single instructions; what the shader computes is known already (functional/).
// Source: specification 004, sections 7 (vs_units, vs_cycles_per_vertex), 9.2.
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/geometry/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

namespace pipeline {

struct VertexShaderParams {
    std::uint32_t units = 8;
    std::uint32_t cycles_per_vertex = 4;

    /// Of the fixed transformation: one for each row of the matrix.
    static constexpr std::uint32_t fixed_instructions = 4;

    /// Time of a unit for a vertex whose shader has so many instructions, rounded up; 0: the fixed transformation.
    std::uint64_t cycles_for(std::uint32_t instructions) const {
        if (instructions == 0) return cycles_per_vertex;
        const std::uint64_t cycles = std::uint64_t{instructions} * cycles_per_vertex;
        return (cycles + fixed_instructions - 1) / fixed_instructions;
    }
    /// Vertices of the fixed transformation that can start in one cycle in the long run, rounded up.
    std::uint32_t vertices_per_clk() const { return (units + cycles_per_vertex - 1) / cycles_per_vertex; }

    static constexpr auto fields() {
        return std::tuple{sim::field<&VertexShaderParams::units>("Vertex shader units").unit("units").range(1, 4096),
                          sim::field<&VertexShaderParams::cycles_per_vertex>(
                              "Time of a unit for a vertex, and for four instructions of a vertex program")
                              .unit("cycles")
                              .range(1, 100000)};
    }
};
static_assert(sim::fully_described<VertexShaderParams>);

struct VertexShaderStats {
    sim::Counter vertices, unit_cycles;

    static constexpr auto fields() {
        using S = VertexShaderStats;
        return std::tuple{
            sim::field<&S::vertices>("Vertices shaded").unit("vertices"),
            sim::field<&S::unit_cycles>("Cycles of units at work; over units * elapsed cycles: utilisation")
                .unit("cycles")};
    }
};
static_assert(sim::fully_described<VertexShaderStats>);

class VertexShader final : public sim::Component {
  public:
    using Params = VertexShaderParams;
    using Stats = VertexShaderStats;

    sim::In<VertexTask> vertices_in{*this, "vertices_in"};
    sim::Out<VertexTask> vertices_out{*this, "vertices_out"};

    VertexShader(sim::Context context, const Params& params);

    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }

  private:
    struct Run {
        std::uint32_t sequence = 0;
        sim::Cycle done = 0;
    };
    sim::Activity tick() override;

    Params params_;
    Stats stats_;
    FixedQueue<Run> runs_; ///< one entry per unit at work, oldest first
};

} // namespace pipeline
