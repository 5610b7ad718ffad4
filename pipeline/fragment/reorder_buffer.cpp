#include "pipeline/fragment/reorder_buffer.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace pipeline {

namespace {

// Out of order, quads that live at one time may lie far apart in dispatch order; the table spans so many of them.
std::size_t table_size(std::uint32_t quads, Retirement retirement) {
    return std::bit_ceil(retirement == Retirement::in_order ? quads : std::max(4 * quads, 65536U));
}

} // namespace

ReorderBuffer::ReorderBuffer(sim::Context context, const ReorderBufferParams& params, std::uint32_t pipes,
                             std::uint32_t quads, Retirement retirement)
    : Component(std::move(context)),
      params_(params),
      places_(quads),
      done_(table_size(quads, retirement)),
      tasks_(retirement == Retirement::in_order ? 0 : done_.size()),
      completed_(retirement == Retirement::in_order ? 1 : static_cast<std::uint32_t>(done_.size())) {
    port_names_.reserve(pipes);
    for (std::uint32_t pipe = 0; pipe < pipes; ++pipe)
        completions_in.emplace_back(*this, port_names_.emplace_back("pipe" + std::to_string(pipe) + "_in"));
}

bool ReorderBuffer::take_completions() {
    bool progress = false;
    for (sim::In<Completion>& port : completions_in)
        while (port.peek() != nullptr) {
            const Completion completion = port.receive();
            std::uint64_t& done = done_[completion.sequence & (done_.size() - 1)];
            done = (done & here) | complete | completion.mask;
            if ((done & here) != 0) completed_.push(completion.sequence);
            progress = true;
        }
    return progress;
}

void ReorderBuffer::pass_on(QuadTask task) {
    task.retired = cycle();
    if (task.mask == 0 && task.kind == QuadKind::quad) {
        CHECK_MSG(task.slot == no_slot, "a quad that holds a payload slot must reach its ROP, which gives it back");
        ++stats_.dropped;
        return;
    }
    if (task.kind == QuadKind::quad) ++stats_.retired;
    quads_out.send(task);
}

sim::Activity ReorderBuffer::retire_in_order(bool progress) {
    for (std::uint32_t n = 0; n < params_.retire_per_clk; ++n) {
        const QuadTask* head = order_in.peek();
        if (head == nullptr) break;
        std::uint64_t& done = done_[head->sequence & (done_.size() - 1)];
        const bool command = head->kind != QuadKind::quad;
        if (!command && (done & complete) == 0) return progress ? sim::Activity::busy : sim::Activity::memory;
        if (!quads_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        QuadTask task = order_in.receive();
        if (!command) task.mask = static_cast<std::uint32_t>(std::exchange(done, 0));
        pass_on(task);
        progress = true;
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

bool ReorderBuffer::take_tasks() {
    bool progress = false;
    const std::uint32_t on_link = order_in.channel()->config().capacity;
    while (held_ < places_ && order_in.peek() != nullptr) {
        while (oldest_ != order_in.peek()->sequence && (done_[oldest_ & (done_.size() - 1)] & here) == 0) ++oldest_;
        // The completions of the quads behind it on the link must find places of their own, too.
        if (order_in.peek()->sequence - oldest_ + on_link >= done_.size()) break;
        const QuadTask task = order_in.receive();
        CHECK_MSG(task.kind == QuadKind::quad, "in-band commands need the order of the quads");
        const std::size_t at = task.sequence & (done_.size() - 1);
        tasks_[at] = task;
        if ((done_[at] & complete) != 0) completed_.push(task.sequence);
        done_[at] |= here;
        ++held_;
        progress = true;
    }
    return progress;
}

sim::Activity ReorderBuffer::retire_completed(bool progress) {
    progress |= take_tasks();
    for (std::uint32_t n = 0; n < params_.retire_per_clk && !completed_.empty(); ++n) {
        if (!quads_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        const std::size_t at = completed_.front() & (done_.size() - 1);
        completed_.pop();
        QuadTask task = tasks_[at];
        task.mask = static_cast<std::uint32_t>(std::exchange(done_[at], 0));
        --held_;
        pass_on(task);
        progress = true;
    }
    if (progress) return sim::Activity::busy;
    return held_ == 0 ? sim::Activity::starved : sim::Activity::memory;
}

sim::Activity ReorderBuffer::tick() {
    const bool progress = take_completions();
    return in_order() ? retire_in_order(progress) : retire_completed(progress);
}

} // namespace pipeline
