// A cache of a ROP group: which sectors of one surface are on chip.
//
// A line is a sector of 2x2 pixels; where that is smaller than a burst of memory (32 bytes), the neighbouring sectors
// that share the burst, so that nothing that crosses the bus is thrown away.
// Modelled: capacity in lines; fully associative, least recently used; which pixels of a line are there (valid) and
// which were changed (dirty); lines are pinned while a quad that needs them waits. Tags only: the bytes live in the
// surface.
// Not modelled: sets and ways, conflicts of its ports.
// Source: specification 004, section 7 (rop_tile, rop_cache_tiles), with sectors instead of whole tiles.
#pragma once

#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pipeline {

struct TileCacheStats {
    sim::Counter accesses, hits, misses, writebacks;

    static constexpr auto fields() {
        using S = TileCacheStats;
        return std::tuple{sim::field<&S::accesses>("Quads that looked their sector up").unit("quads"),
                          sim::field<&S::hits>("Lookups that found the line, or found it on its way").unit("quads"),
                          sim::field<&S::misses>("Lookups that allocated a line").unit("quads"),
                          sim::field<&S::writebacks>("Dirty lines written to memory").unit("lines")};
    }
};
static_assert(sim::fully_described<TileCacheStats>);

/// How the sectors of the surfaces of one use lie in lines and bursts.
struct SectorShape {
    static constexpr std::uint32_t burst = 32;         ///< bytes
    static constexpr std::uint32_t target_pixel = 16;  ///< most bytes of a pixel of one render target
    static constexpr std::uint32_t most_of_a_line = 4; ///< sectors

    std::uint32_t pixel_bytes = 16;          ///< of all render targets together, at least 1
    std::uint32_t least_bytes = pixel_bytes; ///< of a pixel of the surface that has the smallest

    std::uint32_t sector_bytes() const { return 4 * pixel_bytes; }
    /// Sectors of a line: 1, 2 or 4.
    std::uint32_t sectors() const { return least_bytes >= 8 ? 1 : least_bytes >= 4 ? 2 : most_of_a_line; }
    std::uint32_t line_bytes() const { return sectors() * sector_bytes(); }
    std::uint32_t line_of(std::uint32_t block) const { return block / sectors(); }
    /// The pixels of `block`, given as a mask of its four, within its line.
    std::uint16_t in_line(std::uint32_t block, std::uint32_t pixels) const {
        return static_cast<std::uint16_t>(pixels << 4 * (block % sectors()));
    }
    std::uint16_t whole_line() const { return static_cast<std::uint16_t>((1U << 4 * sectors()) - 1); }
};

class TileCache {
  public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// Forgets all lines, none of which may be pinned, pending or dirty; holds `lines` of `shape` from now on, 0 (left
    /// out) to 2^26 - 1.
    void begin(std::uint32_t lines, const SectorShape& shape);

    const SectorShape& shape() const { return shape_; }
    std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
    std::uint32_t find(std::uint32_t line) const {
        std::uint32_t entry = buckets_.empty() ? none : buckets_[bucket_of(line)];
        while (entry != none && entries_[entry].line != line) entry = entries_[entry].chain;
        return entry;
    }
    /// These pixels of the sector, given as a mask of its four, are on chip.
    bool holds(std::uint32_t block, std::uint32_t pixels) const;

    /// The entry that allocate() would replace: of those that no quad waits for, the one that waited longest; none when
    /// all are pinned.
    std::uint32_t victim() const { return oldest_; }
    std::uint32_t line(std::uint32_t entry) const { return entries_[entry].line; }
    std::uint16_t dirty(std::uint32_t entry) const { return entries_[entry].dirty; } ///< mask of pixels
    bool pending(std::uint32_t entry) const { return entries_[entry].pending; }

    /// Puts `line` into `entry`, whose old content must be clean or written back by the caller. A pending one is whole
    /// when filled() is called; else the `valid` pixels are there.
    void allocate(std::uint32_t entry, std::uint32_t line, bool pending, std::uint16_t valid);
    /// All pixels of the line are on chip.
    bool whole(std::uint32_t entry) const { return entries_[entry].valid == shape_.whole_line(); }
    /// The missing pixels of a line come beside those that were stored here.
    void await(std::uint32_t entry) { entries_[entry].pending = true; }
    void filled(std::uint32_t entry) {
        entries_[entry].pending = false;
        entries_[entry].valid = shape_.whole_line();
    }
    /// The sector's missing pixels arrived beside those that were stored here, if its line is still on chip.
    void complete(std::uint32_t block);
    void pin(std::uint32_t entry) {
        if (entries_[entry].users++ == 0) unlink(entry);
    }
    void unpin(std::uint32_t entry) {
        if (--entries_[entry].users == 0) append(entry);
    }
    void mark_dirty(std::uint32_t entry, std::uint16_t pixels) {
        entries_[entry].dirty |= pixels;
        entries_[entry].valid |= pixels;
    }
    void mark_clean(std::uint32_t entry, std::uint16_t pixels) {
        entries_[entry].dirty = static_cast<std::uint16_t>(entries_[entry].dirty & ~pixels);
    }

    TileCacheStats stats;

  private:
    static constexpr std::uint32_t no_line = ~std::uint32_t{0};
    struct Entry {
        std::uint32_t line = no_line;
        std::uint32_t chain = none;               ///< next entry of the same bucket
        std::uint32_t older = none, newer = none; ///< among those that no quad waits for
        std::uint32_t users = 0;
        std::uint16_t valid = 0, dirty = 0;
        bool pending = false;
    };
    std::uint32_t bucket_of(std::uint32_t line) const {
        // Fibonacci hashing: neighbouring lines spread over the buckets, whose number is a power of two.
        return static_cast<std::uint32_t>((line * std::uint64_t{0x9E3779B97F4A7C15} >> 32U) & (buckets_.size() - 1));
    }
    void unlink(std::uint32_t entry);
    void append(std::uint32_t entry);
    void drop_tag(std::uint32_t entry);

    SectorShape shape_;
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> buckets_; ///< first entry of each
    std::uint32_t oldest_ = none, newest_ = none;
};

} // namespace pipeline
