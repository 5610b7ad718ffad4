// A fragment pipe in a pass that brings a shader: instructions, reads of surfaces, what its cache keeps of them.
#include "tests/support/pipe_kit.hpp"

#include <memory>
#include <vector>

namespace fragment_pipeline_shader_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::SurfaceFormat;
using tests::PipeBench;

/// One read of surface 0 that touches `tiles` of its tiles.
class ReadingShader final : public pipeline::Shader {
  public:
    ReadingShader(std::uint32_t instructions, std::uint32_t tiles) : instructions_(instructions), tiles_(tiles) {}
    pipeline::ShaderShape shape() const override { return {.reads = 1}; }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput&) const override {
        surfaces.issue(instructions_, input.pixels);
        pipeline::LaneIndices x{};
        for (std::int32_t i = 0; i < 4; ++i) x[static_cast<std::size_t>(i)] = i % static_cast<std::int32_t>(tiles_) * 4;
        surfaces.fetch(0, x, {0, 0, 0, 0}, input.pixels);
    }

  private:
    std::uint32_t instructions_, tiles_;
};

/// A pass of `quads` quads with such a shader on a surface of that format.
struct ReadingPass : tests::QuadPass {
    pipeline::SurfaceStore surfaces;
    pipeline::Pass pass;

    ReadingPass(std::uint32_t count, std::uint32_t instructions, std::uint32_t tiles, SurfaceFormat format)
        : surfaces(std::vector{pipeline::SurfaceInfo{.name = "read", .format = format, .width = 64, .height = 64}}) {
        quads(count);
        pass.shader = std::make_shared<ReadingShader>(instructions, tiles);
        pass.reads = {0};
        context.pass = &pass;
        context.surfaces = &surfaces;
    }
};

// As a miss of a texture; the shader's own instructions come on top of the draw's one.
TEST(FragmentPipelineShader, AShaderOfThePassIsRunForItsInstructionsAndFetches) {
    ReadingPass pass(1, 8, 1, SurfaceFormat::rgba8);
    PipeBench bench(
        pass, {.fragment = {.alu_per_clk = 1, .latency = 30}, .texture = {.hit_latency = 40}, .texture_latency = 200});
    bench.run();
    EXPECT_EQ(bench.sink.cycles(), (Cycles{1 + 1 + 200 + 1 + 40 + 30 + 8 + 1}));
    EXPECT_EQ(bench.pipe.stats().issue_cycles, 9U);
    EXPECT_EQ(bench.textures.requests().size(), 1U);
}

TEST(FragmentPipelineShader, FetchesTakeTheTimeOfTheirTexelsAndACycleForEachFurtherLine) {
    const auto cycles = [](std::uint32_t tiles, SurfaceFormat format) {
        ReadingPass pass(1, 0, tiles, format);
        PipeBench bench(pass, {.texture = {.cycles_per_fetch = 2, .cycles_per_rgba32f = 8}});
        bench.run();
        EXPECT_EQ(bench.textures.requests().size(), tiles);
        return bench.pipe.stats().texture_cycles.value;
    };
    EXPECT_EQ(cycles(1, SurfaceFormat::rgba8), 2U);
    EXPECT_EQ(cycles(4, SurfaceFormat::rgba8), 5U);
    EXPECT_EQ(cycles(1, SurfaceFormat::rgba16f), 4U); // a third of the way from 4 to 16 bytes
    EXPECT_EQ(cycles(1, SurfaceFormat::rgba32f), 8U);
    EXPECT_EQ(cycles(2, SurfaceFormat::rgba32f), 9U);
}

TEST(TextureCache, LinesOfASurfaceThatWasRewrittenAreReadAnew) {
    pipeline::TextureCache cache({}, 0);
    for (const std::uint64_t line : {4U, 5U, 6U}) cache.filled(cache.reserve_texture(line));
    cache.drop_texture_lines(5, 6);
    EXPECT_NE(cache.find_texture(4), pipeline::TextureCache::none);
    EXPECT_EQ(cache.find_texture(5), pipeline::TextureCache::none);
    EXPECT_NE(cache.find_texture(6), pipeline::TextureCache::none);
}

} // namespace fragment_pipeline_shader_test
