// A ROP partition alone: depth test and colour write, tile caches, input queue. Links take one cycle, memory 100: a
// quad sent at cycle 0 is admitted at 1 and executed at 2; a tile asked for at 1 is there at 103.
#include "tests/support/rop_kit.hpp"

namespace {

using Cycles = std::vector<sim::Cycle>;
using Tiles = std::vector<std::uint64_t>;
using pipeline::MemoryClient;
using tests::RopBench;
using tests::RopOptions;

constexpr sim::Cycle hit = 2, miss = 103;

struct DepthPass : tests::QuadPass {
    DepthPass() { context.depth = {true, true}; }
};
struct ColourPass : tests::QuadPass {
    pipeline::Frame frame;
    explicit ColourPass(pipeline::BlendMode blend = pipeline::BlendMode::replace) {
        frame.colour_format = pipeline::ColourFormat::rgba32f;
        context.frame = &frame;
        context.colour_write = true;
        context.blend = blend;
    }
};

TEST(RopFixedFunction, DepthTestWaitsForAMissingTileAndNotForAResidentOne) {
    DepthPass pass;
    for (std::uint32_t draw = 0; draw < 2; ++draw) {
        pass.triangle(draw);
        pass.quad(0, 0, 15, draw == 0 ? 0.5F : 0.25F);
    }
    RopBench bench(pass, {.source = {.gap = 200}});
    bench.run();
    EXPECT_EQ(bench.executed(0), (std::pair{miss, miss}));
    EXPECT_EQ(bench.executed(1), (std::pair{200 + hit, 200 + hit}));
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_read), (Cycles{2}));
    EXPECT_EQ(bench.rop.stats().depth_tiles.misses, 1U);
    EXPECT_EQ(bench.rop.stats().depth_tiles.hits, 1U);
}

TEST(RopFixedFunction, QuadThatFindsItsTileOnItsWayAsksForNothing) {
    DepthPass pass;
    pass.quad(0, 0);
    pass.quad(2, 0);
    RopBench bench(pass);
    bench.run();
    EXPECT_EQ(bench.executed(), (std::pair{miss, miss + 1}));
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_read).size(), 1U);
}

TEST(RopFixedFunction, DepthTestKeepsTheNearestAndTheFirstOfEqualOnes) {
    DepthPass pass;
    for (const float depth : {0.5F, 0.75F, 0.25F, 0.25F}) pass.quad(0, 0, 1, depth);
    RopBench bench(pass);
    bench.run();
    EXPECT_EQ(bench.fixed.winner[0], 2U);
    EXPECT_EQ(bench.fixed.depth[0], pipeline::depth_code(pass.context.depth_format, 0.25F));
    EXPECT_EQ(bench.fixed.winner[1], ~pipeline::QuadId{0}); // not covered
    EXPECT_EQ(bench.rop.stats().depth_passed, 2U);
    EXPECT_EQ(bench.rop.stats().depth_failed, 2U);
}

TEST(RopFixedFunction, OnlyWhatPassesMakesItsTileDirty) {
    for (const bool passes : {false, true}) {
        DepthPass pass;
        pass.quad(0, 0, 15, 0.5F);
        RopBench bench(pass);
        if (!passes) bench.fixed.depth.assign(bench.fixed.depth.size(), 0);
        bench.run();
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), 0U);
        bench.write_back();
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), passes ? 1U : 0U);
    }
}

TEST(RopFixedFunction, OpaqueColourIsNotFetchedAndBlendedColourIs) {
    for (const pipeline::BlendMode blend : {pipeline::BlendMode::replace, pipeline::BlendMode::add}) {
        const bool opaque = blend == pipeline::BlendMode::replace;
        ColourPass pass(blend);
        pass.frame.opacity = 1.0F;
        pass.quad(0, 0, 1);
        pass.stream.colours[0][0] = {0.25F, 0.5F, 0.0F, 1.0F};
        RopBench bench(pass);
        bench.fixed.colour.assign(std::size_t{64} * 64, {0.5F, 0.0F, 0.0F, 0.0F});
        bench.run();
        EXPECT_EQ(bench.executed().first, opaque ? hit : miss);
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_read).size(), opaque ? 0U : 1U);
        EXPECT_EQ(bench.fixed.colour[0].r, opaque ? 0.25F : 0.75F);
        EXPECT_EQ(bench.fixed.colour[0].g, 0.5F);
        EXPECT_EQ(bench.fixed.colour[1].r, 0.5F); // not covered
    }
}

// Four fragments: 16 bytes of depth read, 16 written, 16 of colour written, 16 read where they are blended.
TEST(RopFixedFunction, PortOfTheTileCacheSetsTheRate) {
    const auto cycles_per_quad = [](bool colour, pipeline::BlendMode blend, float depth, std::uint32_t units) {
        DepthPass pass;
        pipeline::Frame frame;
        pass.context.frame = &frame;
        pass.context.colour_write = colour;
        pass.context.blend = blend;
        for (const std::uint32_t block : {0U, 1U, 2U, 3U}) pass.quad(block % 2 * 2, block / 2 * 2, 15, depth);
        RopBench bench(pass, {.rop = {.units = units, .bytes_per_clk = 16}});
        bench.run();
        return (bench.executed().second - bench.executed().first) / 3;
    };
    using pipeline::BlendMode;
    EXPECT_EQ(cycles_per_quad(false, BlendMode::replace, 0.5F, 1), 2U);
    EXPECT_EQ(cycles_per_quad(true, BlendMode::replace, 0.5F, 1), 3U);
    EXPECT_EQ(cycles_per_quad(true, BlendMode::add, 0.5F, 1), 4U);
    EXPECT_EQ(cycles_per_quad(true, BlendMode::add, 1.0F, 1), 1U); // fails against the cleared surface: read only
    EXPECT_EQ(cycles_per_quad(true, BlendMode::add, 0.5F, 2), 2U);
    EXPECT_EQ(cycles_per_quad(true, BlendMode::add, 0.5F, 4), 1U);
}

TEST(RopFixedFunction, LeastRecentlyUsedTileIsReplacedAndWrittenBackAtOnce) {
    ColourPass pass;
    for (const std::uint32_t tile : {0U, 1U, 0U, 2U, 0U}) pass.quad(tile * 4, 0);
    RopBench bench(pass, {.rop = {.cache_tiles = 2}, .source = {.gap = 10}});
    bench.run();
    EXPECT_EQ(bench.requested_tiles(MemoryClient::tile_write), (Tiles{1}));
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{3 * 10 + 2})); // admitted at 31
    EXPECT_EQ(bench.rop.stats().colour_tiles.misses, 3U);
    EXPECT_EQ(bench.rop.stats().colour_tiles.hits, 2U);
    bench.write_back();
    EXPECT_EQ(bench.requested_tiles(MemoryClient::tile_write), (Tiles{1, 0, 2}));
    EXPECT_EQ(bench.rop.stats().colour_tiles.writebacks, 3U);
}

TEST(RopFixedFunction, ReplacedTileIsWrittenBeforeTheNewOneIsRead) {
    DepthPass pass;
    for (const std::uint32_t tile : {0U, 1U}) pass.quad(tile * 4, 0);
    RopBench bench(pass, {.rop = {.cache_tiles = 1}, .source = {.gap = 200}});
    bench.run();
    ASSERT_EQ(bench.memory.arrivals.size(), 3U);
    EXPECT_TRUE(bench.memory.arrivals[1].request.write);
    EXPECT_FALSE(bench.memory.arrivals[2].request.write);
    EXPECT_EQ(bench.requested_tiles(MemoryClient::tile_write), (Tiles{0}));
    EXPECT_EQ(bench.requested_tiles(MemoryClient::tile_read), (Tiles{0, 1}));
}

TEST(RopFixedFunction, WriteBackSendsOneDirtyTilePerCycle) {
    ColourPass pass;
    for (const std::uint32_t tile : {3U, 1U, 4U, 2U}) pass.quad(tile * 4, 0);
    RopBench bench(pass);
    bench.run();
    bench.write_back();
    const Cycles cycles = bench.request_cycles(MemoryClient::tile_write);
    EXPECT_EQ(bench.requested_tiles(MemoryClient::tile_write), (Tiles{3, 1, 4, 2}));
    EXPECT_EQ(cycles.back() - cycles.front(), 3U);
    bench.write_back();
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), 4U); // clean by now
}

TEST(RopFixedFunction, TileThatAQuadWaitsForIsNotReplaced) {
    DepthPass pass;
    for (const std::uint32_t tile : {0U, 1U}) pass.quad(tile * 4, 0);
    RopBench bench(pass, {.rop = {.cache_tiles = 1}});
    bench.run();
    // Replaced when the first quad has been executed; its write goes first through a link of one request per cycle.
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{miss + 1}));
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_read), (Cycles{2, miss + 2}));
    EXPECT_EQ(bench.executed(), (std::pair{miss, miss + 103}));
}

// Two quads wait inside, two in the link; the fifth is sent when the first has been executed.
TEST(RopFixedFunction, FullQueueHoldsTheCrossbarBack) {
    DepthPass pass;
    for (std::uint32_t tile = 0; tile < 8; ++tile) pass.quad(tile * 4, 0);
    RopBench bench(pass, {.rop = {.queue = 2}});
    bench.run();
    EXPECT_EQ(bench.source.cycles(), (Cycles{0, 1, 2, 3, miss + 1, miss + 2, miss + 102 + 1, miss + 102 + 2}));
    EXPECT_EQ(bench.rop.stats().queue_max.value, 2U);
    EXPECT_EQ(bench.rop.stats().quads, 8U);
}

TEST(RopFixedFunction, ClearAndCopyMoveTheirBytes) {
    const DepthPass pass;
    RopBench bench(pass);
    bench.rop.stream(0, 1000);
    bench.run();
    EXPECT_EQ(bench.memory.arrivals.size(), 4U); // 256 bytes each, and the rest
    bench.rop.stream(512, 512);
    bench.run();
    std::uint64_t read = 0, written = 0;
    for (const auto& [request, cycle] : bench.memory.arrivals) (request.write ? written : read) += request.bytes;
    EXPECT_EQ(read, 512U);
    EXPECT_EQ(written, 1512U);
    EXPECT_EQ(bench.rop.stats().clears, 1000U);
    EXPECT_EQ(bench.rop.stats().copies, 1024U);
}

TEST(RopFixedFunction, ActivitiesSumToTheElapsedTimeAndModesAgree) {
    DepthPass pass;
    for (std::uint32_t i = 0; i < 300; ++i)
        pass.quad(i * 6 % 32, i * 10 % 32, static_cast<std::uint8_t>(i % 15 + 1), 1.0F / static_cast<float>(i + 2));
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        RopBench bench(pass, {.rop = {.units = 1, .cache_tiles = 4, .queue = 4}, .mode = mode, .shuffle = shuffle});
        bench.run();
        bench.write_back();
        sim::Time sum = 0;
        for (const sim::Time time : bench.rop.activity_times()) sum += time;
        EXPECT_EQ(sum, bench.rig.simulation.now());
        EXPECT_EQ(bench.rop.stats().quads, 300U);
        return std::tuple(bench.source.cycles(), bench.request_cycles(MemoryClient::tile_write),
                          bench.rop.activity_times(), bench.fixed.winner);
    });
}

} // namespace
