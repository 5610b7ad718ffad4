// What is known of a read-modify-write hazard.
#pragma once

#include "sim/time.hpp"

#include <cstdint>

namespace pipeline {

/// Cause of a read that missed the update of a predecessor at its pixel (specification 004, section 7.1).
enum class HazardClass : std::uint8_t {
    h1_in_flight,  ///< the predecessor was still in a shader pipe or in the reorder buffer
    h2_write_path, ///< it was retired, but its store was not observable yet
    h3_stale_line, ///< it was observable, but the texture cache line was older
    h4_torn_read,  ///< the render targets of one read held different versions
};

/// One victim with the predecessor whose update it overwrites: the latest one that its read missed.
struct HazardPair {
    std::uint16_t x = 0, y = 0;
    HazardClass kind = HazardClass::h1_in_flight;
    std::uint32_t victim = 0;    ///< QuadId
    std::uint32_t aggressor = 0; ///< QuadId
    std::uint32_t missing = 0;   ///< predecessors missing from the value read (staleness in versions)
    sim::Cycle read = 0;         ///< core cycle the victim sampled its value
    sim::Cycle write = 0;        ///< core cycle the aggressor's store was applied
};

struct HazardCounts {
    std::uint64_t h1 = 0, h2 = 0, h3 = 0, h4 = 0; ///< victim fragments; each is counted in one class
    std::uint64_t pixels = 0;                     ///< distinct pixels with at least one victim
    std::uint64_t total() const { return h1 + h2 + h3 + h4; }
};

} // namespace pipeline
