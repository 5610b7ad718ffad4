// What a design adds to a GPU, in bits of on-chip memory, comparators and ALU lanes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pipeline {

/// What added hardware is sized by.
struct GpuShape {
    std::uint32_t quads_in_flight = 0; ///< places of the reorder buffer
    std::uint32_t rops = 0;
    std::uint32_t rop_groups = 0; ///< of ROPs that share tile caches and one interlock
};

struct AddedMemory {
    std::string name; ///< "side_buffer"
    std::uint64_t bits = 0;
};

/// Of all units of the GPU together. Nothing is what the hardware has anyway.
struct AddedHardware {
    std::vector<AddedMemory> memories;
    std::uint64_t comparators = 0;
    std::uint64_t alu_lanes = 0;
};

} // namespace pipeline
