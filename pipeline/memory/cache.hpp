// Which lines a set-associative cache holds: tags, least recently used replacement and dirty bits, without time or
// data.
//
// A line is a number: address / line bytes. Every line lives in a `slot`, by which a unit can file what it knows about
// it.
#pragma once

#include "sim/check.hpp"
#include "sim/described.hpp"

#include <bit>
#include <cstdint>
#include <tuple>
#include <vector>

namespace pipeline {

struct CacheParams {
    std::uint32_t bytes = 16384;
    std::uint32_t line = 32;
    std::uint32_t ways = 4;

    std::uint32_t lines() const { return bytes / line; }

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&CacheParams::bytes>("Capacity; a multiple of line * ways").unit("bytes").range(16, 1U << 30U),
            sim::field<&CacheParams::line>("Bytes of a line; a power of two").unit("bytes").range(4, 4096),
            sim::field<&CacheParams::ways>("Lines of a set").range(1, 1024)};
    }
};
static_assert(sim::fully_described<CacheParams>);

struct CacheStats {
    sim::Counter hits, misses, evictions, writebacks;

    std::uint64_t accesses() const { return hits + misses; }

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&CacheStats::hits>("Accesses to a line that is held; hits + misses = accesses").unit("accesses"),
            sim::field<&CacheStats::misses>("Accesses to a line that is not held").unit("accesses"),
            sim::field<&CacheStats::evictions>("Lines replaced by another one").unit("lines"),
            sim::field<&CacheStats::writebacks>("Dirty lines replaced or cleaned").unit("lines")};
    }
};
static_assert(sim::fully_described<CacheStats>);

/// What one access did.
struct CacheAccess {
    bool hit = false;
    bool evicted = false; ///< `victim` was replaced
    bool dirty = false;   ///< ... and has to be written back
    std::uint32_t slot = 0;
    std::uint64_t victim = 0;
};

class Cache {
  public:
    static constexpr std::uint32_t no_slot = ~std::uint32_t{0};

    /// Throws sim::InputError naming `where` unless line is a power of two and bytes a multiple of line * ways. The
    /// number of sets may be any: line modulo sets selects one.
    Cache(const CacheParams& params, const char* where);

    /// Looks `line` up and brings it in on a miss; a write leaves it dirty.
    CacheAccess access(std::uint64_t line, bool write = false);
    /// The slot that holds `line`, or no_slot; changes nothing.
    std::uint32_t find(std::uint64_t line) const;
    /// An access to the line that `slot` holds: a hit.
    void touch(std::uint32_t slot, bool write = false) {
        lines_[slot].used = ++accesses_;
        lines_[slot].dirty |= write;
        ++stats_.hits;
    }
    /// Drops `line`; true when it was held and dirty. Counts nothing.
    bool invalidate(std::uint64_t line);
    /// Drops every line. Counts nothing.
    void clear();
    /// Makes every dirty line clean, counted as written back; calls visit(line, slot) for each in slot order.
    template <class Visit>
    void clean(Visit&& visit) {
        for (std::uint32_t slot = 0; slot < lines_.size(); ++slot) {
            Line& held = lines_[slot];
            if (held.used == 0 || !held.dirty) continue;
            held.dirty = false;
            ++stats_.writebacks;
            visit(held.line, slot);
        }
    }

    std::uint64_t line_of(std::uint64_t address) const { return address >> line_shift_; }
    std::uint32_t line_bytes() const { return params_.line; }
    std::uint32_t slots() const { return static_cast<std::uint32_t>(lines_.size()); }
    /// The line in `slot`; it must hold one.
    std::uint64_t line_in(std::uint32_t slot) const {
        CHECK(lines_[slot].used != 0);
        return lines_[slot].line;
    }
    bool dirty(std::uint32_t slot) const { return lines_[slot].dirty; }
    const CacheParams& params() const { return params_; }
    const CacheStats& stats() const { return stats_; }

  private:
    struct Line {
        std::uint64_t line = 0;
        std::uint64_t used = 0; ///< number of the latest access; 0: empty
        bool dirty = false;
    };
    std::uint32_t first_slot(std::uint64_t line) const {
        const std::uint64_t set = sets_are_power_of_two_ ? line & (sets_ - 1) : line % sets_;
        return static_cast<std::uint32_t>(set) * params_.ways;
    }

    CacheParams params_;
    CacheStats stats_;
    std::uint32_t line_shift_;
    std::uint64_t sets_;
    bool sets_are_power_of_two_;
    std::uint64_t accesses_ = 0;
    std::vector<Line> lines_;
};

} // namespace pipeline
