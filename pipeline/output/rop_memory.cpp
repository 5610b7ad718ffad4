// The memory side of a ROP partition: tiles, write-back, k-buffer reads of texture units, clears and copies.
#include "pipeline/output/rop.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace pipeline {

namespace {

// Memory tags: the upper bits say what an answer is for.
constexpr std::uint32_t tag_tile = 1U << 28U; ///< | use << 26 | entry
constexpr std::uint32_t tag_read = 2U << 28U; ///< | job << 7 | target (64 = all targets)
constexpr std::uint32_t tag_stream = 3U << 28U;
constexpr std::uint32_t tag_part = 4U << 28U; ///< all but the last request of a tile that takes several
constexpr std::uint32_t tag_kind = 15U << 28U;
constexpr std::uint32_t all_target = 64;

constexpr std::uint64_t surface_span = std::uint64_t{1} << 36U;

} // namespace

std::uint32_t Rop::tile_bytes(Use use) const {
    switch (use) {
    case Use::depth:
        return 16 * pass_->depth_bytes;
    case Use::colour:
        return 16 * pass_->colour_bytes;
    case Use::kbuffer:
        break;
    }
    return 16 * (pass_->end == FragmentEnd::kbuffer_list ? plan_->lists.head_bytes : pass_->program->bytes_per_pixel());
}

std::uint64_t Rop::tile_address(Use use, std::uint32_t tile) const {
    return surface_span * (static_cast<std::uint64_t>(use) + 1) + std::uint64_t{tile} * tile_bytes(use);
}

// Stores overwrite whole pixels under a byte mask; only what is combined with the stored value is fetched.
bool Rop::fetches(Use use) const {
    return use == Use::depth || (use == Use::colour && pass_->blend != BlendMode::replace) ||
           (use == Use::kbuffer && pass_->end != FragmentEnd::kbuffer_store);
}

void Rop::request(std::uint64_t address, std::uint32_t bytes, std::uint32_t tag, MemoryClient client, bool write,
                  std::uint32_t draw) {
    requests_.push({address, bytes, tag, draw, client, write});
}

void Rop::publish(std::uint32_t tile) {
    if (surfaces_.kbuffer == nullptr) return;
    if (plan_->shader.visibility == Visibility::never_until_flush && !writing_back_ && !plan_->shader.write_through) {
        if (!std::exchange(is_unpublished_[tile], 1)) unpublished_.push_back(tile);
        return;
    }
    surfaces_.kbuffer->publish_tile(tile);
    surfaces_.history->tile_visible(tile, cycle() + 1);
    if (!invalidations_out.empty() && plan_->shader.visibility != Visibility::rop_cache)
        for (std::uint32_t block = tile * 4; block < tile * 4 + 4; ++block) invalidations_.push(block);
}

// A whole tile, in requests of the size that memory takes; the last one carries the tag.
void Rop::request_tile(Use use, std::uint32_t tile, std::uint32_t tag, MemoryClient client, bool write) {
    std::uint64_t address = tile_address(use, tile);
    std::uint32_t left = tile_bytes(use);
    for (; left > largest_request; left -= largest_request, address += largest_request)
        request(address, largest_request, tag_part, client, write, draw_);
    request(address, left, tag, client, write, draw_);
}

void Rop::clean(Use use, std::uint32_t entry) {
    TileCache& tiles = cache(use);
    const std::uint32_t tile = tiles.tile(entry);
    request_tile(use, tile, 0, MemoryClient::tile_write, true);
    tiles.mark_clean(entry);
    ++tiles.stats.writebacks;
    if (use == Use::kbuffer) publish(tile);
}

bool Rop::take_memory() {
    bool progress = false;
    while (memory_in.peek() != nullptr) {
        const std::uint32_t tag = memory_in.receive().tag;
        progress = true;
        if ((tag & tag_kind) == tag_tile)
            cache(static_cast<Use>(tag >> 26U & 3U)).filled(tag & 0x3FF'FFFFU);
        else if ((tag & tag_kind) == tag_stream)
            --stream_outstanding_;
        else if ((tag & tag_kind) == tag_read) {
            const std::uint32_t target = tag & 127U;
            ReadJob& job = jobs_[(tag & ~tag_kind) >> 7U];
            sample(job.read, target == all_target ? job.read.targets : std::uint64_t{1} << target);
            if (--job.outstanding != 0) continue;
            answers_.push(job.read);
            free_jobs_.push_back((tag & ~tag_kind) >> 7U);
        }
    }
    return progress;
}

void Rop::sample(const KBufferRead& read, std::uint64_t targets) {
    const bool rop_view = plan_->shader.visibility == Visibility::rop_cache;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        const float* pixel_floats = surfaces_.kbuffer->seen(read.block, pixel, rop_view);
        const PixelVersion version = surfaces_.kbuffer->seen_version(read.block, pixel, rop_view);
        for (std::uint64_t left = targets; left != 0; left &= left - 1) {
            const auto target = static_cast<std::uint32_t>(std::countr_zero(left));
            surfaces_.payloads->sample(read.slot, pixel, target, pixel_floats + std::size_t{4} * target, version,
                                       cycle());
        }
    }
}

bool Rop::kbuffer_on_chip(std::uint32_t tile) const {
    return plan_->shader.tile_memory ||
           (plan_->shader.visibility == Visibility::rop_cache && kbuffer_tiles_.resident(tile));
}

// Takes reads of the texture units, round robin over the pipes. A tile in the cache answers at once when reads may see
// it.
bool Rop::accept_reads() {
    const auto pipes = static_cast<std::uint32_t>(reads_in.size());
    const std::uint32_t first = next_pipe_;
    std::uint32_t accepted = 0;
    for (std::uint32_t n = 0; n < pipes && accepted < params_.reads_per_clk; ++n) {
        const std::uint32_t pipe = (first + n) % pipes;
        auto& port = reads_in[pipe];
        if (port.peek() == nullptr) continue;
        if (free_jobs_.empty() || requests_.size() + 2 * request_room > requests_.capacity() || tile_reads_.full())
            break;
        const KBufferRead read = port.receive();
        const std::uint32_t tile = SurfaceLayout::tile_of_block(read.block);
        ++stats_.kbuffer_reads;
        ++accepted;
        next_pipe_ = (pipe + 1) % pipes;
        if (kbuffer_on_chip(tile)) {
            const std::uint32_t own = plan_->shader.read_latency;
            tile_reads_.push({read, cycle() + (own != 0 ? own : params_.read_latency)});
            ++stats_.kbuffer_reads_from_tiles;
            continue;
        }
        const std::uint32_t index = free_jobs_.back();
        const std::uint64_t address =
            tile_address(Use::kbuffer, tile) + std::uint64_t{read.block % 4} * (tile_bytes(Use::kbuffer) / 4);
        free_jobs_.pop_back();
        jobs_[index].read = read;
        if (plan_->shader.atomic_reads) {
            jobs_[index].outstanding = 1;
            request(address, 64U * static_cast<std::uint32_t>(std::popcount(read.targets)),
                    tag_read | index << 7U | all_target, MemoryClient::kbuffer_read, false, read.draw);
            continue;
        }
        jobs_[index].outstanding = static_cast<std::uint32_t>(std::popcount(read.targets));
        for (std::uint64_t left = read.targets; left != 0; left &= left - 1) {
            const auto target = static_cast<std::uint32_t>(std::countr_zero(left));
            request(address + std::uint64_t{64} * target, 64, tag_read | index << 7U | target,
                    MemoryClient::kbuffer_read, false, read.draw);
        }
    }
    return accepted != 0;
}

// Values leave the tile cache after its latency, as they are then.
bool Rop::serve_tile_reads() {
    bool progress = false;
    while (!tile_reads_.empty() && tile_reads_.front().ready <= cycle() && !answers_.full()) {
        const KBufferRead read = tile_reads_.front().read;
        tile_reads_.pop();
        sample(read, read.targets);
        answers_.push(read);
        progress = true;
    }
    if (!tile_reads_.empty()) wake_at(std::max(tile_reads_.front().ready, cycle() + 1));
    return progress;
}

// The entry that holds the tile, replacing another tile and asking for this one if need be; pinned for one more quad.
std::uint32_t Rop::secure_tile(Use use, std::uint32_t tile) {
    TileCache& tiles = cache(use);
    std::uint32_t entry = tiles.find(tile);
    ++tiles.stats.accesses;
    if (entry != no_entry) {
        ++tiles.stats.hits;
    } else {
        ++tiles.stats.misses;
        entry = tiles.victim();
        if (tiles.dirty(entry)) clean(use, entry);
        tiles.allocate(entry, tile, fetches(use));
        if (fetches(use))
            request_tile(use, tile, tag_tile | static_cast<std::uint32_t>(use) << 26U | entry, MemoryClient::tile_read,
                         false);
    }
    tiles.pin(entry);
    return entry;
}

void Rop::write_back_all() {
    writing_back_ = true;
    write_back_at_ = 0;
    if (!simulation().running()) wake_in(1);
}

// One dirty tile per cycle; then what was evicted without becoming visible; then the answer to an in-band command.
bool Rop::write_back_next() {
    if (!writing_back_) return false;
    if (requests_.size() + request_room > requests_.capacity() || invalidations_.size() + 8 > invalidations_.capacity())
        return false;
    const std::uint32_t tiles = std::max<std::uint32_t>(params_.cache_tiles, kbuffer_tiles_.size());
    while (write_back_at_ < 3 * tiles) {
        const auto use = static_cast<Use>(write_back_at_ / tiles);
        const std::uint32_t entry = write_back_at_ % tiles;
        ++write_back_at_;
        if (entry >= cache(use).size() || !cache(use).dirty(entry)) continue;
        clean(use, entry);
        return true;
    }
    if (!unpublished_.empty()) {
        is_unpublished_[unpublished_.back()] = 0;
        publish(unpublished_.back());
        unpublished_.pop_back();
        return true;
    }
    if (acknowledge_) {
        if (!commits_out.ready()) return false;
        commits_out.send({no_slot, 0, 0, QuadKind::writeback});
        acknowledge_ = false;
    }
    writing_back_ = false;
    return true;
}

void Rop::stream(std::uint64_t read_bytes, std::uint64_t write_bytes) {
    stream_reads_ = read_bytes;
    stream_writes_ = write_bytes;
    stream_address_ = surface_span * 8;
    stats_.copies += read_bytes != 0 ? read_bytes + write_bytes : 0;
    stats_.clears += read_bytes != 0 ? 0 : write_bytes;
    wake_in(1);
}

bool Rop::stream_next() {
    if (stream_reads_ + stream_writes_ == 0 || requests_.size() + request_room > requests_.capacity()) return false;
    const bool read = stream_reads_ > 0 && stream_reads_ >= stream_writes_;
    if (read && stream_outstanding_ >= stream_window) return false;
    std::uint64_t& left = read ? stream_reads_ : stream_writes_;
    const auto bytes = static_cast<std::uint32_t>(std::min<std::uint64_t>(left, stream_chunk));
    request(stream_address_ + (read ? 0 : surface_span), bytes, tag_stream, MemoryClient::copy, !read, draw_);
    left -= bytes;
    stream_address_ += read ? 0 : bytes;
    stream_outstanding_ += read ? 1U : 0U;
    return true;
}

bool Rop::send_requests() {
    bool progress = false;
    while (!requests_.empty() && memory_out.ready()) {
        memory_out.send(requests_.front());
        requests_.pop();
        progress = true;
    }
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
