#include "pipeline/memory/cache.hpp"

#include <fmt/format.h>

namespace pipeline {

Cache::Cache(const CacheParams& params, const char* where)
    : params_(params), line_shift_(static_cast<std::uint32_t>(std::countr_zero(params.line))) {
    if (!std::has_single_bit(params.line))
        throw sim::InputError(fmt::format("{}.line: expected a power of two, got {}", where, params.line));
    const std::uint64_t set_bytes = std::uint64_t{params.line} * params.ways;
    if (params.ways == 0 || params.bytes < set_bytes || params.bytes % set_bytes != 0)
        throw sim::InputError(
            fmt::format("{}.bytes: expected a multiple of line * ways = {}, got {}", where, set_bytes, params.bytes));
    sets_ = params.bytes / set_bytes;
    sets_are_power_of_two_ = std::has_single_bit(sets_);
    lines_.resize(params.lines());
}

CacheAccess Cache::access(std::uint64_t line, bool write) {
    const std::uint32_t first = first_slot(line);
    std::uint32_t slot = first; // the line itself, or else the least recently used; empty ones come first
    for (std::uint32_t way = first; way < first + params_.ways; ++way) {
        if (lines_[way].used != 0 && lines_[way].line == line) {
            touch(way, write);
            return {.hit = true, .slot = way};
        }
        if (lines_[way].used < lines_[slot].used) slot = way;
    }
    Line& victim = lines_[slot];
    CacheAccess result{.evicted = victim.used != 0, .dirty = victim.dirty, .slot = slot, .victim = victim.line};
    ++stats_.misses;
    if (result.evicted) ++stats_.evictions;
    if (result.dirty) ++stats_.writebacks;
    victim = {line, ++accesses_, write};
    return result;
}

std::uint32_t Cache::find(std::uint64_t line) const {
    const std::uint32_t first = first_slot(line);
    for (std::uint32_t way = first; way < first + params_.ways; ++way)
        if (lines_[way].used != 0 && lines_[way].line == line) return way;
    return no_slot;
}

bool Cache::invalidate(std::uint64_t line) {
    const std::uint32_t slot = find(line);
    if (slot == no_slot) return false;
    const bool dirty = lines_[slot].dirty;
    lines_[slot] = {};
    return dirty;
}

void Cache::clear() { lines_.assign(lines_.size(), {}); }

} // namespace pipeline
