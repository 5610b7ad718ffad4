// What texture units read of a ROP group: in which cycle a value is taken, and from when on a store can be seen.
#include "pipeline/output/rop.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace pipeline {

// Takes a copy of what goes to memory, as later stores may change the tile before the burst crosses the bus.
std::uint32_t Rop::send_to_memory(std::uint32_t block, std::uint32_t pixels, std::optional<Commit> commit) {
    if (free_stores_.empty()) {
        free_stores_.push_back(static_cast<std::uint32_t>(stores_.size()));
        stores_.emplace_back();
    }
    const std::uint32_t index = free_stores_.back();
    free_stores_.pop_back();
    StoreInFlight& store = stores_[index];
    const float* from = surfaces_.kbuffer->latest(block, 0);
    store.block = block;
    store.pixels = pixels;
    store.values.assign(from, from + std::size_t{4} * surfaces_.kbuffer->floats_per_pixel());
    std::copy_n(&surfaces_.kbuffer->latest_version(block, 0), 4, store.versions.begin());
    store.commit = commit;
    return index;
}

void Rop::arrived_in_memory(std::uint32_t index) {
    StoreInFlight& store = stores_[index];
    if (plan_->shader.visibility == Visibility::never_until_flush && !plan_->shader.write_through) {
        if (!std::exchange(is_unpublished_[store.block], 1)) unpublished_.push_back(store.block);
    } else {
        show(store);
    }
    if (store.commit) commits_.push_back(*store.commit);
    free_stores_.push_back(index);
}

// From the next cycle on, reads of memory find these pixels.
void Rop::show(const StoreInFlight& store) {
    surfaces_.kbuffer->publish_block(store.block, store.pixels, store.values.data(), store.versions.data());
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
        if ((store.pixels >> pixel & 1) != 0)
            surfaces_.history->make_visible(store.block, pixel, store.versions[pixel].stores, cycle() + 1);
    if (!invalidations_out.empty() && plan_->shader.visibility != Visibility::rop_cache)
        invalidations_.push(store.block);
}

bool Rop::send_commits() {
    bool progress = false;
    for (; !commits_.empty() && commits_out.ready() && (!releases_out.connected() || releases_out.ready());
         progress = true) {
        commits_out.send(commits_.front());
        if (releases_out.connected()) releases_out.send(commits_.front());
        commits_.pop_front();
    }
    return progress;
}

// The memory's array was read or written: this is the instant that decides which stores a read contains.
void Rop::array_accessed(std::uint32_t tag) {
    if ((tag & tag_kind) == tag_store) {
        const std::uint32_t store = tag & ~tag_kind;
        if (--stores_[store].parts == 0) arrived_in_memory(store);
    } else if ((tag & tag_kind) == tag_read) {
        const std::uint32_t target = tag & 127U;
        ReadJob& job = jobs_[(tag & ~tag_kind) >> 7U];
        if (target == all_target && --job.unread != 0) return; // the parts of one read count as one
        sample(job.read, target == all_target ? job.read.targets : std::uint64_t{1} << target);
    }
}

void Rop::sample(const KBufferRead& read, std::uint64_t targets) {
    const bool rop_view = plan_->shader.visibility == Visibility::rop_cache;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        const float* pixel_floats = surfaces_.kbuffer->seen(read.block, pixel, rop_view);
        const PixelVersion version = surfaces_.kbuffer->seen_version(read.block, pixel, rop_view);
        for (std::uint64_t left = targets; left != 0; left &= left - 1) {
            const auto target = static_cast<std::uint32_t>(std::countr_zero(left));
            surfaces_.payloads->sample(read.slot, pixel, target, pixel_floats + std::size_t{4} * target, version,
                                       {0, cycle()});
        }
    }
}

bool Rop::kbuffer_on_chip(const KBufferRead& read) const {
    return plan_->shader.tile_memory ||
           (plan_->shader.visibility == Visibility::rop_cache && kbuffer_tiles_.holds(read.block, read.pixels));
}

// Takes reads of the texture units, round robin over the pipes. A sector in the cache answers at once when reads may
// see it.
bool Rop::accept_reads() {
    const auto pipes = static_cast<std::uint32_t>(reads_in.size());
    std::uint32_t accepted = 0;
    reads_held_.any_from(next_pipe_, [&](std::uint32_t pipe) {
        auto& port = reads_in[pipe];
        if (port.peek() == nullptr) return false;
        if (free_jobs_.empty() || requests_.size() + 2 * request_room > requests_.capacity() || tile_reads_.full())
            return true;
        accept_read(port.receive());
        next_pipe_ = pipe + 1 < pipes ? pipe + 1 : 0;
        return ++accepted == params_.reads_per_clk;
    });
    return accepted != 0;
}

void Rop::accept_read(const KBufferRead& read) {
    ++stats_.kbuffer_reads;
    if (kbuffer_on_chip(read)) {
        tile_reads_.push({read, cycle() + request_latency()});
        ++stats_.kbuffer_reads_from_tiles;
        return;
    }
    const std::uint32_t index = free_jobs_.back();
    const std::uint64_t address =
        line_address(Use::kbuffer, memory(Use::kbuffer).front(), read.block); // a sector is a line
    free_jobs_.pop_back();
    ReadJob& job = jobs_[index];
    job.read = read;
    if (plan_->shader.atomic_reads) {
        const std::uint32_t bytes = 64U * static_cast<std::uint32_t>(std::popcount(read.targets));
        job.outstanding = job.unread = parts_of(address, bytes);
        request(address, bytes, tag_read | index << 7U | all_target, MemoryClient::kbuffer_read, false, read.draw);
        return;
    }
    job.outstanding = 0;
    for (std::uint64_t left = read.targets; left != 0; left &= left - 1) {
        const auto target = static_cast<std::uint32_t>(std::countr_zero(left));
        const std::uint64_t at = address + std::uint64_t{64} * target;
        job.outstanding += parts_of(at, 64);
        request(at, 64, tag_read | index << 7U | target, MemoryClient::kbuffer_read, false, read.draw);
    }
}

std::uint32_t Rop::request_latency() const {
    return own_read_latency() ? plan_->shader.read_request_latency : params_.read_request_latency;
}

std::uint32_t Rop::return_latency() const {
    return own_read_latency() ? plan_->shader.read_return_latency : params_.read_return_latency;
}

// A read reaches the array of the tile cache, takes what is there then, and carries it back.
bool Rop::serve_tile_reads() {
    if (tile_reads_.empty() && tile_answers_.empty()) return false;
    bool progress = false;
    for (; !tile_answers_.empty() && tile_answers_.front().ready <= cycle() && !answers_.full(); progress = true) {
        answers_.push(tile_answers_.front().read);
        tile_answers_.pop();
    }
    for (; !tile_reads_.empty() && tile_reads_.front().ready <= cycle() && !tile_answers_.full(); progress = true) {
        const KBufferRead read = tile_reads_.front().read;
        tile_reads_.pop();
        sample(read, read.targets);
        tile_answers_.push({read, cycle() + return_latency()});
    }
    for (const FixedQueue<TimedRead>* reads : {&tile_reads_, &tile_answers_})
        if (!reads->empty()) wake_at(std::max(reads->front().ready, cycle() + 1));
    return progress;
}

bool Rop::send_answers() {
    bool progress = false;
    while (!answers_.empty() && reads_out[answers_.front().pipe].ready()) {
        reads_out[answers_.front().pipe].send({answers_.front().thread});
        answers_.pop();
        progress = true;
    }
    return progress;
}

bool Rop::send_invalidations() {
    bool progress = false;
    while (!invalidations_.empty()) {
        for (auto& port : invalidations_out)
            if (!port.ready()) return progress;
        for (auto& port : invalidations_out) port.send({invalidations_.front()});
        invalidations_.pop();
        progress = true;
    }
    return progress;
}

} // namespace pipeline
