// The memory side of a ROP group: fetches, write-back, clears and copies.
#include "pipeline/output/rop.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <string_view>
#include <utility>

namespace pipeline {

std::vector<SurfaceBytes> Rop::memory_of(Use use) const {
    switch (use) {
    case Use::depth:
        return {pass_->depth};
    case Use::colour:
        return pass_->colours;
    case Use::kbuffer:
        break;
    }
    if (pass_->program == nullptr) return {};
    return {{pass_->kbuffer_address,
             pass_->end == FragmentEnd::kbuffer_list ? plan_->lists.head_bytes : pass_->program->bytes_per_pixel()}};
}

SectorShape Rop::sector_shape(Use use) const {
    SectorShape shape{0, ~0U};
    for (const SurfaceBytes& surface : memory(use)) {
        shape.pixel_bytes += surface.pixel_bytes;
        shape.least_bytes = std::min(shape.least_bytes, surface.pixel_bytes);
    }
    return shape.pixel_bytes != 0 ? shape : SectorShape{1};
}

// Lines of the surface that this group owns, and some more: groups own tiles in turn, row by row.
std::uint32_t Rop::own_lines(const SectorShape& shape) const {
    const SurfaceLayout& layout = pass_->layout;
    return (layout.tiles_x() / layout.partitions + 1) * layout.tiles_y() * 4 / shape.sectors();
}

// Tile memory holds all of them.
std::uint32_t Rop::lines_that_fit(Use use) const {
    const SectorShape shape = sector_shape(use);
    if (use == Use::kbuffer && plan_->shader.tile_memory) return own_lines(shape);
    const std::array<std::pair<std::string_view, std::uint32_t>, 3> sizes{
        std::pair{"depth_cache_bytes", params_.depth_cache_bytes},
        std::pair{"colour_cache_bytes", params_.colour_cache_bytes},
        std::pair{"kbuffer_cache_bytes", params_.kbuffer_cache_bytes}};
    const auto& [name, bytes] = sizes[static_cast<std::size_t>(use)];
    const std::uint32_t groups = pass_->layout.partitions, lines = bytes / groups / shape.line_bytes();
    if (lines == 0)
        throw sim::InputError(fmt::format(
            "rop.{}: expected at least {} bytes, {} for the quad that each of {} groups of four ROPs works on, got {}",
            name, std::uint64_t{groups} * shape.line_bytes(), shape.line_bytes(), groups, bytes));
    return std::min(lines, own_lines(shape));
}

std::uint64_t Rop::line_address(Use use, const SurfaceBytes& surface, std::uint32_t line) const {
    return surface.address + std::uint64_t{line} * cache(use).shape().sectors() * 4 * surface.pixel_bytes;
}

std::span<ClearBits* const> Rop::clear_bits(Use use) const {
    return use == Use::depth    ? std::span<ClearBits* const>(surfaces_.fixed->depth_clear)
           : use == Use::colour ? std::span<ClearBits* const>(surfaces_.fixed->colour_clear)
                                : std::span(&surfaces_.kbuffer_clear, surfaces_.kbuffer_clear != nullptr ? 1 : 0);
}

// Memory holds nothing of these sectors: of any target.
bool Rop::cleared(Use use, std::uint32_t line) const {
    const auto of_targets = clear_bits(use);
    const std::uint32_t sectors = cache(use).shape().sectors();
    return !of_targets.empty() && std::all_of(of_targets.begin(), of_targets.end(), [&](const ClearBits* bits) {
        if (bits->left() == 0) return false;
        for (std::uint32_t block = line * sectors; block < (line + 1) * sectors; ++block)
            if (!bits->cleared(block)) return false;
        return true;
    });
}

bool Rop::has_room() const {
    return requests_.size() + request_room <= requests_.capacity() &&
           invalidations_.size() + 8 <= invalidations_.capacity();
}

void Rop::request(std::uint64_t address, std::uint32_t bytes, std::uint32_t tag, MemoryClient client, bool write,
                  std::uint32_t draw) {
    requests_.push({address, bytes, tag, draw, client, write, (tag & tag_kind) == tag_store});
}

// Requests of memory partitions that this many bytes take.
std::uint32_t Rop::parts_of(std::uint64_t address, std::uint32_t bytes) const {
    return static_cast<std::uint32_t>((address + bytes - 1) / shape_.interleave - address / shape_.interleave + 1);
}

// The whole line, in whole bursts.
void Rop::fetch(Use use, std::uint32_t entry) {
    constexpr std::uint64_t burst = SectorShape::burst;
    const std::uint32_t line = cache(use).line(entry);
    for (const SurfaceBytes& surface : memory(use)) {
        const std::uint64_t begin = line_address(use, surface, line);
        const std::uint64_t end = (line_address(use, surface, line + 1) + burst - 1) / burst * burst;
        for (std::uint64_t at = begin / burst * burst; at < end; at += largest_request) {
            const auto bytes = static_cast<std::uint32_t>(std::min<std::uint64_t>(end - at, largest_request));
            request(at, bytes, tag_tile | static_cast<std::uint32_t>(use) << 26U | entry, MemoryClient::tile_read,
                    false, draw_);
            parts_coming_[static_cast<std::size_t>(use)][entry] += parts_of(at, bytes);
        }
    }
}

// The bursts that these pixels lie in, under a byte mask; returns their number of requests.
std::uint32_t Rop::write_pixels(Use use, std::uint32_t line, std::uint16_t pixels, std::uint32_t tag,
                                std::uint32_t draw) {
    constexpr std::uint64_t burst = SectorShape::burst;
    std::uint32_t parts = 0;
    for (const SurfaceBytes& surface : memory(use)) {
        const std::uint32_t of_target = std::min(surface.pixel_bytes, SectorShape::target_pixel);
        const std::uint64_t base = line_address(use, surface, line);
        std::uint64_t begin = 0, end = 0; // of the run so far
        for (std::uint32_t target = 0; target < surface.pixel_bytes; target += of_target)
            for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
                const auto pixel = static_cast<std::uint32_t>(std::countr_zero(left));
                const std::uint64_t at = base + std::uint64_t{4} * target + std::uint64_t{pixel} * of_target;
                const std::uint64_t first = at / burst * burst, last = (at + of_target + burst - 1) / burst * burst;
                if (first > end) {
                    parts += write_run(begin, end, tag, draw);
                    begin = first;
                }
                end = std::max(end, last);
            }
        parts += write_run(begin, end, tag, draw);
    }
    return parts;
}

// Returns how many parts of it memory partitions take.
std::uint32_t Rop::write_run(std::uint64_t begin, std::uint64_t end, std::uint32_t tag, std::uint32_t draw) {
    std::uint32_t parts = 0;
    for (; begin < end; begin += largest_request) {
        const auto bytes = static_cast<std::uint32_t>(std::min<std::uint64_t>(end - begin, largest_request));
        request(begin, bytes, tag, MemoryClient::tile_write, true, draw);
        parts += parts_of(begin, bytes);
    }
    return parts;
}

// What has to be written so that memory holds these pixels: of a cleared sector all, as memory holds none of it.
std::uint16_t Rop::with_cleared(Use use, std::uint32_t line, std::uint16_t pixels) {
    const SectorShape& shape = cache(use).shape();
    for (ClearBits* bits : clear_bits(use))
        for (std::uint32_t block = line * shape.sectors(); block < (line + 1) * shape.sectors(); ++block) {
            const std::uint16_t sector = shape.in_line(block, 15);
            if ((pixels & sector) == 0 || !bits->cleared(block)) continue;
            pixels |= sector;
            bits->written(block);
        }
    return pixels;
}

// Writes what is dirty.
void Rop::clean(Use use, std::uint32_t entry) {
    TileCache& lines = cache(use);
    const std::uint32_t line = lines.line(entry);
    const std::uint16_t pixels = with_cleared(use, line, lines.dirty(entry));
    if (use == Use::kbuffer && surfaces_.payloads != nullptr) {
        CHECK_MSG(lines.shape().sectors() == 1, "a line of entries is one sector");
        const std::uint32_t store = send_to_memory(line, pixels, std::nullopt);
        stores_[store].parts = write_pixels(use, line, pixels, tag_store | store, draw_);
    } else {
        write_pixels(use, line, pixels, 0, draw_);
    }
    lines.mark_clean(entry, lines.dirty(entry));
    ++lines.stats.writebacks;
}

// Answers come when the array is read; what hangs on the data waits until they are here.
bool Rop::take_memory() {
    bool progress = false;
    memory_held_.any_from(0, [&](std::uint32_t i) {
        while (const MemoryResponse* response = memory_in[i].try_receive()) {
            progress = true;
            array_accessed(response->tag);
            if ((response->tag & tag_kind) == tag_store) continue;
            const sim::Cycle ready = cycle() + response->delay;
            coming_[i].push({response->tag, ready});
            if (ready >= first_coming_) continue;
            first_coming_ = ready;
            if (ready > cycle()) wake_at(ready);
        }
        return false;
    });
    if (first_coming_ > cycle()) return progress;
    sim::Cycle next = never;
    for (auto& coming : coming_) {
        for (; !coming.empty() && coming.front().ready <= cycle(); coming.pop()) take_answer(coming.front().tag);
        if (!coming.empty()) next = std::min(next, coming.front().ready);
    }
    first_coming_ = next;
    if (next != never) wake_at(next);
    return true;
}

void Rop::take_answer(std::uint32_t tag) {
    if ((tag & tag_kind) == tag_tile) {
        const std::uint32_t use = tag >> 26U & 3U;
        const std::uint32_t entry = tag & 0x3FF'FFFFU;
        if (--parts_coming_[use][entry] == 0) cache(static_cast<Use>(use)).filled(entry);
    } else if ((tag & tag_kind) == tag_stream) {
        --stream_outstanding_;
    } else if ((tag & tag_kind) == tag_read) {
        const std::uint32_t index = (tag & ~tag_kind) >> 7U;
        ReadJob& job = jobs_[index];
        if (--job.outstanding != 0) return;
        const auto targets = static_cast<std::uint32_t>(std::popcount(job.read.targets));
        if (targets == pass_->program->targets()) kbuffer_tiles_.complete(job.read.block);
        answers_.push(job.read);
        free_jobs_.push_back(index);
    }
}

// The entry that holds the sector, replacing another line and asking for this one if need be; pinned for one more quad.
// Stores overwrite whole pixels under a byte mask; only what is kept of the old content, to be combined with, is
// fetched. A line that came on chip by stores alone is fetched when the first quad comes that needs more of it.
std::uint32_t Rop::secure_line(Use use, std::uint32_t block, bool keeps) {
    TileCache& lines = cache(use);
    const std::uint32_t line = lines.shape().line_of(block);
    std::uint32_t entry = lines.find(line);
    ++lines.stats.accesses;
    if (entry != no_entry) {
        ++lines.stats.hits;
        if (keeps && !lines.pending(entry) && !lines.whole(entry)) {
            lines.await(entry);
            fetch(use, entry);
        }
    } else {
        ++lines.stats.misses;
        entry = lines.victim();
        if (lines.dirty(entry) != 0) clean(use, entry);
        const bool known = cleared(use, line), fetched = keeps && !known;
        lines.allocate(entry, line, fetched, known ? lines.shape().whole_line() : std::uint16_t{0});
        if (fetched) fetch(use, entry);
    }
    lines.pin(entry);
    return entry;
}

void Rop::write_back_all() {
    writing_back_ = true;
    write_back_at_ = 0;
    if (!simulation().running()) wake_in(1);
}

// One dirty line per cycle; then what was evicted without becoming visible; then the answer to an in-band command.
bool Rop::write_back_next() {
    if (!has_room()) return false;
    const std::uint32_t lines = std::max({depth_tiles_.size(), colour_tiles_.size(), kbuffer_tiles_.size()});
    while (write_back_at_ < 3 * lines) {
        const auto use = static_cast<Use>(write_back_at_ / lines);
        const std::uint32_t entry = write_back_at_ % lines;
        ++write_back_at_;
        if (entry >= cache(use).size() || cache(use).dirty(entry) == 0) continue;
        clean(use, entry);
        return true;
    }
    // A flush has happened when the memory's array has all of it.
    if (free_stores_.size() != stores_.size()) return false;
    while (!unpublished_.empty()) {
        if (invalidations_.size() + 8 > invalidations_.capacity()) return false;
        const StoreInFlight& store = stores_[send_to_memory(unpublished_.back(), 15, std::nullopt)];
        show(store);
        free_stores_.push_back(static_cast<std::uint32_t>(&store - stores_.data()));
        is_unpublished_[unpublished_.back()] = 0;
        unpublished_.pop_back();
    }
    if (acknowledge_) {
        if (!commits_out.ready()) return false;
        commits_out.send({no_slot, 0, 0, QuadKind::writeback});
        acknowledge_ = false;
    }
    writing_back_ = false;
    return true;
}

void Rop::stream(const SurfaceStream& stream) {
    if (stream.read_bytes + stream.write_bytes == 0) return;
    sim::Counter& counter = stream.resolve ? stats_.resolves : stream.read_bytes != 0 ? stats_.copies : stats_.clears;
    counter += stream.read_bytes + stream.write_bytes;
    streams_.push_back(stream);
    streams_.back().read_address += std::uint64_t{shape_.index} * stream_chunk;
    streams_.back().write_address += std::uint64_t{shape_.index} * stream_chunk;
    wake_in(1);
}

bool Rop::stream_next() {
    if (requests_.size() + request_room > requests_.capacity()) return false;
    SurfaceStream& stream = streams_.front();
    const bool read = stream.read_bytes > 0 && stream.read_bytes >= stream.write_bytes;
    if (read && stream_outstanding_ >= stream_window) return false;
    std::uint64_t& left = read ? stream.read_bytes : stream.write_bytes;
    std::uint64_t& address = read ? stream.read_address : stream.write_address;
    const auto bytes = static_cast<std::uint32_t>(std::min<std::uint64_t>(left, stream_chunk));
    request(address, bytes, tag_stream, MemoryClient::copy, !read, draw_);
    stream_outstanding_ += read ? parts_of(address, bytes) : 0;
    left -= bytes;
    address += std::uint64_t{pass_->layout.partitions} * stream_chunk;
    if (stream.read_bytes + stream.write_bytes == 0) streams_.pop_front();
    return true;
}

bool Rop::send_requests() {
    bool progress = false;
    while (!requests_.empty()) {
        MemoryRequest& whole = requests_.front();
        auto& port = memory_out[whole.address / shape_.interleave % memory_out.size()];
        if (!port.ready()) break;
        MemoryRequest part = whole;
        part.bytes =
            std::min(whole.bytes, shape_.interleave - static_cast<std::uint32_t>(whole.address % shape_.interleave));
        port.send(part);
        progress = true;
        whole.address += part.bytes;
        whole.bytes -= part.bytes;
        if (whole.bytes == 0) requests_.pop();
    }
    return progress;
}

} // namespace pipeline
