// The early depth test: rejects fragments behind a finished depth surface before they are shaded.
//
// Built only for passes whose depth surface is read and not written, where the test cannot depend on order.
// Modelled: quads per cycle, pipeline latency (on its output link). Not modelled: its depth cache's misses.
// Source: specification 004, sections 4.3.1 remarks in 6.1 (7) and 7.7.
#pragma once

#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

namespace pipeline {

struct EarlyDepthParams {
    std::uint32_t quads_per_clk = 4;
    std::uint32_t latency = 8;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&EarlyDepthParams::quads_per_clk>("Quads tested per cycle").unit("quads").range(1, 64),
            sim::field<&EarlyDepthParams::latency>("Cycles from input to output").unit("cycles").range(1, 1000)};
    }
};
static_assert(sim::fully_described<EarlyDepthParams>);

struct EarlyDepthStats {
    sim::Counter quads, fragments, fragments_rejected, quads_rejected;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&EarlyDepthStats::quads>("Quads tested").unit("quads"),
            sim::field<&EarlyDepthStats::fragments>("Fragments tested").unit("fragments"),
            sim::field<&EarlyDepthStats::fragments_rejected>("Fragments behind the depth surface").unit("fragments"),
            sim::field<&EarlyDepthStats::quads_rejected>("Quads with no fragment left").unit("quads")};
    }
};
static_assert(sim::fully_described<EarlyDepthStats>);

class EarlyDepthTest final : public sim::Component {
  public:
    sim::In<QuadTask> quads_in{*this, "quads_in"};
    sim::Out<QuadTask> quads_out{*this, "quads_out"};

    EarlyDepthTest(sim::Context context, const EarlyDepthParams& params, const PassContext& pass)
        : Component(std::move(context)), params_(params), pass_(&pass) {}

    const EarlyDepthParams& params() const { return params_; }
    const EarlyDepthStats& stats() const { return stats_; }

  private:
    sim::Activity tick() override;
    std::uint8_t surviving(const QuadTask& task) const;

    EarlyDepthParams params_;
    const PassContext* pass_;
    EarlyDepthStats stats_;
};

} // namespace pipeline
