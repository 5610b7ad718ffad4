// Parameters and counters of the ROP groups; the unit is in rop.hpp.
#pragma once

#include "pipeline/output/tile_cache.hpp"
#include "pipeline/surface_format.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

namespace pipeline {

struct RopParams {
    static constexpr std::uint32_t largest_cache = 1U << 30U; ///< bytes

    std::uint32_t units = 16;
    std::uint32_t bytes_per_clk = 16;
    std::uint32_t depth_cache_bytes = 16384;
    std::uint32_t colour_cache_bytes = 65536;
    std::uint32_t kbuffer_cache_bytes = 65536;
    std::uint32_t queue = 128;
    std::uint32_t reads_per_clk = 1;
    std::uint32_t read_request_latency = 140;
    std::uint32_t read_return_latency = 140;
    bool fast_clear = false;
    std::uint32_t clear_sectors = 1048576;
    Fp16Overflow fp16_overflow = Fp16Overflow::saturate;

    /// Groups of four; throws sim::InputError when the ROPs do not come in groups.
    std::uint32_t groups() const;

    static constexpr auto fields() {
        using P = RopParams;
        return std::tuple{
            sim::field<&P::units>("ROPs of all groups together, a multiple of 4").unit("rops").range(4, 256),
            sim::field<&P::bytes_per_clk>("Bytes one ROP moves to or from its caches per cycle")
                .unit("bytes")
                .range(1, 1024),
            sim::field<&P::depth_cache_bytes>("Depth caches of all ROP groups together")
                .unit("bytes")
                .range(64, largest_cache),
            sim::field<&P::colour_cache_bytes>("Colour caches of all ROP groups together")
                .unit("bytes")
                .range(64, largest_cache),
            sim::field<&P::kbuffer_cache_bytes>("k-buffer caches of all ROP groups together")
                .unit("bytes")
                .range(64, largest_cache),
            sim::field<&P::queue>("Quads of a group whose sectors are looked up ahead of execution")
                .unit("quads")
                .range(1, 4096),
            sim::field<&P::reads_per_clk>("k-buffer reads of texture units that a group accepts per cycle")
                .unit("reads")
                .range(1, 64),
            sim::field<&P::read_request_latency>(
                "From a texture unit's k-buffer read to the access of the cache, when that holds the pixels")
                .unit("cycles")
                .range(0, 100000),
            sim::field<&P::read_return_latency>("From that access to the value in the texture unit")
                .unit("cycles")
                .range(1, 100000),
            sim::field<&P::fast_clear>("Clears mark sectors in a table instead of writing them"),
            sim::field<&P::clear_sectors>(
                "Sectors of a surface that the table of its fast clears covers; larger ones are cleared by writing")
                .unit("sectors")
                .range(0, 1U << 30U),
            sim::field<&P::fp16_overflow>(
                "What 16-bit float surfaces store of a colour beyond their range: the largest "
                "finite number, or infinity, as IEEE 754 has it")};
    }
};
static_assert(sim::fully_described<RopParams>);

struct RopStats {
    sim::Counter quads, fragments, depth_passed, depth_failed, stencil_failed, stores, program_runs, program_cycles,
        insertions, interlock_stalls, kbuffer_reads, kbuffer_reads_from_tiles, atomics, counter_atomics, kept, not_kept,
        passed_over, hazards_detected, hazards_overlooked, fp16_overflows, clears, copies, resolves;
    sim::HighWater queue_max;
    TileCacheStats depth_tiles, colour_tiles, kbuffer_tiles;

    static constexpr auto fields() {
        using S = RopStats;
        return std::tuple{
            sim::field<&S::quads>("Quads executed").unit("quads"),
            sim::field<&S::fragments>("Fragments executed").unit("fragments"),
            sim::field<&S::depth_passed>("Fragments that passed stencil and depth test").unit("fragments"),
            sim::field<&S::depth_failed>("Fragments that failed the depth test").unit("fragments"),
            sim::field<&S::stencil_failed>("Fragments that failed the stencil test").unit("fragments"),
            sim::field<&S::stores>("Pixels stored with values computed by a shader").unit("fragments"),
            sim::field<&S::program_runs>("Fragments run through the blender's program").unit("fragments"),
            sim::field<&S::program_cycles>("Cycles the blenders worked").unit("cycles"),
            sim::field<&S::insertions>("Program runs that changed their pixel").unit("fragments"),
            sim::field<&S::interlock_stalls>("Quads that waited for a pixel inside the blender").unit("quads"),
            sim::field<&S::kbuffer_reads>("k-buffer reads of texture units, one per quad").unit("reads"),
            sim::field<&S::kbuffer_reads_from_tiles>("Of those, served from the cache").unit("reads"),
            sim::field<&S::atomics>("Atomic minima executed").unit("operations"),
            sim::field<&S::counter_atomics>("Atomic additions to the counter of the lists' memory").unit("operations"),
            sim::field<&S::kept>("Fragments added to their pixel's list").unit("fragments"),
            sim::field<&S::not_kept>("Fragments that no list had room for").unit("fragments"),
            sim::field<&S::passed_over>("Fragments that another pass keeps").unit("fragments"),
            sim::field<&S::hazards_detected>(
                "Stores whose pixel had another version than the one they were computed from")
                .unit("fragments"),
            sim::field<&S::hazards_overlooked>("Of the hazards, those that the version numbers do not show")
                .unit("fragments"),
            sim::field<&S::fp16_overflows>("Channels of colours that were stored as 16-bit floats and lay beyond their "
                                           "range; IEEE 754 makes them infinite")
                .unit("channels"),
            sim::field<&S::clears>("Bytes written by clears").unit("bytes"),
            sim::field<&S::copies>("Bytes read and written by copies").unit("bytes"),
            sim::field<&S::resolves>("Bytes written of sectors that were cleared fast, for readers on the memory side")
                .unit("bytes"),
            sim::field<&S::queue_max>("Most quads waiting for their sectors").unit("quads"),
            sim::field<&S::depth_tiles>("Depth caches"),
            sim::field<&S::colour_tiles>("Colour caches"),
            sim::field<&S::kbuffer_tiles>("k-buffer caches")};
    }
};
static_assert(sim::fully_described<RopStats>);

} // namespace pipeline
