// The vertex shader units: a pool that takes vertices in order and gives them back in order.
//
// Modelled: units that are busy for a fixed number of cycles per vertex and keep the result until it can leave.
// Not modelled: instructions; what the shader computes is known already (functional/).
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

    /// Vertices that can start in one cycle in the long run, rounded up.
    std::uint32_t vertices_per_clk() const { return (units + cycles_per_vertex - 1) / cycles_per_vertex; }

    static constexpr auto fields() {
        return std::tuple{sim::field<&VertexShaderParams::units>("Vertex shader units").unit("units").range(1, 4096),
                          sim::field<&VertexShaderParams::cycles_per_vertex>("Time of a unit for a vertex")
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
