// The reorder buffer: lets quads leave the fragment stage in the order they were dispatched, or, for designs that need
// no order, in the order they complete.
//
// Modelled: one place per quad in flight (in order: the capacity of the link from the scheduler), completions in any
// order, a bounded number of retirements per cycle. Quads without a living fragment are dropped here. Source:
// specification 004, section 2.1 (output buffer re-sequencing), section 7 (rob_quads) and section 7.4 (ooo_ok).
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/fragment/messages.hpp"
#include "pipeline/output/kbuffer_design.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <vector>

namespace pipeline {

struct ReorderBufferParams {
    std::uint32_t quads = 0;
    std::uint32_t retire_per_clk = 4;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&ReorderBufferParams::quads>(
                "Quads between dispatch and retirement; 0 = all that fit into the pipes")
                .unit("quads")
                .range(0, 1 << 20),
            sim::field<&ReorderBufferParams::retire_per_clk>("Quads retired per cycle").unit("quads").range(1, 64)};
    }
};
static_assert(sim::fully_described<ReorderBufferParams>);

struct ReorderBufferStats {
    sim::Counter retired, dropped;

    static constexpr auto fields() {
        using S = ReorderBufferStats;
        return std::tuple{sim::field<&S::retired>("Quads passed on in order").unit("quads"),
                          sim::field<&S::dropped>("Quads with no living fragment, dropped").unit("quads")};
    }
};
static_assert(sim::fully_described<ReorderBufferStats>);

class ReorderBuffer final : public sim::Component {
  public:
    sim::In<QuadTask> order_in{*this, "order_in"};   ///< in dispatch order; in order, held in the link until complete
    std::vector<sim::In<Completion>> completions_in; ///< one per pipe
    sim::Out<QuadTask> quads_out{*this, "quads_out"};

    /// @param quads places; in order they are those of the order_in link
    ReorderBuffer(sim::Context context, const ReorderBufferParams& params, std::uint32_t pipes, std::uint32_t quads,
                  Retirement retirement = Retirement::in_order);

    const ReorderBufferStats& stats() const { return stats_; }

  private:
    static constexpr std::uint64_t complete = std::uint64_t{1} << 32U;
    static constexpr std::uint64_t here = std::uint64_t{2} << 32U; ///< out of order: the quad is in tasks_

    sim::Activity tick() override;
    bool take_completions();
    bool take_tasks();
    sim::Activity retire_in_order(bool progress);
    sim::Activity retire_completed(bool progress);
    void pass_on(QuadTask task);
    bool in_order() const { return tasks_.empty(); }

    ReorderBufferParams params_;
    std::uint32_t places_;
    std::vector<std::string> port_names_;
    std::vector<std::uint64_t> done_;     ///< by sequence modulo size: `complete` | `here` | surviving mask
    std::vector<QuadTask> tasks_;         ///< likewise; empty when in order
    FixedQueue<std::uint32_t> completed_; ///< sequences, out of order
    std::uint32_t held_ = 0;              ///< quads in tasks_
    std::uint32_t oldest_ = 0;            ///< no quad before this sequence is in tasks_
    ReorderBufferStats stats_;
};

} // namespace pipeline
