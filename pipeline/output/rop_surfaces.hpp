// What a ROP group works on, and what it is built for.
#pragma once

#include "pipeline/fragment/pass_context.hpp"
#include "pipeline/fragment/quad_payloads.hpp"
#include "pipeline/output/clear_bits.hpp"
#include "pipeline/output/fragment_lists.hpp"
#include "pipeline/output/hazard_ledger.hpp"
#include "pipeline/surface.hpp"

#include <vector>

namespace pipeline {

/// What the fixed-function ROP reads and writes in the pass that runs; each pixel is touched by the group that owns it.
struct FixedSurfaces {
    SurfaceStore* surfaces = nullptr;
    SurfaceId depth = no_surface;
    std::vector<SurfaceId> targets; ///< parallel to PassContext::targets; empty: nobody wants the colours' values
    // Sectors that a fast clear left unwritten; nothing: never cleared. One for each colour target.
    std::vector<ClearBits*> depth_clear, colour_clear;
    // Of a layer that is peeled, in row order.
    std::vector<QuadId> winner;       ///< that passed last; ~0 = cleared
    std::vector<DepthCode> far_depth; ///< of the farthest fragment, where it is captured, too; 0 = cleared
    std::vector<QuadId> far_winner;
};

/// Bytes that go past the caches: a clear writes, a copy reads and writes as many, a resolve writes what a fast clear
/// left. The ROP groups take the chunks of the surface in turn.
struct SurfaceStream {
    std::uint64_t read_bytes = 0, write_bytes = 0; ///< of one group's share
    std::uint64_t read_address = 0, write_address = 0;
    bool resolve = false;
};

/// What one draw did to the output stage.
struct DrawOutput {
    std::uint64_t quads = 0, fragments = 0;
    std::uint64_t passed = 0; ///< fragments that no test of the ROP killed
    std::uint64_t hazards = 0;
    sim::Cycle first_cycle = ~sim::Cycle{0}, last_cycle = 0;
};

/// Surfaces and per-pixel books that all groups of a machine share, each its own pixels.
struct RopSurfaces {
    FixedSurfaces* fixed = nullptr;
    KBufferMemory* kbuffer = nullptr;
    StoreHistory* history = nullptr;
    QuadPayloads* payloads = nullptr;
    FragmentLists* lists = nullptr;
    ClearBits* kbuffer_clear = nullptr; ///< of the k-buffer, or of the heads of lists
};

/// What a group is built for.
struct RopShape {
    std::uint32_t pipes = 1; ///< texture units that may read the k-buffer
    std::size_t draws = 0;   ///< draws of the frame, for the counters per draw
    bool depth = true;       ///< has a depth cache
    bool colour = true;      ///< has a colour cache
    std::uint32_t memory_partitions = 1;
    std::uint32_t interleave = 256; ///< bytes; a request is cut where the next partition begins
    std::uint32_t index = 0;        ///< of this group among the ROP groups
};

} // namespace pipeline
