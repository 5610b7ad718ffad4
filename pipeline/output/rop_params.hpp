// Parameters and counters of a ROP partition; the unit is in rop.hpp.
#pragma once

#include "pipeline/output/tile_cache.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

namespace pipeline {

struct RopParams {
    std::uint32_t units = 16;
    std::uint32_t bytes_per_clk = 16;
    std::uint32_t cache_tiles = 32;
    std::uint32_t queue = 32;
    std::uint32_t reads_per_clk = 1;
    std::uint32_t read_latency = 280;
    bool fast_clear = false;

    static constexpr auto fields() {
        using P = RopParams;
        return std::tuple{
            sim::field<&P::units>("ROPs of all partitions together").unit("rops").range(1, 1024),
            sim::field<&P::bytes_per_clk>("Bytes one ROP moves to or from its tile cache per cycle")
                .unit("bytes")
                .range(1, 1024),
            sim::field<&P::cache_tiles>("4x4-pixel tiles in each tile cache of a partition")
                .unit("tiles")
                .range(1, 65534),
            sim::field<&P::queue>("Quads whose tiles are looked up ahead of execution").unit("quads").range(1, 4096),
            sim::field<&P::reads_per_clk>("k-buffer reads of texture units accepted per cycle")
                .unit("reads")
                .range(1, 64),
            sim::field<&P::read_latency>(
                "From a texture unit's k-buffer read to its value, when the tile is in the cache")
                .unit("cycles")
                .range(1, 10000),
            sim::field<&P::fast_clear>("Clears cost no memory traffic")};
    }
};
static_assert(sim::fully_described<RopParams>);

struct RopStats {
    sim::Counter quads, fragments, depth_passed, depth_failed, stores, program_runs, program_cycles, insertions,
        interlock_stalls, kbuffer_reads, kbuffer_reads_from_tiles, atomics, kept, not_kept, passed_over,
        hazards_detected, hazards_overlooked, clears, copies;
    sim::HighWater queue_max;
    TileCacheStats depth_tiles, colour_tiles, kbuffer_tiles;

    static constexpr auto fields() {
        using S = RopStats;
        return std::tuple{
            sim::field<&S::quads>("Quads executed").unit("quads"),
            sim::field<&S::fragments>("Fragments executed").unit("fragments"),
            sim::field<&S::depth_passed>("Fragments that passed the depth test").unit("fragments"),
            sim::field<&S::depth_failed>("Fragments that failed it").unit("fragments"),
            sim::field<&S::stores>("Pixels stored with values computed by a shader").unit("fragments"),
            sim::field<&S::program_runs>("Fragments run through the blender's program").unit("fragments"),
            sim::field<&S::program_cycles>("Cycles the blenders worked").unit("cycles"),
            sim::field<&S::insertions>("Program runs that changed their pixel").unit("fragments"),
            sim::field<&S::interlock_stalls>("Quads that waited for a pixel inside the blender").unit("quads"),
            sim::field<&S::kbuffer_reads>("k-buffer reads of texture units, one per quad").unit("reads"),
            sim::field<&S::kbuffer_reads_from_tiles>("Of those, served from the tile cache").unit("reads"),
            sim::field<&S::atomics>("Atomic minima executed").unit("operations"),
            sim::field<&S::kept>("Fragments added to their pixel's list").unit("fragments"),
            sim::field<&S::not_kept>("Fragments that no list had room for").unit("fragments"),
            sim::field<&S::passed_over>("Fragments that another pass keeps").unit("fragments"),
            sim::field<&S::hazards_detected>(
                "Stores whose pixel had another version than the one they were computed from")
                .unit("fragments"),
            sim::field<&S::hazards_overlooked>("Of the hazards, those that the version numbers do not show")
                .unit("fragments"),
            sim::field<&S::clears>("Bytes written by clears").unit("bytes"),
            sim::field<&S::copies>("Bytes read and written by copies").unit("bytes"),
            sim::field<&S::queue_max>("Most quads waiting for their tiles").unit("quads"),
            sim::field<&S::depth_tiles>("Depth tile cache"),
            sim::field<&S::colour_tiles>("Colour tile cache"),
            sim::field<&S::kbuffer_tiles>("k-buffer tile cache")};
    }
};
static_assert(sim::fully_described<RopStats>);

} // namespace pipeline
