#include "pipeline/output/tile_cache.hpp"

#include "sim/check.hpp"

#include <bit>

namespace pipeline {

void TileCache::begin(std::uint32_t lines, const SectorShape& shape) {
    for (const Entry& entry : entries_) CHECK(entry.users == 0 && !entry.pending && entry.dirty == 0);
    shape_ = shape;
    entries_.assign(lines, {});
    buckets_.assign(lines == 0 ? 0 : std::bit_ceil(lines), none);
    oldest_ = newest_ = none;
    for (std::uint32_t entry = 0; entry < lines; ++entry) append(entry);
}

bool TileCache::holds(std::uint32_t block, std::uint32_t pixels) const {
    const std::uint32_t entry = find(shape_.line_of(block));
    if (entry == none || entries_[entry].pending) return false;
    const std::uint16_t wanted = shape_.in_line(block, pixels);
    return (entries_[entry].valid & wanted) == wanted;
}

void TileCache::complete(std::uint32_t block) {
    const std::uint32_t entry = find(shape_.line_of(block));
    if (entry != none) entries_[entry].valid |= shape_.in_line(block, 15);
}

void TileCache::allocate(std::uint32_t entry, std::uint32_t line, bool pending, std::uint16_t valid) {
    Entry& target = entries_[entry];
    CHECK(target.users == 0 && !target.pending && target.dirty == 0);
    if (target.line != no_line) drop_tag(entry);
    std::uint32_t& bucket = buckets_[bucket_of(line)];
    target.line = line;
    target.chain = bucket;
    target.valid = valid;
    target.pending = pending;
    bucket = entry;
}

void TileCache::drop_tag(std::uint32_t entry) {
    std::uint32_t* at = &buckets_[bucket_of(entries_[entry].line)];
    while (*at != entry) at = &entries_[*at].chain;
    *at = entries_[entry].chain;
}

void TileCache::unlink(std::uint32_t entry) {
    const Entry& gone = entries_[entry];
    (gone.older == none ? oldest_ : entries_[gone.older].newer) = gone.newer;
    (gone.newer == none ? newest_ : entries_[gone.newer].older) = gone.older;
}

void TileCache::append(std::uint32_t entry) {
    entries_[entry].older = newest_;
    entries_[entry].newer = none;
    (newest_ == none ? oldest_ : entries_[newest_].newer) = entry;
    newest_ = entry;
}

} // namespace pipeline
