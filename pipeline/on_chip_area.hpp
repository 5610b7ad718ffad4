// The on-chip memory of a GPU that a design uses: tile caches, the payloads that wait behind the shaders, and what the
// design adds. The price at which designs are compared.
//
// Counted: the tile caches that the design's machine builds; 4 pixels of payload for every place in which a quad waits
// with its results (reorder buffer, ROP queues); tables, side buffers, locks, associative memories, pipeline and
// forwarding registers, version and clear bits. Not counted, as all designs have them alike: texture caches, register
// files, tags and queues in front of the shaders.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/gpu_params.hpp"
#include "pipeline/output/kbuffer_design.hpp"

#include <nlohmann/json_fwd.hpp>

namespace pipeline {

/// Capacity of the whole GPU; 0 for a cache that is not built.
struct TileCacheBytes {
    std::uint64_t depth = 0, colour = 0, kbuffer = 0;
    std::uint64_t total() const { return depth + colour + kbuffer; }
};

struct OnChipArea {
    TileCacheBytes tile_caches;
    std::uint64_t payload_bytes = 0;
    AddedHardware added;

    std::uint64_t added_bytes() const; ///< each memory in whole bytes
    std::uint64_t total_bytes() const { return tile_caches.total() + payload_bytes + added_bytes(); }
};

/// Depth surfaces are tested or written in this frame with this plan; colour surfaces are written.
bool uses_depth(const Frame& frame, const KBufferPlan& plan);
bool uses_colour(const Frame& frame, const KBufferPlan& plan);

/// Bytes of a 2x2 sector in each of the caches; of lists, which cache their heads, in that of the k-buffer.
TileCacheBytes sector_bytes(const Frame& frame, const KBufferPlan& plan);

GpuShape shape_of(const GpuParams& gpu);

OnChipArea on_chip_area(const GpuParams& gpu, const Frame& frame, const KBufferDesign& design);

/// { tile_cache_bytes, payload_bytes, added_bytes, total_bytes, added: { name: bytes }, comparators, alu_lanes }.
nlohmann::ordered_json area_json(const OnChipArea& area);

/// A design of at most this many bytes on chip.
struct FittedCaches {
    bool fits = false;
    RopParams rop;            ///< with the caches' new sizes
    std::uint64_t needed = 0; ///< bytes that do not fit, or the total
};

/// Gives the tile caches what is left of `budget` bytes, in whole sectors of every ROP group; several caches share it
/// in the ratio of their sizes. It does not fit where less than a quad's sectors would be left for a ROP group.
FittedCaches fit_caches(const GpuParams& gpu, const Frame& frame, const KBufferDesign& design, std::uint64_t budget);

} // namespace pipeline
