// The fragment scheduler: hands quads to the pipes, and keeps apart what must not fly together.
//
// Modelled: one quad per pipe and cycle, or those of a tile of the screen to one pipe as they come; a place in the
// reorder buffer and, for designs whose shader reads the k-buffer, a payload slot are taken at dispatch; an optional
// dispatch guard with its side buffer (order per key, lookups and wakes per cycle, stall on overflow); the three-part
// flush between batches. Source: specification 004, sections 7.1 (flush rule) and 7.2 (steps 1-5); Bavoil 2007,
// section 4.3.1.
#pragma once

#include "pipeline/fragment/fragment_scheduler_params.hpp"
#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "pipeline/fragment/quad_payloads.hpp"
#include "pipeline/fragment/side_buffer.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <atomic>
#include <vector>

namespace pipeline {

struct FragmentSchedulerStats {
    sim::Counter quads, fragments, bypassed, true_conflicts, false_conflicts, inserted, overflow_stalls, order_waits,
        slot_waits, reorder_waits, flushes, drain_cycles;
    sim::HighWater waiting_max, reorder_places_max;
    sim::Histogram waiting, residence, service_interval;

    static constexpr auto fields() {
        using S = FragmentSchedulerStats;
        return std::tuple{
            sim::field<&S::quads>("Quads dispatched").unit("quads"),
            sim::field<&S::fragments>("Living fragments dispatched").unit("fragments"),
            sim::field<&S::bypassed>("Quads without a living fragment, which touch no pixel state").unit("quads"),
            sim::field<&S::true_conflicts>(
                "Quads held at their first lookup, of which a pixel belongs to an older quad in flight or waiting")
                .unit("quads"),
            sim::field<&S::false_conflicts>(
                "Quads held at their first lookup only by the guard's granularity, its hash or its order rule")
                .unit("quads"),
            sim::field<&S::inserted>("Quads put into the side buffer").unit("quads"),
            sim::field<&S::overflow_stalls>("Times the rasterizer was stalled by a full side buffer").unit("stalls"),
            sim::field<&S::order_waits>(
                "Of the quads held, those whose area was free, behind an older quad of their key that was waiting")
                .unit("quads"),
            sim::field<&S::slot_waits>("Times dispatch stopped because no payload slot was free").unit("stalls"),
            sim::field<&S::reorder_waits>("Times dispatch stopped because the reorder buffer was full").unit("stalls"),
            sim::field<&S::flushes>("Flushes between batches").unit("flushes"),
            sim::field<&S::drain_cycles>("Cycles from the start to the end of those flushes").unit("cycles"),
            sim::field<&S::waiting_max>("Most quads in the side buffer").unit("quads"),
            sim::field<&S::reorder_places_max>("Most places of the reorder buffer taken").unit("quads"),
            sim::field<&S::waiting>("Side buffer occupancy, sampled at insertion").unit("quads"),
            sim::field<&S::residence>("Time from insertion to dispatch").unit("cycles"),
            sim::field<&S::service_interval>("Time from dispatch to commit (L_rw)").unit("cycles")};
    }
};
static_assert(sim::fully_described<FragmentSchedulerStats>);

class FragmentScheduler final : public sim::Component {
  public:
    sim::In<QuadTask> quads_in{*this, "quads_in"};
    sim::Out<QuadTask> order_out{*this, "order_out"};
    std::vector<sim::Out<QuadTask>> pipes_out; ///< one per pipe
    std::vector<sim::In<Commit>> commits_in;   ///< one per ROP partition; only with payloads or a guard

    /// @param plan what guards dispatch; must outlive the scheduler
    /// @param payloads null when no shader reads the k-buffer
    /// @param progress counts dispatched quads, a few thousand at a time, for whoever watches the run
    FragmentScheduler(sim::Context context, const FragmentSchedulerParams& params, std::uint32_t pipes,
                      std::uint32_t partitions, const PassContext& pass, SchedulingPlan& plan, const FlushRule& flush,
                      QuadPayloads* payloads, std::atomic<std::uint64_t>* progress = nullptr);

    const FragmentSchedulerStats& stats() const { return stats_; }
    /// Forgets the raster order at every pixel; before each pass that starts from a cleared k-buffer.
    void begin_pass();

  private:
    enum class FlushState : std::uint8_t { none, draining, commanding, acknowledging, covering };

    sim::Activity tick() override;
    bool take_commits();
    bool free(const SideBuffer::Waiting& waiting) const;
    void offer(std::uint32_t key);
    bool wake_waiting();
    sim::Activity accept(bool progress);
    bool can_dispatch(const QuadTask& task);
    void dispatch(QuadTask task, bool guarded);
    bool choose_pipe(const Quad& quad);
    bool holds(const QuadTask& task, bool blocked);
    bool overlaps_unfinished(const QuadTask& task) const;
    void count_unfinished(const Quad& quad, std::uint8_t pixels, std::int32_t by);
    void count_order(QuadTask& task);
    /// Number of the batch between two flushes that a triangle belongs to; grows along the pass.
    std::uint32_t batch_of(std::uint32_t triangle) const;
    bool at_batch_boundary(const QuadTask& task) const;
    sim::Cycle cover_cycles(std::uint32_t from, std::uint32_t to) const;
    bool advance_flush(bool& progress);
    bool touches_kbuffer(const QuadTask& task) const {
        return task.mask != 0 && pass_->end != FragmentEnd::depth_colour;
    }

    FragmentSchedulerParams params_;
    const PassContext* pass_;
    SchedulingPlan* plan_;
    FlushRule flush_;
    QuadPayloads* payloads_;
    std::atomic<std::uint64_t>* progress_;
    std::vector<std::string> port_names_;
    bool tracked_; ///< commits come back for every quad that stores
    FragmentSchedulerStats stats_;
    std::vector<std::uint32_t> pixel_order_; ///< fragments accepted so far, per pixel
    std::vector<std::uint32_t> area_order_;  ///< quads accepted so far, per block or tile, where locks need it
    /// Quads accepted whose stores the next reader cannot see yet, per pixel; with a guard only. No hardware: it tells
    /// true conflicts from false ones.
    std::vector<std::int32_t> unfinished_;
    SideBuffer side_buffer_;
    std::uint32_t next_pipe_ = 0;
    std::uint32_t chosen_pipe_ = 0; ///< ready at this edge, found by choose_pipe()
    bool classified_ = false;       ///< the quad at the input has been held, and counted under its cause
    // The present stall has been counted.
    bool overflowing_ = false, out_of_slots_ = false, out_of_places_ = false;
    std::uint32_t sequence_ = 0;
    std::uint32_t in_flight_ = 0; ///< dispatched and not committed; with `tracked_` only
    FlushState flush_state_ = FlushState::none;
    std::uint32_t acknowledged_ = 0;
    static constexpr std::uint32_t no_batch = ~std::uint32_t{0};
    std::uint32_t batch_ = no_batch;   ///< of the last quad taken, ...
    std::uint32_t batch_triangle_ = 0; ///< ... and its triangle
    sim::Cycle flush_since_ = 0;
    sim::Cycle cover_cycles_ = 0; ///< of the flushing quads of this flush
    sim::Cycle covered_at_ = 0;   ///< they have been drawn
    std::uint32_t invalidates_sent_ = 0;
    bool writeback_sent_ = false;
};

} // namespace pipeline
