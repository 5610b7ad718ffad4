// Clipping and culling: primitives end here or become one triangle, or several when they are clipped.
//
// Modelled: one primitive a cycle, extra cycles for each part of a clipped one; one triangle a cycle. What becomes of a
// primitive was computed before (functional/).
// Not modelled: the arithmetic of clipping; guard bands.
// Source: specification 004, section 2.1.
#pragma once

#include "pipeline/geometry/geometry_pass.hpp"
#include "pipeline/geometry/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

namespace pipeline {

struct ClipCullParams {
    std::uint32_t clip_cycles = 4;

    static constexpr auto fields() {
        return std::tuple{sim::field<&ClipCullParams::clip_cycles>("Extra time for each part of a clipped primitive")
                              .unit("cycles")
                              .at_most(10000)};
    }
};
static_assert(sim::fully_described<ClipCullParams>);

struct ClipCullStats {
    sim::Counter primitives, drawn, culled_facing, culled_outside, culled_degenerate, clipped, triangles;

    std::uint64_t culled() const { return culled_facing + culled_outside + culled_degenerate; }

    static constexpr auto fields() {
        using S = ClipCullStats;
        return std::tuple{sim::field<&S::primitives>("Primitives received; drawn + culled").unit("primitives"),
                          sim::field<&S::drawn>("Primitives that became triangles").unit("primitives"),
                          sim::field<&S::culled_facing>("Primitives that face the other way").unit("primitives"),
                          sim::field<&S::culled_outside>("Primitives outside the view").unit("primitives"),
                          sim::field<&S::culled_degenerate>("Primitives without area").unit("primitives"),
                          sim::field<&S::clipped>("Primitives cut by the view volume").unit("primitives"),
                          sim::field<&S::triangles>("Triangles sent").unit("triangles")};
    }
};
static_assert(sim::fully_described<ClipCullStats>);

class ClipCull final : public sim::Component {
  public:
    using Params = ClipCullParams;
    using Stats = ClipCullStats;

    sim::In<AssembledPrimitive> primitives_in{*this, "primitives_in"};
    sim::Out<TriangleTask> triangles_out{*this, "triangles_out"};

    ClipCull(sim::Context context, const Params& params, const GeometryPass& pass);

    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }
    /// Stats by draw; draws not seen may be missing at the end.
    const std::vector<Stats>& draw_stats() const { return draw_stats_; }

  private:
    sim::Activity tick() override;
    void take(const AssembledPrimitive& message);
    void book(const Primitive& primitive, Stats& stats) const;

    Params params_;
    const GeometryPass* pass_;
    Stats stats_;
    std::vector<Stats> draw_stats_;
    std::uint32_t next_ = 0; ///< triangle to be sent next
    std::uint32_t end_ = 0;  ///< one past the last triangle of the present primitive
    bool clipped_ = false;
    sim::Cycle ready_ = 0; ///< edge at which triangle next_ is cut
};

} // namespace pipeline
