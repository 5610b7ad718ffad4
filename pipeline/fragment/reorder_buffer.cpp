#include "pipeline/fragment/reorder_buffer.hpp"

#include <bit>
#include <utility>

namespace pipeline {

ReorderBuffer::ReorderBuffer(sim::Context context, const ReorderBufferParams& params, std::uint32_t pipes,
                             std::uint32_t quads)
    : Component(std::move(context)), params_(params), done_(std::bit_ceil(quads)) {
    port_names_.reserve(pipes);
    for (std::uint32_t pipe = 0; pipe < pipes; ++pipe)
        completions_in.emplace_back(*this, port_names_.emplace_back("pipe" + std::to_string(pipe) + "_in"));
}

sim::Activity ReorderBuffer::tick() {
    const std::size_t mask = done_.size() - 1;
    bool progress = false;
    for (sim::In<Completion>& port : completions_in)
        while (port.peek() != nullptr) {
            const Completion completion = port.receive();
            done_[completion.sequence & mask] = static_cast<std::uint8_t>(complete | completion.mask);
            progress = true;
        }
    for (std::uint32_t n = 0; n < params_.retire_per_clk; ++n) {
        const QuadTask* head = order_in.peek();
        if (head == nullptr) break;
        std::uint8_t& done = done_[head->sequence & mask];
        const bool command = head->kind != QuadKind::quad;
        if (!command && (done & complete) == 0) return progress ? sim::Activity::busy : sim::Activity::memory;
        if (!quads_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        QuadTask task = order_in.receive();
        task.retired = cycle();
        if (!command) task.mask = static_cast<std::uint8_t>(std::exchange(done, 0) & 0xF);
        progress = true;
        if (!command && task.mask == 0) {
            CHECK_MSG(task.slot == no_slot, "a quad that holds a payload slot must reach its ROP, which gives it back");
            ++stats_.dropped;
            continue;
        }
        if (!command) ++stats_.retired;
        quads_out.send(task);
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
