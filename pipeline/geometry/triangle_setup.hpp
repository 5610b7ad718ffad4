// Triangle setup: computes edge and plane equations, one triangle at a time.
//
// Modelled: a fixed time per triangle; a queue in front, which fills while triangles come and feeds it while the stages
// before drop what faces away or lies outside.
// Not modelled: what is computed.
// Source: specification 004, section 7 (setup_cycles_per_tri).
#pragma once

#include "pipeline/geometry/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

namespace pipeline {

struct TriangleSetupParams {
    std::uint32_t cycles_per_triangle = 2;
    std::uint32_t queue = 64;

    static constexpr auto fields() {
        using P = TriangleSetupParams;
        return std::tuple{
            sim::field<&P::cycles_per_triangle>("Time of a triangle").unit("cycles").range(1, 10000),
            sim::field<&P::queue>("Triangles that wait in front of it").unit("triangles").range(2, 65536)};
    }
};
static_assert(sim::fully_described<TriangleSetupParams>);

struct TriangleSetupStats {
    sim::Counter triangles;

    static constexpr auto fields() {
        return std::tuple{sim::field<&TriangleSetupStats::triangles>("Triangles set up").unit("triangles")};
    }
};
static_assert(sim::fully_described<TriangleSetupStats>);

class TriangleSetup final : public sim::Component {
  public:
    using Params = TriangleSetupParams;
    using Stats = TriangleSetupStats;

    sim::In<TriangleTask> triangles_in{*this, "triangles_in"};
    sim::Out<TriangleTask> triangles_out{*this, "triangles_out"};

    TriangleSetup(sim::Context context, const Params& params);

    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }

  private:
    sim::Activity tick() override;

    Params params_;
    Stats stats_;
    bool holding_ = false; ///< present_ is being set up or waits to leave
    TriangleTask present_;
    sim::Cycle done_ = 0;
};

} // namespace pipeline
