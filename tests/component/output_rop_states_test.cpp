// A ROP group whose draws have raster states of their own: what masks, blending and stencil read, write and cost.
#include "tests/support/rop_kit.hpp"

#include <limits>

namespace output_rop_states_test {

using Cycles = std::vector<sim::Cycle>;
using Lines = std::vector<std::uint64_t>;
using pipeline::MemoryClient;
using pipeline::RasterState;
using pipeline::StencilOperation;
using tests::RopBench;

constexpr sim::Cycle hit = 2, miss = 103;

/// One state per draw, of a pass that writes RGBA8 and D24S8.
struct StatePass : tests::QuadPass {
    explicit StatePass(std::vector<RasterState> states) {
        pipeline::Pass pass;
        for (std::uint32_t draw = 0; draw < states.size(); ++draw) {
            pass.draws.push_back(draw);
            pass.state_of_draw.push_back(draw);
        }
        pass.states = std::move(states);
        context.states = pipeline::DrawStates(pass, pass.draws.size());
        write_colours();
        context.depth_format = pipeline::SurfaceFormat::d24s8;
    }
    void quad_of(std::uint32_t draw, const glm::vec4& colour, bool front = true, float depth = 0.5F) {
        triangle(draw);
        stream.triangles.own().back().front = front;
        quad(0, 0, 15, depth);
        stream.colours.back().fill(colour);
    }
};

struct Bench : RopBench {
    explicit Bench(const StatePass& pass, const tests::RopOptions& options = {}) : RopBench(pass, options) { run(); }
};

RasterState masked(std::uint8_t mask) {
    RasterState state;
    state.write_mask[0] = mask;
    return state;
}

RasterState blending() {
    RasterState state;
    state.blend[0] = pipeline::blends::of(pipeline::blends::sum);
    return state;
}

TEST(RopStates, WritesThatAreMaskedCostNothing) {
    StatePass pass({masked(0)});
    for (int i = 0; i < 3; ++i) pass.quad_of(0, glm::vec4(1.0F));
    Bench bench(pass);
    EXPECT_EQ(bench.executed(), (std::pair<sim::Cycle, sim::Cycle>{hit, hit + 2}));
    bench.write_back();
    EXPECT_TRUE(bench.memory.arrivals.empty());
    EXPECT_EQ(bench.colour(), glm::vec4(0.0F));
}

TEST(RopStates, AMaskOfSomeChannelsNeedsTheStoredPixel) {
    StatePass pass({masked(0b0101)});
    pass.quad_of(0, glm::vec4(1.0F));
    Bench bench(pass);
    EXPECT_EQ(bench.executed().first, miss);
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_read), (Lines{0}));
    EXPECT_EQ(bench.colour(), glm::vec4(1.0F, 0.0F, 1.0F, 0.0F));
}

TEST(RopStates, ALineOfStoresAloneIsFetchedWhenADrawBlendsWithIt) {
    StatePass pass({RasterState{}, blending()});
    pass.quad_of(0, glm::vec4(0.2F));
    pass.quad_of(0, glm::vec4(0.4F));
    pass.quad_of(1, glm::vec4(0.2F));
    pass.quad_of(1, glm::vec4(0.2F));
    Bench bench(pass, {.source = {.gap = 10}});
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_read), (Cycles{2 * 10 + 2})); // admitted at 21, and once only
    EXPECT_EQ(bench.executed(0).second, 10 + hit);
    EXPECT_EQ(bench.executed(1).first, 2 * 10 + miss);
    EXPECT_EQ(bench.colour(), glm::vec4(204.0F / 255.0F));
    EXPECT_EQ(bench.rop.stats().colour_tiles.misses, 1U);
}

TEST(RopStates, StencilIsTestedOnTheFaceThatShows) {
    RasterState state = masked(0);
    state.stencil.test = true;
    state.stencil.front.passes = StencilOperation::increment;
    state.stencil.back.compare = pipeline::Compare::equal;
    state.stencil.back.reference = 7;
    state.stencil.back.stencil_fails = StencilOperation::invert;
    state.stencil.back.write_mask = 0xF0;
    RasterState reversed = state;
    reversed.front_is_clockwise = true;
    StatePass pass({state, reversed});
    pass.quad_of(0, glm::vec4(1.0F), true);
    pass.quad_of(0, glm::vec4(1.0F), false);
    pass.quad_of(1, glm::vec4(1.0F), true);
    Bench bench(pass);
    EXPECT_EQ(bench.depth().stencil, 0x01); // + 1, inverted in the upper half twice
    EXPECT_EQ(bench.rop.stats().stencil_failed, 8U);
    EXPECT_EQ(bench.rop.stats().depth_passed, 4U);
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_read), (Lines{0})); // depth and stencil share the texel
    bench.write_back();
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_write), (Lines{0}));
}

TEST(RopStates, AStencilTestThatStoresNothingWritesNothingBack) {
    RasterState state = masked(0);
    state.stencil.test = true;
    state.stencil.front.passes = StencilOperation::replace;
    state.stencil.front.write_mask = 0;
    StatePass pass({state});
    pass.quad_of(0, glm::vec4(1.0F));
    Bench bench(pass);
    bench.write_back();
    EXPECT_TRUE(bench.requested_lines(MemoryClient::tile_write).empty());
}

TEST(RopStates, DepthBesideAStencilIsAPartOfItsTexel) {
    RasterState state = masked(0);
    state.depth.write = true;
    for (const bool stencil : {false, true}) {
        StatePass pass({state});
        if (!stencil) pass.context.depth_format = pipeline::SurfaceFormat::d24;
        pass.quad_of(0, glm::vec4(1.0F));
        Bench bench(pass);
        EXPECT_EQ(bench.requested_lines(MemoryClient::tile_read).size(), stencil ? 1U : 0U);
        EXPECT_EQ(bench.depth().depth, pipeline::depth_code(pass.context.depth_format, 0.5F));
    }
}

// 65504 is the largest finite half; from 65520 on IEEE 754 rounds to infinity.
TEST(RopStates, HalvesOverflowAsTheGpuSays) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float below = 16.0F - 0x1p-8F; // the sum is the last float below 65520
    struct Expected {
        float added, saturated, infinite;
        std::uint64_t channels; ///< of one pixel
    };
    for (const auto& [added, saturated, infinite, channels] :
         {Expected{0.0F, 65504.0F, 65504.0F, 0}, Expected{below, 65504.0F, 65504.0F, 0},
          Expected{16.0F, 65504.0F, infinity, 4}, Expected{65504.0F, 65504.0F, infinity, 4}})
        for (const auto overflow : {pipeline::Fp16Overflow::saturate, pipeline::Fp16Overflow::infinity}) {
            SCOPED_TRACE(added);
            StatePass pass({RasterState{}, blending()});
            pass.write_colours(pipeline::SurfaceFormat::rgba16f);
            pass.quad_of(0, glm::vec4(65504.0F));
            pass.quad_of(1, glm::vec4(added));
            Bench bench(pass, {.rop = {.fp16_overflow = overflow}});
            const bool saturates = overflow == pipeline::Fp16Overflow::saturate;
            EXPECT_EQ(bench.colour(), glm::vec4(saturates ? saturated : infinite));
            EXPECT_EQ(bench.rop.stats().fp16_overflows, 4 * channels);
        }
}

} // namespace output_rop_states_test
