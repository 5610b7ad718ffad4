// The early depth test between a source and a sink of quads.
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/raster/early_depth_test.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

namespace raster_early_depth_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::QuadTask;

struct Bench {
    tests::Rig rig;
    pipeline::EarlyDepthTest unit;
    tests::Source<QuadTask> source;
    tests::Sink<QuadTask> sink;

    Bench(const tests::QuadPass& pass, const pipeline::EarlyDepthParams& params, tests::SinkOptions sink_options = {})
        : unit(rig.context("early_depth"), params, pass.context),
          source(rig.context("source"), pass.quad_tasks()),
          sink(rig.context("sink"), std::move(sink_options)) {
        sim::connect(source.out, unit.quads_in, {1, 64, 128});
        sim::connect(unit.quads_out, sink.in, {params.latency, params.quads_per_clk, 2 * params.quads_per_clk});
        rig.simulation.run();
    }
};

/// Tested against a depth surface of 0.5 everywhere.
struct TestedPass : tests::QuadPass {
    static constexpr pipeline::SurfaceFormat format = pipeline::SurfaceFormat::d24;
    pipeline::SurfaceStore surfaces;

    explicit TestedPass(pipeline::Compare compare = pipeline::Compare::less) : surfaces(surfaces_of(*this)) {
        pipeline::RasterState state;
        state.depth.test = true;
        state.depth.compare = compare;
        context.read_only_states = pipeline::DrawStates(state);
        context.surfaces = &surfaces;
        context.read_only_depth = 0;
    }

  private:
    static pipeline::SurfaceStore surfaces_of(const tests::QuadPass& pass) {
        pipeline::SurfaceInfo depth{
            .name = "depth", .format = format, .width = pass.stream.width, .height = pass.stream.height};
        pack_depth_stencil(format, {pipeline::depth_code(format, 0.5F), 0}, depth.cleared.data());
        return pipeline::SurfaceStore(std::vector{depth});
    }
};

TEST(EarlyDepthTest, PassesEverythingWithoutADepthSurface) {
    tests::QuadPass pass;
    pass.quads(8);
    const Bench bench(pass, {.quads_per_clk = 4, .latency = 8});
    EXPECT_EQ(tests::quads_of(bench.sink.values()), tests::counting(8));
    EXPECT_EQ(bench.unit.stats().fragments_rejected, 0U);
}

// Received at cycle 1; the latency is that of the link behind it.
TEST(EarlyDepthTest, LatencyAndRateAreExact) {
    tests::QuadPass pass;
    pass.quads(8);
    const Bench bench(pass, {.quads_per_clk = 4, .latency = 8});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{9, 9, 9, 9, 10, 10, 10, 10}));
}

TEST(EarlyDepthTest, RejectsWhatIsNotNearerThanTheSurface) {
    TestedPass pass;
    pass.quad(0, 0, 15, 0.25F);
    pass.quad(2, 0, 15, 0.5F); // equal depth is not less
    pass.quad(4, 0, 15, 0.75F);
    pass.quad(6, 0, 15);
    pass.stream.depths.own()[3] = {0.25F, 0.75F, 0.5F, 0.4F};
    const Bench bench(pass, {});
    ASSERT_EQ(bench.sink.size(), 2U);
    EXPECT_EQ(bench.sink.values()[0].mask, 15);
    EXPECT_EQ(bench.sink.values()[1].mask, 0b1001);
    EXPECT_EQ(bench.unit.stats().quads, 4U);
    EXPECT_EQ(bench.unit.stats().quads_rejected, 2U);
    EXPECT_EQ(bench.unit.stats().fragments, 16U);
    EXPECT_EQ(bench.unit.stats().fragments_rejected, 10U);
}

TEST(EarlyDepthTest, ComparesAsTheDrawSays) {
    for (const pipeline::Compare compare : {pipeline::Compare::greater_equal, pipeline::Compare::not_equal}) {
        TestedPass pass(compare);
        pass.quad(0, 0, 15);
        pass.stream.depths.own()[0] = {0.25F, 0.75F, 0.5F, 0.4F};
        const Bench bench(pass, {});
        EXPECT_EQ(bench.sink.values().at(0).mask, compare == pipeline::Compare::not_equal ? 0b1011U : 0b0110U);
    }
}

TEST(EarlyDepthTest, LooksAtEachPixelsOwnDepth) {
    TestedPass pass;
    pack_depth_stencil(pass.format, {pipeline::depth_code(pass.format, 0.1F), 0}, pass.surfaces.written(0, {5, 3, 0}));
    pass.quad(4, 2, 15, 0.25F);
    const Bench bench(pass, {});
    EXPECT_EQ(bench.sink.values().at(0).mask, 0b0111); // pixel 3 of the quad is (5, 3)
}

TEST(EarlyDepthTest, StalledSinkBlocksItAndNothingIsLost) {
    tests::QuadPass pass;
    pass.quads(100);
    const Bench bench(pass, {.quads_per_clk = 2, .latency = 1}, {.start = 500});
    EXPECT_EQ(tests::quads_of(bench.sink.values()), tests::counting(100));
    EXPECT_GT(bench.unit.activity_times()[static_cast<std::size_t>(sim::Activity::blocked)], 450'000U);
}

TEST(EarlyDepthTest, RejectedQuadsTakeTheirTurnToo) {
    TestedPass pass;
    for (std::uint32_t i = 0; i < 12; ++i) pass.quad(i * 2, 0, 15, i == 11 ? 0.1F : 0.9F);
    const Bench bench(pass, {.quads_per_clk = 4, .latency = 1});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{4})); // the third group of four leaves at cycle 3
}

} // namespace raster_early_depth_test
