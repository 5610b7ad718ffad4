// The tile cache of a ROP partition: which 4x4-pixel tiles of one surface are on chip.
//
// Modelled: fully associative, least recently used; tiles are pinned while a quad that needs them waits; dirty tiles
// are written back when replaced or flushed. Tags only: the bytes live in the surface. Source: specification 004,
// section 7 (rop_tile, rop_cache_tiles).
#pragma once

#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <cstdint>
#include <vector>

namespace pipeline {

struct TileCacheStats {
    sim::Counter accesses, hits, misses, writebacks;

    static constexpr auto fields() {
        using S = TileCacheStats;
        return std::tuple{sim::field<&S::accesses>("Quads that looked their tile up").unit("quads"),
                          sim::field<&S::hits>("Lookups that found the tile, or found it on its way").unit("quads"),
                          sim::field<&S::misses>("Lookups that allocated a tile").unit("quads"),
                          sim::field<&S::writebacks>("Dirty tiles written to memory").unit("tiles")};
    }
};
static_assert(sim::fully_described<TileCacheStats>);

class TileCache {
  public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// @param tiles tiles the cache holds, 0 (left out) to 2^26 - 1
    /// @param surface_tiles tiles of the whole surface
    TileCache(std::uint32_t tiles, std::uint32_t surface_tiles) : entries_(tiles), where_(surface_tiles, none) {}

    std::uint32_t find(std::uint32_t tile) const { return where_[tile]; }
    bool resident(std::uint32_t tile) const { return where_[tile] != none && !entries_[where_[tile]].pending; }

    /// The entry that allocate() would replace; none when all are pinned or pending.
    std::uint32_t victim() const;
    bool dirty(std::uint32_t entry) const { return entries_[entry].dirty; }
    std::uint32_t tile(std::uint32_t entry) const { return entries_[entry].tile; }
    bool pending(std::uint32_t entry) const { return entries_[entry].pending; }
    std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }

    /// Puts `tile` into `entry`, whose old content must be clean or written back by the caller.
    void allocate(std::uint32_t entry, std::uint32_t tile, bool pending);
    void filled(std::uint32_t entry) { entries_[entry].pending = false; }
    void pin(std::uint32_t entry);
    void unpin(std::uint32_t entry) { --entries_[entry].users; }
    void mark_dirty(std::uint32_t entry) { entries_[entry].dirty = true; }
    void mark_clean(std::uint32_t entry) { entries_[entry].dirty = false; }
    /// Forgets all tiles; none may be pinned, pending or dirty.
    void forget();

    TileCacheStats stats;

  private:
    static constexpr std::uint32_t no_tile = ~std::uint32_t{0};
    struct Entry {
        std::uint32_t tile = no_tile;
        std::uint32_t users = 0;
        std::uint64_t used = 0;
        bool dirty = false;
        bool pending = false;
    };
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> where_; ///< by tile
    std::uint64_t clock_ = 0;
    std::uint32_t fresh_ = 0; ///< entries from here on hold nothing yet
};

} // namespace pipeline
