// Layered shadow maps and the kernel that projects their texels back onto a square light (specification 004, A18 to
// A24, checks S1 to S4 and S8, section 6.2).
#include "pipeline/functional/eye_depth.hpp"
#include "traces/shadows/shadow_kernel.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace traces_shadows_test {

using traces::AreaLight;
using traces::ShadowBias;
using traces::ShadowFormat;
using traces::ShadowKernel;
using traces::ShadowKernelOptions;
using traces::ShadowMap;
using traces::ShadowMapOptions;

// The setting of S1: r = 1024, l = w = n = 1.
AreaLight unit_light(double width = 1.0) {
    AreaLight light;
    light.width = width;
    light.near = light.near_width = 1.0;
    light.far = 1000.0;
    return light;
}

// A point `z` before the light, `x` along its right and `y` along its up.
glm::dvec3 point(const AreaLight& light, double x, double y, double z) {
    return light.centre + x * light.right + y * light.up + z * light.forward;
}

/// Distance of a layer at a place of the near plane, (-0.5, 0.5) across the map; infinite: no surface.
using Layer = std::function<double(double x, double y)>;
constexpr double nothing = INFINITY;

ShadowMap map_of(const AreaLight& light, ShadowMapOptions options, const std::vector<Layer>& layers) {
    const std::uint32_t r = options.resolution;
    options.captured = static_cast<std::uint32_t>(layers.size());
    options.layers = std::min(options.layers, options.captured);
    const std::size_t floats = (options.captured + 3) / 4 * 4;
    std::vector<float> kbuffer(std::size_t{r} * r * floats, 2.0F);
    const pipeline::EyeDepth depth(light.view(r).projection);
    for (std::uint32_t y = 0; y < r; ++y)
        for (std::uint32_t x = 0; x < r; ++x)
            for (std::size_t layer = 0; layer < layers.size(); ++layer) {
                const double z = layers[layer]((x + 0.5) / r - 0.5, 0.5 - (y + 0.5) / r);
                if (z != nothing) kbuffer[(std::size_t{y} * r + x) * floats + layer] = depth.window(z);
            }
    return {light, kbuffer, floats, options};
}

Layer plane(double z) {
    return [z](double, double) { return z; };
}
Layer half_plane(double z) { // left of the axis
    return [z](double x, double) { return x < 0.0 ? z : nothing; };
}

float visibility(const ShadowMap& map, const ShadowKernelOptions& options, const glm::dvec3& at) {
    const ShadowKernel kernel(map, options);
    return kernel.visibility(kernel.region(at), 7);
}

constexpr ShadowMapOptions floats_32{.resolution = 256, .format = ShadowFormat::rgba32f};
constexpr ShadowKernelOptions all_texels{.most_samples = 65025};

TEST(ShadowKernelS1, SearchRegionAndLevelOfTheHierarchy) {
    const AreaLight light = unit_light();
    EXPECT_NEAR(traces::search_width(light, 1024, 1.0F, 10.0F), 921.6, 1e-3);
    EXPECT_NEAR(traces::search_width(light, 1024, 5.0F, 10.0F), 102.4, 1e-4);
    EXPECT_EQ(traces::search_level(102.4F, 11), 8U);
    EXPECT_EQ(traces::search_level(1e9F, 11), 10U); // one texel is the last
    EXPECT_EQ(traces::search_level(0.0F, 11), 1U);
    EXPECT_EQ(traces::search_width(light, 1024, 10.0F, 10.0F), 0.0F); // nothing lies between
    EXPECT_EQ(traces::search_width(light, 1024, 20.0F, 10.0F), 0.0F);
}

TEST(ShadowKernelS2, ATexelCoversItsShareOfTheLight) {
    const AreaLight light = unit_light();
    EXPECT_NEAR(traces::covered_share(light, 1024, 0, 0, 0.5F, 5, 10), 9.5367e-5, 1e-9);
    for (const float z_s : {1.5F, 3.0F, 5.0F, 9.0F, 9.99F}) {
        const float width = traces::search_width(light, 1024, z_s, 10.0F);
        EXPECT_NEAR(width * width * traces::covered_share(light, 1024, 0, 0, 0.5F, z_s, 10.0F),
                    width >= 1 ? 1.0F : width * width, 2e-5)
            << z_s;
    }
}

// Every texel of the region is an occluder: together they cover the light once.
TEST(ShadowKernelS2, AWholePlaneOfOccludersTakesAllLight) {
    for (const ShadowFormat format : {ShadowFormat::rgba16f, ShadowFormat::rgba32f}) {
        const AreaLight light = unit_light(0.25);
        ShadowMapOptions options = floats_32;
        options.format = format;
        const ShadowMap map = map_of(light, options, {plane(5.0), plane(10.0)});
        for (const double x : {0.0, 0.003, 1.1}) {
            const float seen = visibility(map, all_texels, point(light, x, 0.0, 10.0));
            EXPECT_NEAR(seen, 0.0F, 1e-4) << x;
        }
    }
}

TEST(ShadowKernelS3, AHalfPlaneThroughTheAxisTakesHalf) {
    const AreaLight light = unit_light(0.5);
    const ShadowMap map = map_of(light, floats_32, {half_plane(5.0), plane(10.0)});
    const ShadowKernel kernel(map, all_texels);
    const traces::SearchRegion region = kernel.region(point(light, 0.0, 0.0, 10.0));
    EXPECT_GT(region.width, 10.0F);
    EXPECT_NEAR(kernel.visibility(region, 0), 0.5F, 1.0F / region.width);
}

// Two occluders of which each leaves some light, and both together none. The lower one lies in the shadow of the upper
// one, as the middle of the light sees it, so that only a second layer knows of it: rays from the receiver at 10 to the
// light, half a unit wide, pass the upper plane (at 4) left of x = 5/256 * 4 where they end left of 0.13; those that
// end between -0.18 and 0.29 meet the lower one (at 6).
TEST(ShadowKernelS4, SecondLayerKeepsLightFromBleeding) {
    const AreaLight light = unit_light(0.5);
    constexpr double edge = 5.0 / 256, begin = -3.0 / 256;
    const Layer first = [](double x, double) { return x < edge ? 4.0 : 10.0; };
    const Layer second = [](double x, double) { return x > begin && x < edge ? 6.0 : 10.0; };
    const ShadowMap map_two = map_of(light, floats_32, {first, second, plane(10.0)});
    ShadowMapOptions one = floats_32;
    one.layers = 1;
    const ShadowMap map_one = map_of(light, one, {first, second, plane(10.0)});
    const glm::dvec3 at = point(light, 0.0, 0.0, 10.0);
    const float width = ShadowKernel(map_two, all_texels).region(at).width;
    EXPECT_NEAR(visibility(map_one, all_texels, at), 0.24F, 1.0F / width);
    EXPECT_LE(visibility(map_two, all_texels, at), 1.0F / width);
}

// z - z_s from one quantum of the format up, and 0; receivers around everything. Section 6.2, items 1, 2, 4 and 12.
TEST(ShadowKernelS8, IsANumberBetweenNoneAndAllHoweverNearTheOccluder) {
    for (const ShadowFormat format : {ShadowFormat::rgba16f, ShadowFormat::rgba32f})
        for (const ShadowBias bias :
             {ShadowBias::none, ShadowBias::uniform, ShadowBias::midpoint, ShadowBias::second_depth})
            for (const traces::SampleOffset offset : {traces::SampleOffset::integer, traces::SampleOffset::exact}) {
                const AreaLight light = unit_light(0.5);
                ShadowMapOptions options{.resolution = 32, .format = format, .bias = bias};
                ShadowKernelOptions kernel{.most_samples = 169, .offset = offset};
                const ShadowMap map = map_of(light, options, {plane(300.0), plane(301.0), plane(302.0), plane(303.0)});
                const float stored = map.depth(0, 16, 16);
                std::vector<double> receivers{0.0, 0.5, 1.0, std::nextafter(1.0, 2.0), 299.0, 1000.0, 1e30};
                for (const int quanta : {-2, -1, 0, 1, 2, 3, 8})
                    receivers.push_back(stored + quanta * (format == ShadowFormat::rgba16f ? 0.25 : 0x1p-15));
                for (const double z : receivers)
                    for (const double x : {0.0, 1e-7, 3.0, 1e6}) {
                        const float seen = visibility(map, kernel, point(light, x, x, z));
                        EXPECT_TRUE(seen >= 0.0F && seen <= 1.0F) << z << " " << x << ": " << seen;
                    }
            }
    // The product of two depths beyond 256 is more than a half can hold; here it is none.
    EXPECT_NEAR(traces::covered_share(unit_light(10.0), 1024, 0, 0, 0.5F, 300.0F, 400.0F), 0.1171875F * 0.1171875F,
                1e-6);
    EXPECT_EQ(traces::covered_share(unit_light(), 1024, 0, 0, 0.5F, 5.0F, 5.0F), 0.0F);
    EXPECT_EQ(traces::covered_share(unit_light(), 1024, 0, 0, 0.5F, 6.0F, 5.0F), 0.0F);
}

TEST(ShadowKernel, ALightOfNoSizeThrowsAHardShadow) {
    const AreaLight light = unit_light(0.0);
    const ShadowMap map = map_of(light, floats_32, {half_plane(5.0), plane(10.0)});
    for (const traces::SampleOffset offset : {traces::SampleOffset::integer, traces::SampleOffset::exact}) {
        ShadowKernelOptions soft, hard;
        soft.offset = offset;
        hard.method = traces::ShadowMethod::hard;
        std::array<int, 2> seen{};
        for (int i = -40; i <= 40; ++i) {
            const glm::dvec3 at = point(light, 0.05 * i, 0.031 * i, 9.999);
            const float value = visibility(map, soft, at);
            EXPECT_EQ(value, visibility(map, hard, at)) << i;
            ++seen[value == 1.0F];
        }
        EXPECT_GT(seen[0], 30);
        EXPECT_GT(seen[1], 30);
    }
}

TEST(ShadowKernel, AHugeLightSearchesTheWholeMapAndStopsThere) {
    const AreaLight light = unit_light(1e6);
    ShadowMapOptions options = floats_32;
    options.resolution = 16;
    const ShadowMap map = map_of(light, options, {plane(5.0), plane(10.0)});
    const ShadowKernel kernel(map, all_texels);
    const traces::SearchRegion region = kernel.region(point(light, 0.0, 0.0, 10.0));
    EXPECT_EQ(region.width, 4.0F * 16);
    const float seen = kernel.visibility(region, 0);
    EXPECT_GT(seen, 0.99F); // what the map holds is a speck before such a light
    EXPECT_LE(seen, 1.0F);
}

TEST(ShadowKernel, AnEmptyMapAndOneOfOneTexelWork) {
    const AreaLight light = unit_light();
    ShadowMapOptions one = floats_32;
    one.resolution = 1;
    EXPECT_EQ(
        visibility(map_of(light, floats_32, {plane(nothing), plane(nothing)}), all_texels, point(light, 0, 0, 10)),
        1.0F);
    EXPECT_EQ(visibility(map_of(light, one, {plane(nothing), plane(nothing)}), all_texels, point(light, 0, 0, 10)),
              1.0F);
    const float seen = visibility(map_of(light, one, {plane(2.0), plane(10.0)}), all_texels, point(light, 0, 0, 10));
    EXPECT_EQ(seen, 0.0F); // 2 * (10 / 8) / 1 is more than the light is wide
}

TEST(ShadowKernel, NearThePlaneOfTheLightEverythingIsLit) {
    const AreaLight light = unit_light();
    const ShadowMap map = map_of(light, floats_32, {plane(1.0), plane(10.0)});
    for (const double z : {-5.0, 0.0, 1e-30, 0.999, 1.0})
        EXPECT_EQ(visibility(map, all_texels, point(light, 0.0, 0.0, z)), 1.0F) << z;
}

TEST(ShadowKernel, SamplesStayWithinTheirBoundAndCoverTheRegion) {
    const AreaLight light = unit_light();
    ShadowMapOptions options = floats_32;
    const ShadowMap map = map_of(light, options, {plane(2.0), plane(10.0)});
    for (const std::uint32_t most : {1U, 2U, 9U, 169U, 289U, 441U, 961U, 1089U}) {
        const traces::SearchRegion region =
            ShadowKernel(map, {.most_samples = most}).region(point(light, 0.0, 0.0, 10.0));
        EXPECT_LE(region.across * region.across, most);
        EXPECT_GE(region.step * static_cast<float>(region.across), region.width);
        // Symmetric about the projected point.
        EXPECT_NEAR(ShadowKernel::offset_of(region, 0), -ShadowKernel::offset_of(region, region.across - 1), 1e-3);
    }
    // All texels: steps of one, the middle sample at the point itself.
    const traces::SearchRegion whole = ShadowKernel(map, all_texels).region(point(light, 0.0, 0.0, 10.0));
    EXPECT_EQ(whole.step, 1.0F);
    EXPECT_EQ(whole.across, 2 * std::ceil(whole.width / 2.0F) + 1);
    EXPECT_EQ(ShadowKernel::offset_of(whole, whole.across / 2), 0.0F);
}

TEST(ShadowKernel, SteppedOverSamplesCoverWhatTheyStandFor) {
    const AreaLight light = unit_light();
    const ShadowMap map = map_of(light, floats_32, {plane(3.0), plane(10.0)});
    for (const std::uint32_t most : {1U, 9U, 49U, 169U}) // the plane takes all light, however coarse the sampling
        for (const traces::SampleStep step : {traces::SampleStep::even, traces::SampleStep::literal})
            EXPECT_NEAR(visibility(map, {.most_samples = most, .step = step}, point(light, 0.0, 0.0, 10.0)), 0.0F, 1e-4)
                << most;
}

TEST(ShadowKernel, WithoutTheHierarchyTheSameShadowFallsFromMoreSamples) {
    const AreaLight light = unit_light(0.5);
    const ShadowMap map = map_of(light, floats_32, {half_plane(5.0), plane(10.0)});
    ShadowKernelOptions wide = all_texels;
    wide.iterations = 0;
    for (const double x : {-0.5, -0.1, 0.0, 0.2, 0.6}) {
        const glm::dvec3 at = point(light, x, 0.0, 10.0);
        EXPECT_GT(ShadowKernel(map, wide).region(at).across, ShadowKernel(map, all_texels).region(at).across);
        EXPECT_NEAR(visibility(map, wide, at), visibility(map, all_texels, at), 1e-4) << x;
    }
}

TEST(ShadowKernel, GapFillingNeverLightens) {
    const AreaLight light = unit_light(0.5);
    const Layer comb = [](double x, double) {
        return std::fmod(std::abs(x) * 64.0, 2.0) < 1.0 ? 4.0 + 4.0 * std::abs(x) : nothing;
    };
    const ShadowMap map = map_of(light, floats_32, {comb, plane(10.0)});
    ShadowKernelOptions filled = all_texels;
    filled.gap_filling = true;
    double darker = 0;
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 at = point(light, 0.03 * i - 0.7, 0.1, 10.0);
        const float plain = visibility(map, all_texels, at), full = visibility(map, filled, at);
        EXPECT_LE(full, plain + 1e-6F);
        darker += plain - full;
    }
    EXPECT_GT(darker, 0.0);
}

TEST(ShadowMap, BiasesAreThoseOfTheirKind) {
    const AreaLight light = unit_light();
    const auto bias_of = [&](ShadowBias kind, std::uint32_t layer) {
        ShadowMapOptions options{
            .resolution = 4, .layers = 2, .format = ShadowFormat::rgba32f, .bias = kind, .uniform_bias = 0.3F};
        return map_of(light, options, {plane(4.0), plane(6.0)}).bias(layer, 1, 2);
    };
    EXPECT_EQ(bias_of(ShadowBias::none, 0), 0.0F);
    EXPECT_EQ(bias_of(ShadowBias::uniform, 1), 0.3F);
    EXPECT_NEAR(bias_of(ShadowBias::midpoint, 0), 1.0F, 1e-4);
    EXPECT_NEAR(bias_of(ShadowBias::second_depth, 0), 2.0F, 1e-4);
    EXPECT_EQ(bias_of(ShadowBias::midpoint, 1), 0.0F); // the last layer has no successor
}

TEST(ShadowMap, SlopeBiasGrowsWithTheSlopeUpToItsBound) {
    const AreaLight light = unit_light();
    const Layer ramp = [](double x, double) { return 5.0 + 2.0 * x; };
    ShadowMapOptions options{
        .resolution = 64, .layers = 1, .format = ShadowFormat::rgba32f, .bias = ShadowBias::none, .gscale = 3.0F};
    EXPECT_NEAR(map_of(light, options, {ramp, plane(20.0)}).bias(0, 20, 20), 3.0 * 2.0 / 64, 1e-4);
    options.gscale = 1e38F;
    EXPECT_TRUE(std::isfinite(map_of(light, options, {ramp, plane(20.0)}).bias(0, 20, 20)));
    options.gscale = 3.0F;
    options.gmax = 0.05F;
    EXPECT_EQ(map_of(light, options, {ramp, plane(20.0)}).bias(0, 20, 20), 0.05F);
    options.bias = ShadowBias::midpoint; // the larger of the two
    EXPECT_NEAR(map_of(light, options, {ramp, plane(20.0)}).bias(0, 20, 20), (20.0 - 4.64) / 2.0, 0.05);
}

// Section 6.2, item 3.
TEST(ShadowMap, HalfFloatsKeepElevenBitsAndDepthsBeyondThemAreNoSurfaces) {
    AreaLight light = unit_light();
    light.far = 1e6;
    const auto depth_of = [&](double z) {
        return map_of(light, {.resolution = 2, .format = ShadowFormat::rgba16f}, {plane(z)}).depth(0, 0, 0);
    };
    EXPECT_NEAR(depth_of(20.01), 20.01, 0.0156 / 2);
    EXPECT_EQ(std::fmod(depth_of(20.01), 0.015625F), 0.0F);
    EXPECT_EQ(std::fmod(depth_of(700.3), 0.5F), 0.0F);
    EXPECT_EQ(depth_of(9e5), traces::shadow_sentinel(ShadowFormat::rgba16f));
    EXPECT_TRUE(map_of(light, {.resolution = 2, .format = ShadowFormat::rgba16f}, {plane(9e5)}).empty(0, 0, 0));
    EXPECT_FALSE(map_of(light, {.resolution = 2, .format = ShadowFormat::rgba32f}, {plane(9e5)}).empty(0, 0, 0));
}

TEST(ShadowMap, HierarchyHoldsTheLeastOfEachSquare) {
    const AreaLight light = unit_light();
    const Layer bumps = [](double x, double y) { return 5.0 + std::sin(40.0 * x) + std::cos(37.0 * y); };
    const ShadowMap map = map_of(light, {.resolution = 64, .format = ShadowFormat::rgba32f}, {bumps, plane(20.0)});
    ASSERT_EQ(map.levels(), 7U);
    float least = INFINITY;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) least = std::min(least, map.depth(0, x, y));
    EXPECT_EQ(map.least(6, 3.0F, 60.0F), least);
    // The four texels around a place hold everything within half a texel of their level.
    for (std::uint32_t level = 0; level < 6; ++level)
        for (const float u : {0.2F, 17.9F, 32.0F, 63.5F}) {
            const float reach = static_cast<float>(1U << level) / 2.0F;
            float near = INFINITY;
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x)
                    if (std::abs(static_cast<float>(x) + 0.5F - u) < reach &&
                        std::abs(static_cast<float>(y) + 0.5F - u) < reach)
                        near = std::min(near, map.depth(0, x, y));
            EXPECT_LE(map.least(level, u, u), near) << level << " " << u;
        }
}

TEST(ShadowMap, TornLayersGiveNoNegativeBias) {
    const AreaLight light = unit_light();
    const ShadowMap map = map_of(light, {.resolution = 2, .layers = 1}, {plane(9.0), plane(4.0)});
    EXPECT_EQ(map.bias(0, 0, 0), 0.0F);
}

} // namespace traces_shadows_test
