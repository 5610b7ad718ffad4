// The early depth test: rejects fragments before they are shaded, behind a finished depth surface, or behind the last
// entry of a k-buffer.
//
// Built only where the test cannot depend on order: the depth surface is read and not written; the depth of the last
// entry only falls, so that a bound that is out of date rejects less and never wrongly.
// Modelled: quads per cycle, all samples of a quad at once; pipeline latency (on its output link), latency of the
// bounds. Not modelled: misses of its caches.
// Source: specification 004, sections 6.1 (7), 7.4 and 7.7.
#pragma once

#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <string>
#include <vector>

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
    sim::Counter quads, fragments, fragments_rejected, fragments_beyond, quads_rejected, bounds;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&EarlyDepthStats::quads>("Quads tested").unit("quads"),
            sim::field<&EarlyDepthStats::fragments>("Fragments tested, each sample of a pixel for itself")
                .unit("fragments"),
            sim::field<&EarlyDepthStats::fragments_rejected>("Fragments behind the depth surface").unit("fragments"),
            sim::field<&EarlyDepthStats::fragments_beyond>("Fragments that no k-buffer entry could have taken")
                .unit("fragments"),
            sim::field<&EarlyDepthStats::quads_rejected>("Quads with no fragment left").unit("quads"),
            sim::field<&EarlyDepthStats::bounds>("Bounds of last entries received").unit("bounds")};
    }
};
static_assert(sim::fully_described<EarlyDepthStats>);

class EarlyDepthTest final : public sim::Component {
  public:
    sim::In<QuadTask> quads_in{*this, "quads_in"};
    sim::Out<QuadTask> quads_out{*this, "quads_out"};

    std::vector<sim::In<LastEntryBound>> bounds_in; ///< one per ROP partition, linked when the design rejects early

    /// @param partitions that send bounds; 0 = none do
    EarlyDepthTest(sim::Context context, const EarlyDepthParams& params, const PassContext& pass,
                   std::uint32_t partitions = 0);

    /// Forgets all bounds.
    void begin_pass();

    const EarlyDepthParams& params() const { return params_; }
    const EarlyDepthStats& stats() const { return stats_; }

  private:
    sim::Activity tick() override;
    bool take_bounds();
    std::uint32_t before_surface(const QuadTask& task) const;
    std::uint32_t before_last_entry(const QuadTask& task) const;

    EarlyDepthParams params_;
    const PassContext* pass_;
    std::vector<std::string> port_names_;
    std::vector<float> last_entry_; ///< by pixel of each block; empty when nobody sends bounds
    EarlyDepthStats stats_;
};

} // namespace pipeline
