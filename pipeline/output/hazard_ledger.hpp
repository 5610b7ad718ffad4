// The books of read-modify-write hazards: which stores were computed from a value that lacked an earlier one, and why.
//
// A hazard is a fragment whose read missed at least one predecessor at its pixel. It is counted once, in the class of
// the latest predecessor it missed, which is the one whose store it overwrites (the colliding pair), and as one of two
// kinds: concurrency, when coherent reads at the same instants would have missed that store too, else incoherence.
// Every time is the first cycle at which a read of the array in question returns the value. Source: specification 004,
// section 7.1 (hazard definition, H1-H4).
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
        sim::Cycle stored = 0;      ///< t_rop: first cycle at which a coherent read sees it
        sim::Cycle visible = never; ///< t_vis: first cycle at which a k-buffer read of this design sees it
    };

    explicit StoreHistory(const SurfaceLayout& layout)
        : stores_(std::size_t{4} * layout.blocks()), classes_(stores_.size()) {}

    Store& store(std::uint32_t block, std::uint32_t pixel) { return stores_[block * std::size_t{4} + pixel]; }
    std::uint8_t& classes(std::uint32_t block, std::uint32_t pixel) { return classes_[block * std::size_t{4} + pixel]; }
    std::uint8_t classes(std::uint32_t block, std::uint32_t pixel) const {
        return classes_[block * std::size_t{4} + pixel];
    }
    /// The store of this number, and so all before it, can be seen from `at` on.
    void make_visible(std::uint32_t block, std::uint32_t pixel, std::uint32_t number, sim::Cycle at) {
        Store& latest = store(block, pixel);
        if (latest.number <= number && latest.visible == never) latest.visible = at;
    }

    /// As before the first store; hazards stay on record.
    void forget_stores() { stores_.assign(stores_.size(), {}); }

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
        sim::Cycle first = 0;     ///< t_rd of the render target that was read first
        sim::Cycle last_fill = 0; ///< latest array read that supplied any of the values
    };

    HazardLedger(const SurfaceLayout& layout, StoreHistory& history) : layout_(layout), history_(&history) {}

    /// Books the store of one fragment, before it is entered into the history. Returns true when it is a hazard.
    /// @param stored its t_rop
    bool book(std::uint32_t block, std::uint32_t pixel, std::uint32_t quad, const Read& read, sim::Cycle stored);
    void enter(std::uint32_t block, std::uint32_t pixel, std::uint32_t quad, sim::Cycle retired, sim::Cycle stored,
               sim::Cycle visible) {
        StoreHistory::Store& store = history_->store(block, pixel);
        store = {quad, store.number + 1, retired, stored, visible};
    }

    /// One booked store, for whoever wants to replay the accesses to a pixel.
    struct Access {
        std::uint32_t place = 0; ///< block * 4 + pixel
        std::uint32_t quad = 0;
        sim::Cycle read = 0;   ///< t_rd, the earliest of its render targets
        sim::Cycle stored = 0; ///< t_rop
        bool hazard = false;
        HazardKind kind = HazardKind::concurrency; ///< of a hazard
    };
    /// From now on every store is kept, in the order of booking.
    void keep_accesses() { keep_accesses_ = true; }
    const std::vector<Access>& accesses() const { return accesses_; }

    const HazardCounts& counts() const { return counts_; }
    const std::vector<HazardPair>& pairs() const { return pairs_; }
    const std::vector<std::uint64_t>& distances() const { return distances_; }
    std::uint64_t staleness_sum() const { return staleness_sum_; }
    std::uint64_t staleness_max() const { return staleness_max_; }

  private:
    static HazardClass class_of(const Read& read, const StoreHistory::Store& aggressor);
    void keep_pair(std::uint32_t block, std::uint32_t pixel, const HazardPair& pair);

    SurfaceLayout layout_;
    StoreHistory* history_;
    HazardCounts counts_;
    std::vector<HazardPair> pairs_;
    std::vector<std::uint64_t> distances_;
    std::uint64_t staleness_sum_ = 0, staleness_max_ = 0;
    bool keep_accesses_ = false;
    std::vector<Access> accesses_;
};

} // namespace pipeline
