// A fragment pipe without k-buffer: latency, issue rate, quads in flight, texture reads, the peel test.
#include "pipeline/functional/surface_texel.hpp"
#include "tests/support/pipe_kit.hpp"

#include <memory>
#include <numeric>
#include <vector>

namespace fragment_pipeline_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::SurfaceFormat;
using tests::PipeBench;
using tests::PipeOptions;

// Sent at cycle 0, received at 1, `latency` inside, one cycle to the sink.
TEST(FragmentPipeline, LatencyIsExact) {
    tests::QuadPass pass;
    pass.quad(0, 0);
    for (const std::uint32_t latency : {1U, 2U, 30U, 500U}) {
        PipeBench bench(pass, {.fragment = {.latency = latency}});
        bench.run();
        EXPECT_EQ(bench.sink.cycles(), (Cycles{1 + latency + 1}));
        EXPECT_EQ(bench.pipe.activity(), sim::Activity::starved);
    }
}

TEST(FragmentPipeline, OneInstructionQuadsFollowEachOtherEveryCycle) {
    tests::QuadPass pass;
    pass.quads(50);
    PipeBench bench(pass);
    bench.run();
    for (std::uint32_t i = 0; i < 50; ++i) EXPECT_EQ(bench.done(i), 32U + i);
    EXPECT_EQ(bench.pipe.stats().quads, 50U);
    EXPECT_EQ(bench.pipe.stats().fragments, 200U);
    EXPECT_EQ(bench.pipe.stats().issue_cycles, 50U);
}

TEST(FragmentPipeline, InstructionsSetTheIssueRateAndAddToTheLatency) {
    tests::QuadPass pass;
    pass.quads(5);
    pass.context.shader_costs[0].alu = 9;
    PipeBench bench(pass, {.fragment = {.alu_per_clk = 2, .latency = 30}}); // 5 cycles each
    bench.run();
    EXPECT_EQ(bench.sink.cycles(), (Cycles{36, 41, 46, 51, 56}));
    EXPECT_EQ(bench.pipe.stats().issue_cycles, 25U);
}

TEST(FragmentPipeline, CostIsThatOfTheDraw) {
    tests::QuadPass pass;
    for (const std::uint32_t draw : {0U, 1U, 0U}) {
        pass.triangle(draw);
        pass.quad(0, 0);
    }
    pass.context.shader_costs = {{2, 0, 1}, {20, 0, 1}};
    PipeBench bench(pass, {.fragment = {.alu_per_clk = 2, .latency = 30}});
    bench.run();
    EXPECT_EQ(bench.sink.cycles(), (Cycles{32, 42, 43})); // issue at 1, 2 and 12
}

TEST(FragmentPipeline, QuadsInFlightAreLimited) {
    tests::QuadPass pass;
    pass.quads(12);
    PipeBench bench(pass, {.fragment = {.quads_in_flight = 4, .latency = 100}});
    bench.run();
    EXPECT_EQ(bench.pipe.stats().in_flight_max, 4U);
    // A place is free in the cycle in which a result leaves.
    for (std::uint32_t i = 0; i < 12; ++i) EXPECT_EQ(bench.done(i), 102U + i / 4 * 100 + i % 4);
}

TEST(FragmentPipeline, RegistersLimitTheQuadsInFlight) {
    tests::QuadPass pass;
    pass.quads(20);
    const auto most = [&](std::uint32_t registers) {
        PipeBench bench(pass,
                        {.fragment = {.quads_in_flight = 8, .latency = 100, .registers = 32}, .registers = registers});
        bench.run();
        EXPECT_EQ(bench.sink.size(), 20U);
        return bench.pipe.stats().in_flight_max.value;
    };
    EXPECT_EQ(most(4), 8U);
    EXPECT_EQ(most(5), 6U);
    EXPECT_EQ(most(8), 4U);
    EXPECT_EQ(most(16), 2U);
    EXPECT_EQ(most(33), 1U); // one always fits
}

TEST(FragmentPipeline, StalledSinkBlocksItAndNothingIsLost) {
    tests::QuadPass pass;
    pass.quads(100);
    PipeBench bench(pass, {.fragment = {.quads_in_flight = 16}, .sink = {.start = 1000}});
    bench.run();
    EXPECT_EQ(bench.sink.size(), 100U);
    EXPECT_GT(bench.pipe.activity_times()[static_cast<std::size_t>(sim::Activity::blocked)], 900'000U);
}

// ---- textures

/// `count` quads whose fetches go to the lines that `line` gives.
template <class Line>
void textured(tests::QuadPass& pass, std::uint32_t count, Line&& line) {
    pass.quads(count);
    pass.context.textures = true;
    for (std::uint32_t i = 0; i < count; ++i) pass.stream.texture_lines.own().push_back(line(i));
}

// Received at 1, asked for in the same cycle, 200 cycles inside the memory, a cycle on each link; then filtered and
// shaded.
TEST(FragmentPipeline, TextureMissTakesTheWayToMemory) {
    tests::QuadPass pass;
    textured(pass, 1, [](std::uint32_t) { return 7U; });
    PipeBench bench(pass, {.fragment = {.latency = 30}, .texture = {.hit_latency = 40}, .texture_latency = 200});
    bench.run();
    EXPECT_EQ(bench.sink.cycles(), (Cycles{1 + 1 + 200 + 1 + 40 + 30 + 1}));
    ASSERT_EQ(bench.textures.requests().size(), 1U);
    EXPECT_EQ(bench.textures.requests()[0].address, 7U * 64);
    EXPECT_EQ(bench.textures.requests()[0].bytes, 64U);
    EXPECT_EQ(bench.pipe.stats().l1.texture_misses, 1U);
}

TEST(FragmentPipeline, TextureHitTakesTheHitLatency) {
    tests::QuadPass pass;
    textured(pass, 2, [](std::uint32_t) { return 7U; });
    PipeBench bench(pass, {.texture = {.hit_latency = 40}, .source = {.gap = 1000}});
    bench.run();
    // Looked up at 1001; the texture unit is taken for one cycle.
    EXPECT_EQ(bench.done(1), 1001U + 1 + 40 + 30 + 1);
    EXPECT_EQ(bench.pipe.stats().l1.texture_hits, 1U);
    EXPECT_EQ(bench.textures.requests().size(), 1U);
}

TEST(FragmentPipeline, FetchesOfAPendingLineJoinIt) {
    tests::QuadPass pass;
    textured(pass, 8, [](std::uint32_t) { return 7U; });
    PipeBench bench(pass);
    bench.run();
    EXPECT_EQ(bench.textures.requests().size(), 1U);
    EXPECT_EQ(bench.pipe.stats().l1.texture_misses, 1U);
    EXPECT_EQ(bench.pipe.stats().l1.texture_hits, 7U);
    Cycles cycles = bench.sink.cycles();
    for (std::uint32_t i = 1; i < 8; ++i) EXPECT_EQ(cycles[i], cycles[i - 1] + 1); // results leave one a cycle
}

TEST(FragmentPipeline, HitsAndMissesAreTheAccesses) {
    tests::QuadPass pass;
    textured(pass, 400, [](std::uint32_t i) { return i * 7 % 100; });
    for (const std::uint32_t bytes : {0U, 64U, 1024U, 65536U}) {
        PipeBench bench(pass, {.texture = {.l1_bytes = bytes}});
        bench.run();
        const auto& l1 = bench.pipe.stats().l1;
        EXPECT_EQ(l1.texture_hits + l1.texture_misses, 400U) << bytes;
        EXPECT_EQ(bench.textures.requests().size(), l1.texture_misses.value) << bytes;
        EXPECT_EQ(bench.sink.size(), 400U) << bytes;
        EXPECT_GE(l1.texture_misses, 100U) << bytes;
        EXPECT_EQ(l1.texture_misses == 400U, bytes == 0) << bytes;
        EXPECT_EQ(l1.texture_misses == 100U, bytes == 65536) << bytes;
    }
}

TEST(FragmentPipeline, QuadsWithoutAFetchDoNotWaitForTheTextureUnit) {
    tests::QuadPass pass;
    textured(pass, 2, [](std::uint32_t i) { return i == 0 ? 7U : ~0U; });
    PipeBench bench(pass, {.texture = {.cycles_per_fetch = 8}});
    bench.run();
    EXPECT_EQ(bench.done(1), 2U + 30 + 1);
    EXPECT_GT(bench.done(0), 200U);
}

// Many waiters of one line come back at once and reserve the texture unit for their next fetch far ahead; a quad that
// is past its ALUs must not wait for that.
TEST(FragmentPipeline, ReservedTextureUnitDelaysOnlyWhoReads) {
    tests::QuadPass pass;
    pipeline::PeeledLayer layer;
    layer.depth.assign(std::size_t{64} * 64, 0);
    layer.order.assign(layer.depth.size(), 0);
    pass.context.behind = &layer;
    textured(pass, 120, [](std::uint32_t i) { return i < 60 ? 7U : i < 61 ? ~0U : 9U; });
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        PipeBench bench(pass, {.fragment = {.latency = 2},
                               .texture = {.hit_latency = 1, .cycles_per_fetch = 8},
                               .mode = mode,
                               .shuffle = shuffle});
        bench.run();
        return std::tuple(bench.sink.cycles(), bench.pipe.activity_times());
    });
}

TEST(FragmentPipeline, BlockedMemoryLosesNothing) {
    tests::QuadPass pass;
    textured(pass, 200, [](std::uint32_t i) { return i * 64; }); // all miss, all in one set
    PipeBench bench(pass, {.fragment = {.quads_in_flight = 64}, .texture = {.l1_bytes = 256}, .texture_latency = 1});
    bench.run();
    EXPECT_EQ(bench.sink.size(), 200U);
    EXPECT_EQ(bench.textures.requests().size(), 200U);
}

// ---- peel test

/// A layer with one depth everywhere, written by one quad.
pipeline::PeeledLayer layer_at(float depth, SurfaceFormat format, pipeline::QuadId quad) {
    return {std::vector(std::size_t{64} * 64, pipeline::depth_code(format, depth)),
            std::vector<std::uint32_t>(std::size_t{64} * 64, quad)};
}

std::vector<std::uint32_t> masks(const PipeBench& bench) {
    std::vector<std::uint32_t> masks;
    for (const pipeline::Completion& completion : bench.sink.values()) masks.push_back(completion.mask);
    return masks;
}

TEST(FragmentPipeline, ExactPeelTakesWhatIsBehindTheLayerAndTiesByOrder) {
    tests::QuadPass pass;
    pass.context.peel.rule = pipeline::PeelRule::exact;
    pass.context.depth_format = SurfaceFormat::d32f;
    const pipeline::PeeledLayer layer = layer_at(0.5F, SurfaceFormat::d32f, 1);
    pass.context.behind = &layer;
    pass.quad(0, 0, 15, 0.25F);
    pass.quad(0, 0, 15, 0.5F); // the one that was captured
    pass.quad(0, 0, 15, 0.5F); // came after it
    pass.quad(0, 0, 15, 0.75F);
    pass.quad(0, 0, 15);
    pass.stream.depths.own()[4] = {0.4F, 0.6F, 0.5F, 0.1F};
    PipeBench bench(pass);
    bench.run();
    EXPECT_EQ(masks(bench), (std::vector<std::uint32_t>{0, 0, 15, 15, 0b0110}));
    EXPECT_EQ(bench.pipe.stats().peel_rejects, 4U + 4 + 2);
    EXPECT_EQ(bench.pipe.stats().fragments, 20U);
}

TEST(FragmentPipeline, EpsPeelTakesWhatIsFartherByEps) {
    tests::QuadPass pass;
    pass.context.peel = {pipeline::PeelRule::eps, 0.125, SurfaceFormat::d32f};
    pass.context.depth_format = SurfaceFormat::d32f;
    const pipeline::PeeledLayer layer = layer_at(0.5F, SurfaceFormat::d32f, 0);
    pass.context.behind = &layer;
    for (const float depth : {0.5F, std::nextafter(0.625F, 0.0F), 0.625F}) pass.quad(0, 0, 15, depth);
    PipeBench bench(pass);
    bench.run();
    EXPECT_EQ(masks(bench), (std::vector<std::uint32_t>{0, 0, 15}));
}

TEST(FragmentPipeline, PeeledLayerIsReadThroughTheTextureCache) {
    tests::QuadPass pass;
    const pipeline::PeeledLayer layer = layer_at(0.0F, SurfaceFormat::d24, 0);
    pass.context.behind = &layer;
    pass.quads(8); // four tiles of 4x4 pixels, two quads of each in a row
    PipeBench bench(pass);
    bench.run();
    EXPECT_EQ(bench.textures.requests().size(), 4U);
    EXPECT_EQ(bench.pipe.stats().l1.texture_hits, 4U);
}

// Depths of both ends take 8 bytes: of a tile's four quads two share a line.
TEST(FragmentPipeline, PeeledLayerIsReadWhereItWasCopied) {
    tests::QuadPass pass;
    const pipeline::PeeledLayer layer = layer_at(0.0F, SurfaceFormat::d24, 0);
    pass.context.behind = &layer;
    pass.context.behind_address = 4096;
    pass.context.depth.pixel_bytes = 8;
    for (const std::uint32_t y : {0U, 2U})
        for (const std::uint32_t x : {0U, 2U, 4U}) pass.quad(x, y);
    PipeBench bench(pass);
    bench.run();
    std::vector<std::uint64_t> addresses;
    for (const pipeline::MemoryRequest& request : bench.textures.requests()) addresses.push_back(request.address);
    EXPECT_EQ(addresses, (std::vector<std::uint64_t>{4096, 4096 + 128, 4096 + 64, 4096 + 192}));
}

// ---- full-screen passes

/// Every quad makes the same steps of the same loads and stores.
class StepShader final : public pipeline::ScreenShader {
  public:
    StepShader(std::uint32_t steps, std::uint32_t loads, std::uint32_t stores)
        : steps_(steps), loads_(loads), stores_(stores) {}
    std::uint32_t alu(std::uint32_t, std::uint32_t) const override { return 1; }
    std::uint32_t fetches(std::uint32_t, std::uint32_t) const override { return 0; }
    std::uint64_t line(std::uint32_t, std::uint32_t, std::uint32_t) const override { return 0; }
    std::uint32_t steps(std::uint32_t, std::uint32_t) const override { return steps_; }
    void step(std::uint32_t, std::uint32_t, std::uint32_t number,
              std::vector<pipeline::MemorySegment>& segments) const override {
        for (std::uint32_t i = 0; i < loads_; ++i) segments.push_back({(number * 16ULL + i) * 64, 32, false});
        for (std::uint32_t i = 0; i < stores_; ++i) segments.push_back({(number * 16ULL + 8 + i) * 64, 64, true});
    }

  private:
    std::uint32_t steps_, loads_, stores_;
};

sim::Cycle done_with_steps(std::uint32_t steps, std::uint32_t loads, std::uint32_t stores) {
    tests::QuadPass pass;
    pass.quad(0, 0);
    pipeline::ScreenPass screen;
    screen.shader = std::make_shared<StepShader>(steps, loads, stores);
    pass.context.screen = &screen;
    PipeBench bench(pass, {.texture_latency = 200});
    bench.run();
    EXPECT_EQ(bench.pipe.stats().uncached_loads, std::uint64_t{steps} * loads);
    EXPECT_EQ(bench.pipe.stats().uncached_stores, std::uint64_t{steps} * stores);
    EXPECT_EQ(bench.pipe.stats().l1.texture_misses, 0U);
    return bench.done(0);
}

TEST(FragmentPipeline, PHY_P6_StepsWaitForTheirLoadsAndNotForTheirStores) {
    const sim::Cycle none = done_with_steps(0, 1, 0), one = done_with_steps(1, 1, 0);
    EXPECT_GT(one, none + 200);
    EXPECT_LT(one, none + 210);
    for (const std::uint32_t steps : {2U, 10U}) EXPECT_EQ(done_with_steps(steps, 1, 0) - none, steps * (one - none));
    // Loads of one step travel together: one request a cycle leaves.
    EXPECT_EQ(done_with_steps(1, 3, 0), one + 2);
    EXPECT_EQ(done_with_steps(5, 3, 0) - none, 5 * (one + 2 - none));
    EXPECT_EQ(done_with_steps(1, 1, 4), one);
    EXPECT_LE(done_with_steps(4, 0, 1), none + 4 * 4); // texture unit time only
}

TEST(FragmentPipeline, SameInAllModes) {
    tests::QuadPass pass;
    textured(pass, 300, [](std::uint32_t i) { return i * i % 37; });
    for (std::uint32_t i = 0; i < 300; i += 11) pass.stream.texture_lines.own()[i] = ~0U;
    pass.context.shader_costs[0].alu = 3;
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        PipeBench bench(pass, {.fragment = {.quads_in_flight = 32},
                               .texture = {.l1_bytes = 512},
                               .texture_latency = 50,
                               .sink = {.every = 3},
                               .mode = mode,
                               .shuffle = shuffle});
        bench.run();
        std::vector<std::uint32_t> order;
        for (const pipeline::Completion& completion : bench.sink.values()) order.push_back(completion.sequence);
        return std::tuple(bench.sink.cycles(), order, bench.pipe.stats().l1.texture_hits.value,
                          bench.pipe.activity_times());
    });
}

} // namespace fragment_pipeline_test
