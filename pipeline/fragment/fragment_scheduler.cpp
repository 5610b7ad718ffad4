#include "pipeline/fragment/fragment_scheduler.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace pipeline {

namespace {
constexpr std::uint64_t progress_step = 4096;
} // namespace

FragmentScheduler::FragmentScheduler(sim::Context context, const FragmentSchedulerParams& params, std::uint32_t pipes,
                                     std::uint32_t partitions, const PassContext& pass, SchedulingPlan& plan,
                                     const FlushRule& flush, QuadPayloads* payloads,
                                     std::atomic<std::uint64_t>* progress)
    : Component(std::move(context)),
      params_(params),
      pass_(&pass),
      plan_(&plan),
      flush_(flush),
      payloads_(payloads),
      progress_(progress),
      tracked_(payloads != nullptr || plan.guard != nullptr || params.quads_until_store != 0),
      side_buffer_(plan.guard != nullptr ? plan.guard->keys() : 0, plan.order_rule) {
    port_names_.reserve(pipes + partitions);
    for (std::uint32_t pipe = 0; pipe < pipes; ++pipe)
        pipes_out.emplace_back(*this, port_names_.emplace_back("pipe" + std::to_string(pipe) + "_out"));
    for (std::uint32_t rop = 0; tracked_ && rop < partitions; ++rop)
        commits_in.emplace_back(*this, port_names_.emplace_back("commits" + std::to_string(rop) + "_in"));
}

void FragmentScheduler::begin_pass() {
    pixel_order_.assign(static_cast<std::size_t>(pass_->layout.width + 1) * (pass_->layout.rows() + 1), 0);
    if (plan_->tickets) area_order_.assign(pass_->layout.blocks(), 0);
    if (plan_->guard != nullptr) unfinished_.assign(pixel_order_.size(), 0);
    batch_ = no_batch;
}

bool FragmentScheduler::take_commits() {
    bool progress = false;
    for (sim::In<Commit>& port : commits_in) {
        while (port.peek() != nullptr) {
            const Commit commit = port.receive();
            progress = true;
            if (commit.kind == QuadKind::writeback) {
                ++acknowledged_;
                continue;
            }
            if (plan_->guard != nullptr) {
                const Quad& quad = pass_->stream->quads[commit.quad];
                plan_->guard->release(quad, commit.mask);
                count_unfinished(quad, commit.mask, -1);
                offer(plan_->guard->key(quad));
            }
            if (commit.slot != no_slot) {
                stats_.service_interval.note(cycle() - (*payloads_)[commit.slot].dispatched);
                payloads_->give_back(commit.slot);
            }
            --in_flight_;
        }
    }
    return progress;
}

bool FragmentScheduler::choose_pipe(const Quad& quad) {
    const auto pipes = static_cast<std::uint32_t>(pipes_out.size());
    const std::uint32_t tile = plan_->policy == DispatchPolicy::tile_affinity ? 8 : params_.tile;
    if (tile != 0) {
        chosen_pipe_ = (quad.x / tile + 3U * (quad.y / tile)) % pipes;
        return pipes_out[chosen_pipe_].ready();
    }
    for (std::uint32_t n = 0; n < pipes; ++n) {
        chosen_pipe_ = (next_pipe_ + n) % pipes;
        if (pipes_out[chosen_pipe_].ready()) return true;
    }
    return false;
}

bool FragmentScheduler::can_dispatch(const QuadTask& task) {
    if (params_.quads_until_store != 0 && touches_kbuffer(task) && in_flight_ >= params_.quads_until_store)
        return false;
    if (payloads_ != nullptr && touches_kbuffer(task) && !payloads_->available()) {
        if (!std::exchange(out_of_slots_, true)) ++stats_.slot_waits;
        return false;
    }
    if (!order_out.ready()) {
        const bool full = order_out.outstanding() == order_out.channel()->config().capacity;
        if (full && !std::exchange(out_of_places_, true)) ++stats_.reorder_waits;
        return false;
    }
    return choose_pipe(pass_->stream->quads[task.quad]);
}

void FragmentScheduler::count_unfinished(const Quad& quad, std::uint8_t pixels, std::int32_t by) {
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
        if ((pixels >> pixel & 1) != 0) unfinished_[pass_->place(quad, pixel)] += by;
}

bool FragmentScheduler::overlaps_unfinished(const QuadTask& task) const {
    const Quad& quad = pass_->stream->quads[task.quad];
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
        if ((task.pixels() >> pixel & 1) != 0 && unfinished_[pass_->place(quad, pixel)] != 0) return true;
    return false;
}

// Whether the quad at the input has to wait; counted once, under what held it first. Input comes in raster order, so
// every quad in flight or waiting is older.
bool FragmentScheduler::holds(const QuadTask& task, bool blocked) {
    const bool ordered = plan_->order_rule && side_buffer_.waits(plan_->guard->key(pass_->stream->quads[task.quad]));
    if (!blocked && !ordered) return false;
    if (!std::exchange(classified_, true)) {
        ++(overlaps_unfinished(task) ? stats_.true_conflicts : stats_.false_conflicts);
        if (!blocked) ++stats_.order_waits;
    }
    return true;
}

// The samples of a group have no numbers here: the ROP counts them as they come, in this order.
void FragmentScheduler::count_order(QuadTask& task) {
    if (pass_->multisampled) return;
    const Quad& quad = pass_->stream->quads[task.quad];
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
        if ((task.mask >> pixel & 1) != 0) task.order[pixel] = pixel_order_[pass_->place(quad, pixel)]++;
    if (plan_->tickets && touches_kbuffer(task)) {
        const bool tile = *plan_->tickets == LockArea::tile;
        const SurfaceLayout& layout = pass_->layout;
        task.ticket = area_order_[tile ? layout.tile_of(quad.x, quad.y) : layout.block_of(quad.x, quad.y)]++;
    }
}

void FragmentScheduler::dispatch(QuadTask task, bool guarded) {
    const Quad& quad = pass_->stream->quads[task.quad];
    if (payloads_ != nullptr && touches_kbuffer(task)) {
        task.slot = payloads_->take();
        (*payloads_)[task.slot].dispatched = cycle();
    }
    if (guarded) plan_->guard->acquire(quad, task.pixels());
    if (tracked_ && touches_kbuffer(task)) ++in_flight_;
    task.sequence = sequence_++;
    ++stats_.quads;
    if (progress_ != nullptr && stats_.quads % progress_step == 0)
        progress_->fetch_add(progress_step, std::memory_order_relaxed);
    stats_.fragments += static_cast<std::uint64_t>(std::popcount(task.pixels()));
    order_out.send(task);
    stats_.reorder_places_max.note(order_out.outstanding());
    out_of_slots_ = out_of_places_ = false;
    next_pipe_ = (chosen_pipe_ + 1) % static_cast<std::uint32_t>(pipes_out.size());
    pipes_out[chosen_pipe_].send(task);
}

bool FragmentScheduler::free(const SideBuffer::Waiting& waiting) const {
    return !plan_->guard->blocks(pass_->stream->quads[waiting.task.quad], waiting.task.pixels());
}

void FragmentScheduler::offer(std::uint32_t key) {
    side_buffer_.offer(key, [this](const SideBuffer::Waiting& waiting) { return free(waiting); });
}

// Oldest first. The guard never frees a quad by a dispatch, so those that were not free before stay so, but for the
// next one of the same key.
bool FragmentScheduler::wake_waiting() {
    std::uint32_t woken = 0;
    for (; woken < plan_->wakes; ++woken) {
        const SideBuffer::Waiting* oldest =
            side_buffer_.oldest([this](const SideBuffer::Waiting& waiting) { return free(waiting); });
        if (oldest == nullptr || !can_dispatch(oldest->task)) break;
        const SideBuffer::Waiting waiting = side_buffer_.take_oldest();
        stats_.residence.note(cycle() - waiting.since);
        dispatch(waiting.task, true);
        offer(waiting.key);
    }
    return woken != 0;
}

std::uint32_t FragmentScheduler::batch_of(std::uint32_t triangle) const {
    return flush_.every_triangles != 0 ? triangle / flush_.every_triangles : pass_->call_of(triangle);
}

bool FragmentScheduler::at_batch_boundary(const QuadTask& task) const {
    if (!flush_.active() || pass_->end == FragmentEnd::depth_colour || batch_ == no_batch) return false;
    const std::uint32_t triangle = pass_->stream->quads[task.quad].triangle;
    return triangle != batch_triangle_ && batch_of(triangle) != batch_;
}

// What the flushing quads take that lie between two batches. Batches and quads take turns among the parts (see
// traces/submission.hpp). Batches without a fragment are never seen here, but their quads cover the screen like all
// others.
sim::Cycle FragmentScheduler::cover_cycles(std::uint32_t from, std::uint32_t to) const {
    const std::uint32_t rate = flush_.quad_pixels_per_clk;
    if (rate == 0) return 0;
    const std::uint64_t pixels = std::uint64_t{pass_->layout.width} * pass_->layout.height * pass_->layout.samples;
    const std::uint32_t quads = flush_.every_draw ? std::max(1U, (to - from) / 2) : 1;
    return quads * ((pixels + rate - 1) / rate);
}

// Drain, then command write-back and invalidation in band, then wait for the ROPs' answers. Without `drain` the
// commands follow the quads already dispatched. The quad that forces the flush is drawn behind it, before later quads.
bool FragmentScheduler::advance_flush(bool& progress) {
    if (flush_state_ == FlushState::draining) {
        if (flush_.drain && (in_flight_ != 0 || !side_buffer_.empty())) return false;
        flush_state_ = FlushState::commanding;
    }
    if (flush_state_ == FlushState::commanding) {
        QuadTask command;
        if (flush_.writeback && !writeback_sent_) {
            if (!order_out.ready()) return false;
            command.kind = QuadKind::writeback;
            command.sequence = sequence_++;
            order_out.send(command);
            writeback_sent_ = true;
            progress = true;
        }
        command.kind = QuadKind::invalidate;
        for (; flush_.invalidate && invalidates_sent_ < pipes_out.size(); ++invalidates_sent_) {
            if (!pipes_out[invalidates_sent_].ready()) return false;
            pipes_out[invalidates_sent_].send(command);
            progress = true;
        }
        flush_state_ = FlushState::acknowledging;
    }
    if (flush_state_ == FlushState::acknowledging) {
        if (flush_.drain && flush_.writeback && acknowledged_ < commits_in.size()) return false;
        covered_at_ = cycle() + cover_cycles_;
        flush_state_ = FlushState::covering;
    }
    if (covered_at_ > cycle()) {
        wake_at(covered_at_);
        return false;
    }
    flush_state_ = FlushState::none;
    stats_.drain_cycles += cycle() - flush_since_;
    return true;
}

sim::Activity FragmentScheduler::accept(bool progress) {
    const auto limit = plan_->guard != nullptr ? plan_->lookups : static_cast<std::uint32_t>(pipes_out.size());
    for (std::uint32_t n = 0; n < limit; ++n) {
        const QuadTask* input = quads_in.peek();
        if (input == nullptr) break;
        if (flush_state_ == FlushState::none && at_batch_boundary(*input)) {
            flush_state_ = FlushState::draining;
            flush_since_ = cycle();
            acknowledged_ = 0;
            invalidates_sent_ = 0;
            writeback_sent_ = false;
            cover_cycles_ = cover_cycles(batch_, batch_of(pass_->stream->quads[input->quad].triangle));
            ++stats_.flushes;
            batch_ = no_batch;
        }
        if (flush_state_ != FlushState::none && !advance_flush(progress))
            return progress ? sim::Activity::busy : sim::Activity::memory;
        const Quad& quad = pass_->stream->quads[input->quad];
        const bool guarded = plan_->guard != nullptr && touches_kbuffer(*input);
        if (guarded && holds(*input, plan_->guard->blocks(quad, input->pixels()))) {
            if (side_buffer_.size() >= plan_->side_buffer) {
                if (!std::exchange(overflowing_, true)) ++stats_.overflow_stalls;
                return progress ? sim::Activity::busy : sim::Activity::hazard;
            }
            SideBuffer::Waiting waiting{quads_in.receive(), plan_->guard->key(quad), cycle()};
            count_order(waiting.task);
            count_unfinished(quad, waiting.task.pixels(), 1);
            side_buffer_.insert(waiting);
            ++stats_.inserted;
            stats_.waiting.note(side_buffer_.size());
            stats_.waiting_max.note(side_buffer_.size());
        } else {
            if (!can_dispatch(*input)) return progress ? sim::Activity::busy : sim::Activity::blocked;
            QuadTask task = quads_in.receive();
            if (task.mask == 0) ++stats_.bypassed;
            count_order(task);
            if (guarded) count_unfinished(quad, task.pixels(), 1);
            dispatch(task, guarded);
        }
        if (flush_.active() && (batch_ == no_batch || quad.triangle != batch_triangle_)) {
            batch_triangle_ = quad.triangle;
            batch_ = batch_of(quad.triangle);
        }
        progress = true;
        overflowing_ = classified_ = false;
    }
    if (progress) return sim::Activity::busy;
    if (!side_buffer_.empty()) return sim::Activity::hazard;
    return in_flight_ == 0 ? sim::Activity::starved : sim::Activity::memory;
}

sim::Activity FragmentScheduler::tick() {
    bool progress = take_commits();
    progress = wake_waiting() || progress;
    return accept(progress);
}

} // namespace pipeline
