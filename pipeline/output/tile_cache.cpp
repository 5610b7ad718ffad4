#include "pipeline/output/tile_cache.hpp"

#include "sim/check.hpp"

namespace pipeline {

std::uint32_t TileCache::victim() const {
    if (fresh_ < size()) return fresh_;
    std::uint32_t best = none;
    for (std::uint32_t entry = 0; entry < size(); ++entry) {
        const Entry& candidate = entries_[entry];
        if (candidate.users != 0 || candidate.pending) continue;
        if (best == none || candidate.used < entries_[best].used) best = entry;
    }
    return best;
}

void TileCache::allocate(std::uint32_t entry, std::uint32_t tile, bool pending) {
    Entry& target = entries_[entry];
    CHECK(target.users == 0 && !target.pending && !target.dirty);
    if (target.tile != no_tile) where_[target.tile] = none;
    target = {tile, 0, ++clock_, false, pending};
    where_[tile] = entry;
    while (fresh_ < size() && entries_[fresh_].tile != no_tile) ++fresh_;
}

void TileCache::pin(std::uint32_t entry) {
    ++entries_[entry].users;
    entries_[entry].used = ++clock_;
}

void TileCache::forget() {
    for (Entry& entry : entries_) {
        CHECK(entry.users == 0 && !entry.pending && !entry.dirty);
        if (entry.tile != no_tile) where_[entry.tile] = none;
        entry = {};
    }
    fresh_ = 0;
}

} // namespace pipeline
