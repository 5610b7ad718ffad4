// The rasterizer between a source of triangles and a sink of quads.
#include "pipeline/raster/rasterizer.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

namespace raster_rasterizer_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::QuadTask;

struct Bench {
    tests::Rig rig;
    pipeline::Rasterizer rasterizer;
    tests::Source<pipeline::TriangleTask> source;
    tests::Sink<QuadTask> sink;

    Bench(const tests::QuadPass& pass, const pipeline::RasterizerParams& params, tests::SinkOptions sink_options = {},
          std::uint32_t width = 64, sim::Mode mode = sim::Mode::normal, std::uint64_t shuffle = 1)
        : rig(mode, 1, shuffle),
          rasterizer(rig.context("rasterizer"), params, pass.context),
          source(rig.context("source"), pass.triangle_tasks()),
          sink(rig.context("sink"), std::move(sink_options)) {
        sim::connect(source.out, rasterizer.triangles_in, {1, 8, 64});
        sim::connect(rasterizer.quads_out, sink.in, {1, width, 2 * width});
        rig.simulation.run();
    }
};

// A triangle sent at cycle 0 is received at 1; its first quads leave in the same cycle and arrive at 2.
TEST(Rasterizer, QuadsOfOneTileLeaveAtTheGivenRateAndArriveInOrder) {
    tests::QuadPass pass;
    pass.triangle();
    for (std::uint32_t i = 0; i < 16; ++i) pass.quad(i % 4 * 2, i / 4 * 2);
    const Bench bench(pass, {.quads_per_clk = 4, .tiles_per_clk = 1});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5}));
    EXPECT_EQ(tests::quads_of(bench.sink.values()), tests::counting(16));
    EXPECT_EQ(bench.rasterizer.stats().quads, 16U);
    EXPECT_EQ(bench.rasterizer.stats().fragments, 64U);
}

TEST(Rasterizer, QuadsOfOneCycleComeFromOneTileWhenOneTileIsVisited) {
    tests::QuadPass pass;
    pass.triangle();
    for (const std::uint32_t x : {0U, 8U, 16U}) pass.quad(x, 0);
    const Bench bench(pass, {.quads_per_clk = 4, .tiles_per_clk = 1});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{2, 3, 4}));
    EXPECT_EQ(bench.rasterizer.stats().tiles, 3U);
}

TEST(Rasterizer, RestOfATileIsNotANewVisit) {
    tests::QuadPass pass;
    pass.triangle();
    for (const std::uint32_t x : {0U, 2U, 4U, 6U}) pass.quad(x, 0);
    pass.quad(0, 2);
    pass.quad(8, 0); // the next tile
    const Bench bench(pass, {.quads_per_clk = 4, .tiles_per_clk = 1});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{2, 2, 2, 2, 3, 4}));
}

TEST(Rasterizer, EmptyTilesCostTheirVisit) {
    tests::QuadPass pass;
    pass.triangle(0, 5);
    pass.quad(0, 0);
    const Bench bench(pass, {.quads_per_clk = 4, .tiles_per_clk = 1});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{2 + 5}));
    EXPECT_EQ(bench.rasterizer.stats().tiles, 6U);
}

TEST(Rasterizer, TriangleWithoutQuadsCostsItsTiles) {
    tests::QuadPass pass;
    pass.triangle(0, 3);
    pass.triangle();
    pass.quad(0, 0);
    const Bench bench(pass, {.quads_per_clk = 4, .tiles_per_clk = 1});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{2 + 3}));
    EXPECT_EQ(bench.rasterizer.stats().triangles, 2U);
    EXPECT_EQ(bench.rasterizer.stats().triangles_without_quads, 1U);
}

TEST(Rasterizer, SmallTrianglesFollowEachOtherWithoutAGap) {
    tests::QuadPass pass;
    for (std::uint32_t i = 0; i < 6; ++i) {
        pass.triangle();
        pass.quad(0, 0);
    }
    const Bench one(pass, {.quads_per_clk = 4, .tiles_per_clk = 1});
    EXPECT_EQ(one.sink.cycles(), (Cycles{2, 3, 4, 5, 6, 7}));
    const Bench two(pass, {.quads_per_clk = 4, .tiles_per_clk = 2});
    EXPECT_EQ(two.sink.cycles(), (Cycles{2, 2, 3, 3, 4, 4}));
}

TEST(Rasterizer, MoreTilesPerCycleDoNotRaiseTheQuadRate) {
    tests::QuadPass pass;
    pass.triangle();
    for (const std::uint32_t x : {0U, 2U, 4U, 8U, 10U, 12U}) pass.quad(x, 0);
    const Bench bench(pass, {.quads_per_clk = 4, .tiles_per_clk = 4});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{2, 2, 2, 2, 3, 3}));
}

TEST(Rasterizer, StalledSinkBlocksItAndNothingIsLost) {
    tests::QuadPass pass;
    pass.triangle();
    pass.quads(64);
    const Bench bench(pass, {.quads_per_clk = 4, .tiles_per_clk = 1}, {.start = 1000}, 4);
    EXPECT_EQ(tests::quads_of(bench.sink.values()), tests::counting(64));
    EXPECT_GT(bench.rasterizer.activity_times()[static_cast<std::size_t>(sim::Activity::blocked)], 900'000U);
    EXPECT_EQ(bench.rasterizer.activity(), sim::Activity::starved);
}

TEST(Rasterizer, DiscardedPixelsAreNotAliveButCountAsCovered) {
    tests::QuadPass pass;
    pass.quad(0, 0, 15);
    pass.stream.quads.own()[0].alive = 5;
    const Bench bench(pass, {});
    EXPECT_EQ(bench.sink.values().at(0).mask, 5);
    EXPECT_EQ(bench.rasterizer.stats().fragments, 4U);
}

TEST(Rasterizer, SameInAllModes) {
    tests::QuadPass pass;
    for (std::uint32_t i = 0; i < 40; ++i) {
        pass.triangle(0, i % 3 == 0 ? 1 : 0);
        for (std::uint32_t n = 0; n < i % 7; ++n) pass.quad((i + n) % 32 * 2, 0);
        if (i % 7 == 0 && i % 3 != 0) pass.stream.triangles.own().back().tiles = 1;
    }
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        const Bench bench(pass, {.quads_per_clk = 3, .tiles_per_clk = 2}, {.every = 3}, 4, mode, shuffle);
        return std::tuple(bench.sink.cycles(), tests::quads_of(bench.sink.values()), bench.rasterizer.activity_times());
    });
}

} // namespace raster_rasterizer_test
