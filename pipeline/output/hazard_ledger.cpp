#include "pipeline/output/hazard_ledger.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

namespace pipeline {

// Reads of several render targets at different instants belong to the class of the earliest, so that whatever is H1 is
// concurrency and whatever is H3 is not.
HazardClass HazardLedger::class_of(const Read& read, const StoreHistory::Store& aggressor) {
    if (read.oldest != read.newest) return HazardClass::h4_torn_read;
    if (read.first < aggressor.retired) return HazardClass::h1_in_flight;
    if (aggressor.visible == StoreHistory::never || read.first < aggressor.visible) return HazardClass::h2_write_path;
    CHECK_MSG(
        read.oldest >= read.order || read.last_fill < aggressor.visible,
        fmt::format("an array read at {} lacks the store of quad {}, which it could see from {} on: {} of {} stores",
                    read.last_fill, aggressor.quad, aggressor.visible, read.oldest, read.order));
    return HazardClass::h3_stale_line;
}

bool HazardLedger::book(std::uint32_t block, std::uint32_t pixel, std::uint32_t quad, const Read& read,
                        sim::Cycle stored) {
    // A read can hold more than its predecessors where nothing keeps the quads of a pixel in order: it misses nothing,
    // and whoever overtook it is the victim.
    const bool hazard = read.oldest < read.order || read.oldest != read.newest;
    const StoreHistory::Store& aggressor = history_->store(block, pixel);
    // Where nothing keeps the quads of a pixel in order, a predecessor can be on its way even now.
    const bool on_its_way = read.oldest < read.order && aggressor.number < read.order;
    const HazardKind kind =
        on_its_way || read.first < aggressor.stored ? HazardKind::concurrency : HazardKind::incoherence;
    if (keep_accesses_) accesses_.push_back({block * 4 + pixel, quad, read.first, stored, hazard, kind});
    if (!hazard) return false;
    const HazardClass cause = on_its_way ? HazardClass::h1_in_flight : class_of(read, aggressor);
    ++counts_.at(cause, kind);
    std::uint8_t& classes = history_->classes(block, pixel);
    counts_.pixels += classes == 0 ? 1 : 0;
    classes = static_cast<std::uint8_t>(classes | 1U << static_cast<unsigned>(cause));

    const std::uint32_t missing = read.order > read.oldest ? read.order - read.oldest : 0;
    staleness_sum_ += missing;
    staleness_max_ = std::max<std::uint64_t>(staleness_max_, missing);
    const auto bin = static_cast<std::size_t>(std::bit_width(quad > aggressor.quad ? quad - aggressor.quad : 1U)) - 1;
    if (distances_.size() <= bin) distances_.resize(bin + 1);
    ++distances_[bin];
    keep_pair(block, pixel, {0, 0, cause, kind, quad, aggressor.quad, missing, read.first, aggressor.stored});
    return true;
}

void HazardLedger::keep_pair(std::uint32_t block, std::uint32_t pixel, const HazardPair& pair) {
    if (pairs_.size() == pairs_kept) return;
    pairs_.push_back(pair);
    pairs_.back().x = static_cast<std::uint16_t>(layout_.block_x(block) + pixel % 2);
    pairs_.back().y = static_cast<std::uint16_t>(layout_.pixel_row(layout_.block_y(block)) + pixel / 2);
}

} // namespace pipeline
