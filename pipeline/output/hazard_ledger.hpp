// The books of read-modify-write hazards: which stores were computed from a value that lacked an earlier one, and why.
//
// A hazard is a fragment whose read missed at least one predecessor at its pixel. It is counted once, in the class of
// the latest predecessor it missed, which is the one whose store it overwrites (the colliding pair). Source:
// specification 004, section 7.1 (hazard definition, H1-H4).
#pragma once

#include "pipeline/output/hazards.hpp"
#include "pipeline/output/surface_layout.hpp"

#include <array>
#include <vector>

namespace pipeline {

/// Latest store at each pixel, shared by the partitions; each pixel is touched by the one that owns it.
class StoreHistory {
  public:
    static constexpr sim::Cycle never = ~sim::Cycle{0};

    struct Store {
        std::uint32_t quad = 0;
        std::uint32_t number = 0; ///< stores there have been, this one included
        sim::Cycle retired = 0;
        sim::Cycle stored = 0;
        sim::Cycle visible = never; ///< first cycle at which a k-buffer read sees it
    };

    explicit StoreHistory(const SurfaceLayout& layout)
        : stores_(std::size_t{4} * layout.blocks()), classes_(stores_.size()) {}

    Store& store(std::uint32_t block, std::uint32_t pixel) { return stores_[block * std::size_t{4} + pixel]; }
    std::uint8_t& classes(std::uint32_t block, std::uint32_t pixel) { return classes_[block * std::size_t{4} + pixel]; }
    std::uint8_t classes(std::uint32_t block, std::uint32_t pixel) const {
        return classes_[block * std::size_t{4} + pixel];
    }
    void tile_visible(std::uint32_t tile, sim::Cycle at);

  private:
    std::vector<Store> stores_;
    std::vector<std::uint8_t> classes_; ///< bit i: hazard class i happened at this pixel
};

/// One partition's counts.
class HazardLedger {
  public:
    static constexpr std::size_t pairs_kept = 4096;

    /// What a store was computed from.
    struct Read {
        std::uint32_t order = 0;  ///< predecessors there are
        std::uint32_t oldest = 0; ///< predecessors contained, minimum over the render targets
        std::uint32_t newest = 0; ///< and maximum
        sim::Cycle cycle = 0;     ///< when it was sampled
    };

    HazardLedger(const SurfaceLayout& layout, StoreHistory& history) : layout_(layout), history_(&history) {}

    /// Books the store of one fragment, before it is entered into the history. Returns true when it is a hazard.
    bool book(std::uint32_t block, std::uint32_t pixel, std::uint32_t quad, const Read& read);
    void enter(std::uint32_t block, std::uint32_t pixel, std::uint32_t quad, sim::Cycle retired, sim::Cycle stored,
               sim::Cycle visible) {
        StoreHistory::Store& store = history_->store(block, pixel);
        store = {quad, store.number + 1, retired, stored, visible};
    }

    const HazardCounts& counts() const { return counts_; }
    const std::vector<HazardPair>& pairs() const { return pairs_; }
    const std::vector<std::uint64_t>& distances() const { return distances_; }
    std::uint64_t staleness_sum() const { return staleness_sum_; }
    std::uint64_t staleness_max() const { return staleness_max_; }

  private:
    SurfaceLayout layout_;
    StoreHistory* history_;
    HazardCounts counts_;
    std::vector<HazardPair> pairs_;
    std::vector<std::uint64_t> distances_;
    std::uint64_t staleness_sum_ = 0, staleness_max_ = 0;
};

} // namespace pipeline
