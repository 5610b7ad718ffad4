// The kernel of soft shadows as a shader: what the pixels of a quad fetch and issue together (specification 004, A20 to
// A25).
#include "pipeline/functional/surface_texel.hpp"
#include "traces/shadows/shadow_shaders.hpp"

#include <gtest/gtest.h>
#include <numeric>

namespace traces_shadow_shaders_test {

using pipeline::SurfaceFormat;
using pipeline::SurfaceInfo;

constexpr glm::vec3 background{0.25F, 0.5F, 0.75F};
constexpr glm::vec4 grey{0.5F, 0.5F, 0.5F, 1.0F}, black{0.0F, 0.0F, 0.0F, 1.0F}, nothing{0.0F};

/// l = n = w = 1; looks along -z from the origin.
traces::ShadowSetup setup_of(std::uint32_t resolution) {
    traces::ShadowSetup setup;
    setup.eye.width = setup.eye.height = 2;
    setup.light.width = setup.light.near = setup.light.near_width = 1.0;
    setup.light.far = 1000.0;
    setup.map = {.resolution = resolution, .captured = 2, .layers = 1, .format = traces::ShadowFormat::rgba32f};
    setup.background = background;
    return setup;
}

/// Four pixels, the surfaces that the kernel reads for them, and what it makes of them.
class QuadOfKernel {
  public:
    explicit QuadOfKernel(const traces::ShadowSetup& setup) : setup_(setup) {
        const traces::ShadowKernelReads reads(setup);
        std::vector<SurfaceInfo> infos(2,
                                       {.name = "pixels", .format = SurfaceFormat::rgba32f, .width = 2, .height = 2});
        const std::uint32_t r = setup.map.resolution;
        infos.resize(2 + reads.packs + reads.slopes,
                     {.name = "map", .format = SurfaceFormat::rgba32f, .width = r, .height = r});
        for (std::uint32_t level = 1; level <= reads.levels; ++level)
            infos.push_back(
                {.name = "level", .format = SurfaceFormat::rgba32f, .width = r >> level, .height = r >> level});
        EXPECT_EQ(infos.size(), reads.count());
        store_ = pipeline::SurfaceStore(infos);
        slots_.resize(infos.size());
        std::iota(slots_.begin(), slots_.end(), 0U);
        for (std::uint32_t slot = 2; slot < infos.size(); ++slot) fill(slot, glm::vec4(1e30F));
    }

    void set_pixel(std::uint32_t pixel, const glm::vec4& colour, const glm::vec3& place) {
        write(0, {pixel % 2, pixel / 2, 0}, colour);
        write(1, {pixel % 2, pixel / 2, 0}, glm::vec4(place, 1.0F));
    }
    void fill(std::uint32_t slot, const glm::vec4& value) {
        for (std::uint32_t y = 0; y < store_.info(slot).height; ++y)
            for (std::uint32_t x = 0; x < store_.info(slot).width; ++x) write(slot, {x, y, 0}, value);
    }

    void shade() {
        work.clear();
        pipeline::SurfaceAccess access(store_, slots_, &work);
        output = {};
        shadow_kernel_shader(setup_)->shade({}, access, output);
    }

    pipeline::QuadWork work;
    pipeline::ShaderOutput output;

  private:
    void write(std::uint32_t surface, pipeline::SurfacePlace place, const glm::vec4& value) {
        pack_colour(SurfaceFormat::rgba32f, value, store_.written(surface, place));
    }

    traces::ShadowSetup setup_;
    pipeline::SurfaceStore store_;
    std::vector<pipeline::SurfaceId> slots_;
};

TEST(ShadowKernelShaderA25, BackgroundAndBlackLeaveAfterOneFetch) {
    QuadOfKernel quad(setup_of(4));
    for (std::uint32_t i = 0; i < 4; ++i) quad.set_pixel(i, i < 2 ? nothing : black, {0, 0, -5});
    quad.shade();
    EXPECT_EQ(quad.work.fetches().size(), 1U);
    EXPECT_EQ(quad.work.instructions(), 2U);
    EXPECT_EQ(quad.output.colours[0][0], glm::vec4(background, 1.0F));
    EXPECT_EQ(quad.output.colours[0][3], glm::vec4(0, 0, 0, 1));
}

TEST(ShadowKernelShader, AQuadRunsAsLongAsItsLongestPixel) {
    traces::ShadowSetup setup = setup_of(64);
    setup.map.hierarchy = false;
    setup.kernel.iterations = 0;
    const traces::BackProjection formulas(setup.light, setup.map, setup.kernel);
    const auto samples_at = [&](float z) {
        traces::SearchRegion region = formulas.project({0, 0, z});
        formulas.spread_samples(region);
        return region.across * region.across;
    };
    const std::uint32_t few = samples_at(-1.05F), many = samples_at(-1.2F);
    ASSERT_LT(few, many);
    QuadOfKernel quad(setup);
    for (std::uint32_t i = 0; i < 4; ++i) quad.set_pixel(i, grey, {0, 0, i == 2 ? -1.2F : -1.05F});
    quad.shade();
    EXPECT_EQ(quad.work.fetches().size(), 2 + many);
    EXPECT_EQ(quad.work.instructions(), 14 + 6 + many * (4 + 11));
    EXPECT_EQ(quad.output.colours[0][2], grey); // the map is empty
    quad.set_pixel(2, black, {0, 0, -1.2F});
    quad.shade();
    EXPECT_EQ(quad.work.fetches().size(), 2 + few);
    EXPECT_EQ(quad.work.instructions(), 14 + 6 + few * (4 + 11));
}

// Pixels that search on the same level share four fetches; each level more takes four more.
TEST(ShadowKernelShaderA21, EachLevelOfTheQuadIsFetchedOnce) {
    traces::ShadowSetup setup = setup_of(64);
    setup.kernel.iterations = 1;
    const traces::BackProjection formulas(setup.light, setup.map, setup.kernel);
    const float near = -1.05F, far = -40.0F;
    ASSERT_NE(formulas.level(formulas.project({0, 0, near})), formulas.level(formulas.project({0, 0, far})));
    QuadOfKernel quad(setup);
    for (std::uint32_t i = 0; i < 4; ++i) quad.set_pixel(i, grey, {0, 0, near});
    quad.shade();
    EXPECT_EQ(quad.work.fetches().size(), 2U + 4U);
    EXPECT_EQ(quad.work.instructions(), 14U + 9U); // nothing is nearer to the light: no region, no sample
    quad.set_pixel(3, grey, {0, 0, far});
    quad.shade();
    EXPECT_EQ(quad.work.fetches().size(), 2U + 2 * 4U);
    EXPECT_EQ(quad.work.instructions(), 14U + 9U);
}

TEST(ShadowKernelShader, ReadsOnlyTheLayersThatItLooksAt) {
    traces::ShadowSetup setup = setup_of(16);
    setup.map.captured = 16;
    const auto packs = [&](std::uint32_t layers, traces::ShadowBias bias) {
        setup.map.layers = layers;
        setup.map.bias = bias;
        return traces::ShadowKernelReads(setup).packs;
    };
    EXPECT_EQ(packs(4, traces::ShadowBias::uniform), 1U);
    EXPECT_EQ(packs(4, traces::ShadowBias::midpoint), 2U); // half way to the fifth
    EXPECT_EQ(packs(16, traces::ShadowBias::midpoint), 4U);
    setup.kernel.method = traces::ShadowMethod::pcf;
    EXPECT_EQ(packs(16, traces::ShadowBias::midpoint), 1U);
}

// One texel of neighbours each way, asked for by pixels that have an occluder there.
TEST(ShadowKernelShader, GapsAreFilledWhereSomethingOccludes) {
    traces::ShadowSetup setup = setup_of(16);
    setup.kernel.iterations = 0;
    setup.kernel.most_samples = 1;
    setup.map.hierarchy = false;
    QuadOfKernel plain(setup);
    setup.kernel.gap_filling = true;
    QuadOfKernel filled(setup);
    for (QuadOfKernel* quad : {&plain, &filled}) {
        for (std::uint32_t i = 0; i < 4; ++i) quad->set_pixel(i, grey, {0, 0, -10});
        quad->shade();
    }
    EXPECT_EQ(filled.work.fetches().size(), plain.work.fetches().size()); // the map is empty
    for (QuadOfKernel* quad : {&plain, &filled}) {
        quad->fill(2, {4.0F, 1e30F, 1e30F, 1e30F});
        quad->shade();
    }
    EXPECT_EQ(filled.work.fetches().size(), plain.work.fetches().size()); // the next layer is so far: none occludes
    for (QuadOfKernel* quad : {&plain, &filled}) {
        quad->fill(2, {4.0F, 5.0F, 0.0F, 0.0F});
        quad->shade();
    }
    EXPECT_EQ(filled.work.fetches().size(), plain.work.fetches().size() + 2);
    EXPECT_EQ(filled.work.instructions(), plain.work.instructions() + 2 * (1 + 7));
}

} // namespace traces_shadow_shaders_test
