#include "pipeline/output/tile_cache.hpp"

#include "sim/check.hpp"

namespace pipeline {

std::uint16_t TileCache::victim() const {
    std::uint16_t best = none;
    for (std::uint16_t entry = 0; entry < size(); ++entry) {
        const Entry& candidate = entries_[entry];
        if (candidate.users != 0 || candidate.pending) continue;
        if (best == none || candidate.used < entries_[best].used) best = entry;
    }
    return best;
}

void TileCache::allocate(std::uint16_t entry, std::uint32_t tile, bool pending) {
    Entry& target = entries_[entry];
    CHECK(target.users == 0 && !target.pending && !target.dirty);
    if (target.tile != no_tile) where_[target.tile] = none;
    target = {tile, 0, ++clock_, false, pending};
    where_[tile] = entry;
}

void TileCache::pin(std::uint16_t entry) {
    ++entries_[entry].users;
    entries_[entry].used = ++clock_;
}

void TileCache::forget() {
    for (Entry& entry : entries_) {
        CHECK(entry.users == 0 && !entry.pending && !entry.dirty);
        if (entry.tile != no_tile) where_[entry.tile] = none;
        entry = {};
    }
}

} // namespace pipeline
