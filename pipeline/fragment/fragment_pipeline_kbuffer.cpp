// How a fragment pipe reads the k-buffer: lookups, merged misses, invalidation, and the program on what came back.
#include "pipeline/fragment/fragment_pipeline.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace pipeline {

void FragmentPipeline::run_program(const QuadTask& task) {
    const FragmentStream& stream = *pass_->stream;
    std::array<float, largest_entry> entry;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((task.mask >> pixel & 1) == 0) continue;
        pass_->program->make_entry(stream.fragment(task.quad, pixel), entry.data());
        pass_->program->insert(payloads_->values(task.slot, pixel), entry.data());
    }
}

bool FragmentPipeline::take_hits() {
    bool progress = false;
    for (; !hits_.empty() && hits_.front().ready <= cycle(); progress = true) {
        after_values(hits_.front().thread);
        hits_.pop();
    }
    return progress;
}

// L1 lookup of every render target of the quad's block: hits are read now, pending lines joined, the rest asked for;
// it comes back into a line where one could be reserved, else past the L1.
void FragmentPipeline::lookup_targets(std::uint16_t index) {
    Thread& thread = threads_[index];
    const QuadTask& task = thread.task;
    const Quad& quad = pass_->stream->quads[task.quad];
    const std::uint32_t parts = program_targets_ / line_targets_;
    const std::uint64_t part_mask = line_targets_ == program_targets_ ? all_targets() : 1;
    thread.block = pass_->layout.block_of(quad.x, quad.y);
    thread.generation = l1_.generation();
    thread.looked_up = cycle();
    thread.own = all_targets();
    thread.lined = 0;
    const sim::Cycle cost = std::uint64_t{texture_.cycles_per_rgba32f} * program_targets_;
    texture_free_ = std::max(texture_free_, cycle()) + cost;
    stats_.texture_cycles += cost;
    ++stats_.kbuffer_reads;
    if (!uses_l1()) {
        stats_.l1.kbuffer_misses += parts;
        return;
    }
    std::uint64_t missing = 0;
    for (std::uint32_t part = 0; part < parts; ++part) {
        const std::uint64_t targets = part_mask << part;
        const std::uint32_t line = l1_.find_kbuffer(thread.block, part);
        if (line == TextureCache::none) {
            missing |= std::uint64_t{1} << part;
            ++stats_.l1.kbuffer_misses;
            continue;
        }
        if (l1_.pending(line)) {
            thread.merged |= targets;
            ++stats_.l1.kbuffer_merged;
            continue;
        }
        ++stats_.l1.kbuffer_hits;
        thread.own &= ~targets;
        for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
            for (std::uint32_t n = 0; n < line_targets_; ++n)
                payloads_->sample(task.slot, pixel, part * line_targets_ + n, l1_.data(line, pixel, n),
                                  l1_.version(line, pixel), {cycle(), l1_.filled_at(line)});
    }
    thread.own &= ~thread.merged;
    for (; missing != 0; missing &= missing - 1) {
        const auto part = static_cast<std::uint32_t>(std::countr_zero(missing));
        if (l1_.reserve_kbuffer(thread.block, part) != TextureCache::none) thread.lined |= part_mask << part;
    }
}

bool FragmentPipeline::send_read(std::uint16_t index) {
    Thread& thread = threads_[index];
    const Quad& quad = pass_->stream->quads[thread.task.quad];
    auto& port = reads_out[pass_->layout.partition_of(quad.x, quad.y)];
    if (!port.ready()) return false;
    const auto pixels = static_cast<std::uint8_t>(uses_l1() ? 15 : thread.task.pixels());
    port.send({thread.block, thread.task.slot, thread.own, pass_->draw_of(thread.task.quad), pipe_, index, pixels});
    return true;
}

// A shader with a critical section has run up to it: the lock table says when it may enter.
bool FragmentPipeline::ask_for_lock() {
    if (shading_.empty() || shading_.front().ready > cycle()) return false;
    const std::uint16_t index = shading_.front().thread;
    const QuadTask& task = threads_[index].task;
    if (task.slot == no_slot) {
        shading_.pop();
        after_values(index);
        return true;
    }
    if (!locks_out.ready()) return false;
    locks_out.send({task.quad, task.pixels(), index, task.order, task.ticket});
    shading_.pop();
    return true;
}

// Starts the k-buffer read of the next quad that is ready for it.
bool FragmentPipeline::lookup_next() {
    const bool ready = locks() ? !locked_.empty() : !shading_.empty() && shading_.front().ready <= cycle();
    if (read_in_hand_ || !ready) return false;
    const std::uint16_t index = locks() ? locked_.front() : shading_.front().thread;
    const bool reads = threads_[index].task.slot != no_slot;
    if (reads && texture_free_ > cycle()) return false;
    if (locks())
        locked_.pop();
    else
        shading_.pop();
    if (!reads) {
        after_values(index);
        return true;
    }
    lookup_targets(index);
    Thread& thread = threads_[index];
    if ((thread.own | thread.merged) == 0) {
        hits_.push({index, texture_free_ + texture_.hit_latency});
        return true;
    }
    append(block_chain_[thread.block], index);
    if (thread.own != 0) read_in_hand_ = index;
    return true;
}

bool FragmentPipeline::read_kbuffer_of_next() {
    bool progress = locks() && ask_for_lock();
    progress |= lookup_next();
    if (read_in_hand_ && send_read(*read_in_hand_)) {
        read_in_hand_.reset();
        progress = true;
    }
    return progress;
}

void FragmentPipeline::fill_l1(const Thread& thread, std::uint64_t targets) {
    if (thread.generation != l1_.generation()) return;
    for (std::uint32_t part = 0; part < program_targets_ / line_targets_; ++part) {
        const std::uint32_t first = part * line_targets_;
        if ((targets >> first & 1) == 0) continue;
        const std::uint32_t line = l1_.find_kbuffer(thread.block, part);
        CHECK(line != TextureCache::none && l1_.pending(line));
        l1_.filled(line);
        l1_.filled_at(line) = payloads_->fill(thread.task.slot, first);
        for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
            const float* from = payloads_->values(thread.task.slot, pixel) + std::size_t{first} * 4;
            std::copy(from, from + std::size_t{line_targets_} * 4, l1_.data(line, pixel, 0));
            l1_.version(line, pixel) = payloads_->version(thread.task.slot, pixel, first);
        }
    }
}

void FragmentPipeline::give_to_waiting(const Thread& from, std::uint64_t targets) {
    const std::uint32_t slot = from.task.slot;
    for (std::uint16_t other = block_chain_[from.block].first; other != nobody; other = threads_[other].next) {
        Thread& thread = threads_[other];
        const std::uint64_t shared = thread.generation == from.generation ? thread.merged & targets : 0;
        for (std::uint64_t left = shared; left != 0; left &= left - 1) {
            const auto target = static_cast<std::uint32_t>(std::countr_zero(left));
            for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
                payloads_->sample(
                    thread.task.slot, pixel, target, payloads_->values(slot, pixel) + std::size_t{target} * 4,
                    payloads_->version(slot, pixel, target), {thread.looked_up, payloads_->fill(slot, target)});
        }
        thread.merged &= ~shared;
    }
}

// Lets the threads go that have all they asked for. Only now, because the program overwrites the values it works on.
void FragmentPipeline::finish_complete(std::uint32_t block) {
    Chain& chain = block_chain_[block];
    for (std::uint16_t thread = std::exchange(chain, {}).first; thread != nobody;) {
        const std::uint16_t next = threads_[thread].next;
        if ((threads_[thread].own | threads_[thread].merged) == 0)
            after_values(thread);
        else
            append(chain, thread);
        thread = next;
    }
}

void FragmentPipeline::kbuffer_arrived(std::uint16_t index) {
    Thread& thread = threads_[index];
    const std::uint64_t lined = std::exchange(thread.own, 0) & thread.lined;
    fill_l1(thread, lined);
    give_to_waiting(thread, lined);
    finish_complete(thread.block);
}

// Values on their way were perhaps sampled before the store: later quads must not join them, nor find them in L1.
void FragmentPipeline::invalidate(std::uint32_t block) {
    l1_.drop_kbuffer_block(block, program_targets_ / line_targets_);
    ++stats_.l1.invalidations;
    bool orphaned = false;
    for (std::uint16_t thread = block_chain_[block].first; thread != nobody; thread = threads_[thread].next)
        if (threads_[thread].generation == l1_.generation()) {
            threads_[thread].generation = orphans_;
            orphaned = true;
        }
    if (orphaned) --orphans_;
}

} // namespace pipeline
