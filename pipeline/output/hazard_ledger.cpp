#include "pipeline/output/hazard_ledger.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <bit>

namespace pipeline {

void StoreHistory::tile_visible(std::uint32_t tile, sim::Cycle at) {
    for (std::size_t pixel = std::size_t{16} * tile; pixel < std::size_t{16} * tile + 16; ++pixel)
        if (stores_[pixel].visible == never) stores_[pixel].visible = at;
}

bool HazardLedger::book(std::uint32_t block, std::uint32_t pixel, std::uint32_t quad, const Read& read) {
    if (read.oldest == read.order && read.newest == read.order) return false;
    const StoreHistory::Store& aggressor = history_->store(block, pixel);
    HazardClass kind = HazardClass::h3_stale_line;
    if (read.oldest != read.newest)
        kind = HazardClass::h4_torn_read;
    else if (read.cycle < aggressor.retired)
        kind = HazardClass::h1_in_flight;
    else if (aggressor.visible == StoreHistory::never || read.cycle < aggressor.visible)
        kind = HazardClass::h2_write_path;

    const std::array<std::uint64_t*, 4> counters{&counts_.h1, &counts_.h2, &counts_.h3, &counts_.h4};
    ++*counters[static_cast<std::size_t>(kind)];
    std::uint8_t& classes = history_->classes(block, pixel);
    counts_.pixels += classes == 0 ? 1 : 0;
    classes = static_cast<std::uint8_t>(classes | 1U << static_cast<unsigned>(kind));

    // A read can hold a successor's store, too, where nothing keeps quads of one pixel in order.
    const std::uint32_t missing = read.order > read.oldest ? read.order - read.oldest : 0;
    staleness_sum_ += missing;
    staleness_max_ = std::max<std::uint64_t>(staleness_max_, missing);
    const auto bin = static_cast<std::size_t>(std::bit_width(quad > aggressor.quad ? quad - aggressor.quad : 1U)) - 1;
    if (distances_.size() <= bin) distances_.resize(bin + 1);
    ++distances_[bin];
    if (pairs_.size() < pairs_kept)
        pairs_.push_back({static_cast<std::uint16_t>(layout_.block_x(block) + pixel % 2),
                          static_cast<std::uint16_t>(layout_.pixel_row(layout_.block_y(block)) + pixel / 2), kind, quad,
                          aggressor.quad, missing, read.cycle, aggressor.stored});
    return true;
}

} // namespace pipeline
