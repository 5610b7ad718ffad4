// A ROP group alone: depth test and colour write, caches, input queue. A line of 4-byte pixels holds two sectors of 2x2
// pixels. Links take one cycle, memory 100: a
// quad sent at cycle 0 is admitted at 1 and executed at 2; a tile asked for at 1 is there at 103.
#include "tests/support/rop_kit.hpp"

namespace output_rop_fixed_function_test {

using Cycles = std::vector<sim::Cycle>;
using Lines = std::vector<std::uint64_t>;
using pipeline::MemoryClient;
using tests::RopBench;
using tests::RopOptions;

constexpr sim::Cycle hit = 2, miss = 103;

const pipeline::BlendState sum = pipeline::blends::of(pipeline::blends::sum);

struct DepthPass : tests::QuadPass {
    explicit DepthPass(const pipeline::BlendState& blend = {}) {
        pipeline::RasterState state;
        state.depth = {true, true};
        state.blend[0] = blend;
        context.states = pipeline::DrawStates(state);
    }
};
struct ColourPass : tests::QuadPass {
    explicit ColourPass(const pipeline::BlendState& blend = {}) {
        pipeline::RasterState state;
        state.blend[0] = blend;
        context.states = pipeline::DrawStates(state);
        write_colours(pipeline::SurfaceFormat::rgba32f);
    }
};

TEST(RopFixedFunction, DepthTestWaitsForAMissingSectorAndNotForAResidentOne) {
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

TEST(RopFixedFunction, QuadThatFindsItsLineOnItsWayAsksForNothing) {
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
    EXPECT_EQ(bench.depth().depth, pipeline::depth_code(pass.context.depth_format, 0.25F));
    EXPECT_EQ(bench.fixed.winner[1], ~pipeline::QuadId{0}); // not covered
    EXPECT_EQ(bench.rop.stats().depth_passed, 2U);
    EXPECT_EQ(bench.rop.stats().depth_failed, 2U);
}

TEST(RopFixedFunction, OnlyWhatPassesMakesItsLineDirty) {
    for (const bool passes : {false, true}) {
        DepthPass pass;
        pass.quad(0, 0, 15, 0.5F);
        RopBench bench(pass);
        if (!passes) bench.set_depth(0.0F);
        bench.run();
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), 0U);
        bench.write_back();
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), passes ? 1U : 0U);
    }
}

TEST(RopFixedFunction, OpaqueColourIsNotFetchedAndBlendedColourIs) {
    for (const pipeline::BlendState& blend : {pipeline::BlendState{}, sum}) {
        const bool opaque = !blend.enabled;
        ColourPass pass(blend);
        pass.quad(0, 0, 1);
        pass.stream.colours[0][0] = {0.25F, 0.5F, 0.0F, 1.0F};
        RopBench bench(pass);
        bench.set_colour({0.5F, 0.0F, 0.0F, 0.0F});
        bench.run();
        EXPECT_EQ(bench.executed().first, opaque ? hit : miss);
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_read).size(), opaque ? 0U : 1U);
        EXPECT_EQ(bench.colour().r, opaque ? 0.25F : 0.75F);
        EXPECT_EQ(bench.colour().g, 0.5F);
        EXPECT_EQ(bench.colour(1).r, 0.5F); // not covered
    }
}

// Four ROPs, four fragments: 16 bytes of depth read, 16 written, 16 of colour written, 16 read where they are blended.
TEST(RopFixedFunction, PortOfTheCacheSetsTheRate) {
    const auto cycles_per_quad = [](bool colour, const pipeline::BlendState& blend, float depth, std::uint32_t port) {
        DepthPass pass(blend);
        if (colour) pass.write_colours();
        for (const std::uint32_t block : {0U, 1U, 2U, 3U}) pass.quad(block % 2 * 2, block / 2 * 2, 15, depth);
        RopBench bench(pass, {.rop = {.bytes_per_clk = port}});
        bench.run();
        return (bench.executed().second - bench.executed().first) / 3;
    };
    const pipeline::BlendState replace;
    EXPECT_EQ(cycles_per_quad(false, replace, 0.5F, 4), 2U);
    EXPECT_EQ(cycles_per_quad(true, replace, 0.5F, 4), 3U);
    EXPECT_EQ(cycles_per_quad(true, sum, 0.5F, 4), 4U);
    EXPECT_EQ(cycles_per_quad(true, sum, 1.0F, 4), 1U); // fails against the cleared surface: read only
    EXPECT_EQ(cycles_per_quad(true, sum, 0.5F, 8), 2U);
    EXPECT_EQ(cycles_per_quad(true, sum, 0.5F, 16), 1U);
}

TEST(RopFixedFunction, LeastRecentlyUsedLineIsReplacedAndWrittenBackAtOnce) {
    ColourPass pass;
    for (const std::uint32_t tile : {0U, 1U, 0U, 2U, 0U}) pass.quad(tile * 4, 0);
    RopBench bench(pass, {.rop = {.colour_cache_bytes = 64}, .source = {.gap = 10}});
    bench.run();
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_write), (Lines{2}));
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{3 * 10 + 2})); // admitted at 31
    EXPECT_EQ(bench.rop.stats().colour_tiles.misses, 3U);
    EXPECT_EQ(bench.rop.stats().colour_tiles.hits, 2U);
    bench.write_back();
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_write), (Lines{2, 0, 4}));
    EXPECT_EQ(bench.rop.stats().colour_tiles.writebacks, 3U);
}

TEST(RopFixedFunction, ReplacedLineIsWrittenBeforeTheNewOneIsRead) {
    DepthPass pass;
    for (const std::uint32_t tile : {0U, 1U}) pass.quad(tile * 4, 0);
    RopBench bench(pass, {.rop = {.depth_cache_bytes = 32}, .source = {.gap = 200}});
    bench.run();
    ASSERT_EQ(bench.memory.arrivals.size(), 3U);
    EXPECT_TRUE(bench.memory.arrivals[1].request.write);
    EXPECT_FALSE(bench.memory.arrivals[2].request.write);
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_write), (Lines{0}));
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_read), (Lines{0, 2}));
}

TEST(RopFixedFunction, WriteBackSendsOneDirtyLinePerCycle) {
    ColourPass pass;
    for (const std::uint32_t tile : {3U, 1U, 4U, 2U}) pass.quad(tile * 4, 0);
    RopBench bench(pass);
    bench.run();
    bench.write_back();
    const Cycles cycles = bench.request_cycles(MemoryClient::tile_write);
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_write), (Lines{6, 2, 8, 4}));
    EXPECT_EQ(cycles.back() - cycles.front(), 3U);
    bench.write_back();
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), 4U); // clean by now
}

TEST(RopFixedFunction, LineThatAQuadWaitsForIsNotReplaced) {
    DepthPass pass;
    for (const std::uint32_t tile : {0U, 1U}) pass.quad(tile * 4, 0);
    RopBench bench(pass, {.rop = {.depth_cache_bytes = 32}});
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

// Lines of two sectors: memory knows the right one. The bursts of 32 bytes are written as a whole, under a byte mask.
TEST(RopFixedFunction, PHY_P11_ClearedSectorIsNotFetchedAndItsFirstWriteBackWritesItWhole) {
    DepthPass pass;
    pass.context.depth.pixel_bytes = 8; // a sector is a line and a burst
    pass.quad(0, 0, 0b0001);
    pass.quad(4, 0, 0b0001);
    RopBench bench(pass);
    bench.depth_clear.set(pass.context.layout);
    bench.depth_clear.written(4);
    const std::uint64_t before = bench.depth_clear.left();
    bench.run();
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_read), (Lines{4})); // the one that is in memory
    EXPECT_EQ(bench.executed().first, hit);
    bench.write_back();
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_write), (Lines{0, 4}));
    EXPECT_FALSE(bench.depth_clear.cleared(0));
    EXPECT_EQ(bench.depth_clear.left(), before - 1);
}

TEST(RopFixedFunction, PHY_P11_ClearedSectorThatIsOnlyTestedStaysCleared) {
    DepthPass pass;
    pass.quad(0, 0, 15, 1.0F); // fails against the cleared depth
    RopBench bench(pass);
    bench.depth_clear.set(pass.context.layout);
    bench.run();
    bench.write_back();
    EXPECT_TRUE(bench.memory.arrivals.empty());
    EXPECT_TRUE(bench.depth_clear.cleared(0));
}

// Half of the line's two sectors was written before, so its burst comes from memory.
TEST(RopFixedFunction, PHY_P11_LineOfWhichOneSectorIsClearedIsFetched) {
    DepthPass pass;
    pass.quad(2, 0);
    RopBench bench(pass);
    bench.depth_clear.set(pass.context.layout);
    bench.depth_clear.written(0);
    bench.run();
    EXPECT_EQ(bench.executed().first, miss);
    EXPECT_EQ(bench.memory.arrivals[0].request.bytes, 32U);
}

// A line is two sectors, as that many of the smaller target fill a burst: tile 1 begins with line 2.
TEST(RopFixedFunction, EachTargetIsWrittenWhereItsSurfaceLies) {
    ColourPass pass;
    pass.context.colours = {{4096, 4}, {65536, 16}};
    pass.quad(4, 0);
    RopBench bench(pass);
    bench.run();
    bench.write_back();
    std::vector<std::pair<std::uint64_t, std::uint32_t>> written;
    for (const auto& [request, cycle] : bench.memory.arrivals)
        if (request.write) written.emplace_back(request.address, request.bytes);
    EXPECT_EQ(written,
              (std::vector<std::pair<std::uint64_t, std::uint32_t>>{{4096 + 16 * 4, 32}, {65536 + 16 * 16, 64}}));
}

TEST(RopFixedFunction, CacheThatCannotHoldAQuadIsRefused) {
    DepthPass pass;
    pass.context.depth.pixel_bytes = 32; // a sector of 128 bytes
    try {
        const RopBench bench(pass, {.rop = {.depth_cache_bytes = 127}});
        ADD_FAILURE() << "accepted";
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(),
                     "rop.depth_cache_bytes: expected at least 128 bytes, 128 for the quad that each of 1 "
                     "groups of four ROPs works on, got 127");
    }
}

TEST(RopFixedFunction, PHY_S3_RopsComeInGroupsOfFour) {
    EXPECT_EQ(pipeline::RopParams{.units = 12}.groups(), 3U);
    for (const auto& [units, nearest] : {std::pair{5U, "4"}, {6U, "8"}, {15U, "16"}}) {
        try {
            const std::uint32_t groups = pipeline::RopParams{.units = units}.groups();
            ADD_FAILURE() << groups;
        } catch (const sim::InputError& error) {
            EXPECT_TRUE(std::string(error.what()).ends_with(std::string("the nearest is ") + nearest)) << error.what();
        }
    }
}

TEST(RopFixedFunction, ClearAndCopyMoveTheirBytes) {
    const DepthPass pass;
    RopBench bench(pass);
    bench.rop.stream({.write_bytes = 1000});
    bench.run();
    EXPECT_EQ(bench.memory.arrivals.size(), 4U); // 256 bytes each, and the rest
    bench.rop.stream({.read_bytes = 512, .write_bytes = 512, .write_address = 4096});
    bench.run();
    std::uint64_t read = 0, written = 0;
    for (const auto& [request, cycle] : bench.memory.arrivals) (request.write ? written : read) += request.bytes;
    EXPECT_EQ(read, 512U);
    EXPECT_EQ(written, 1512U);
    EXPECT_EQ(bench.rop.stats().clears, 1000U);
    EXPECT_EQ(bench.rop.stats().copies, 1024U);
    bench.rop.stream({.write_bytes = 300, .resolve = true});
    bench.run();
    EXPECT_EQ(bench.rop.stats().clears, 1000U);
    EXPECT_EQ(bench.rop.stats().resolves, 300U);
}

TEST(RopFixedFunction, ActivitiesSumToTheElapsedTimeAndModesAgree) {
    DepthPass pass;
    for (std::uint32_t i = 0; i < 300; ++i)
        pass.quad(i * 6 % 32, i * 10 % 32, static_cast<std::uint8_t>(i % 15 + 1), 1.0F / static_cast<float>(i + 2));
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        RopBench bench(
            pass,
            {.rop = {.bytes_per_clk = 4, .depth_cache_bytes = 128, .queue = 4}, .mode = mode, .shuffle = shuffle});
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

} // namespace output_rop_fixed_function_test
