// What is known of a read-modify-write hazard.
#pragma once

#include "sim/time.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace pipeline {

/// Where the predecessor was whose update a read missed (specification 004, section 7.1).
enum class HazardClass : std::uint8_t {
    h1_in_flight,  ///< in a shader pipe or in the reorder buffer
    h2_write_path, ///< it was retired, but its store was not observable yet
    h3_stale_line, ///< it was observable, but the texture cache line was older
    h4_torn_read,  ///< the render targets of one read held different versions
};
inline constexpr std::size_t hazard_classes = 4;

/// Whether coherent reads at the same instants would have missed the update, too.
enum class HazardKind : std::uint8_t {
    concurrency, ///< yes: the store had not reached the point of coherence (tile cache, L2 or memory)
    incoherence, ///< no: the value read was a copy that nobody had told of the store
};
inline constexpr std::size_t hazard_kinds = 2;

/// One victim with the predecessor whose update it overwrites: the latest one that its read missed.
struct HazardPair {
    std::uint16_t x = 0, y = 0;
    HazardClass cause = HazardClass::h1_in_flight;
    HazardKind kind = HazardKind::concurrency;
    std::uint32_t victim = 0;    ///< QuadId
    std::uint32_t aggressor = 0; ///< QuadId
    std::uint32_t missing = 0;   ///< predecessors missing from the value read (staleness in versions)
    sim::Cycle read = 0;         ///< core cycle in which the earliest of the victim's values was read
    sim::Cycle write = 0;        ///< first core cycle in which a coherent read would have seen the aggressor's store
};

/// Victim fragments by class and kind; each is counted once.
struct HazardCounts {
    std::array<std::array<std::uint64_t, hazard_kinds>, hazard_classes> by{}; ///< [HazardClass][HazardKind]
    std::uint64_t pixels = 0; ///< distinct pixels with at least one victim

    std::uint64_t& at(HazardClass cause, HazardKind kind) {
        return by[static_cast<std::size_t>(cause)][static_cast<std::size_t>(kind)];
    }
    std::uint64_t of(HazardClass cause) const {
        const auto& row = by[static_cast<std::size_t>(cause)];
        return row[0] + row[1];
    }
    std::uint64_t of(HazardKind kind) const {
        std::uint64_t sum = 0;
        for (const auto& row : by) sum += row[static_cast<std::size_t>(kind)];
        return sum;
    }
    std::uint64_t total() const { return of(HazardKind::concurrency) + of(HazardKind::incoherence); }
    HazardCounts& operator+=(const HazardCounts& other) {
        for (std::size_t cause = 0; cause < hazard_classes; ++cause)
            for (std::size_t kind = 0; kind < hazard_kinds; ++kind) by[cause][kind] += other.by[cause][kind];
        pixels += other.pixels;
        return *this;
    }
};

} // namespace pipeline
