// Textures of recorded programs, with values that can be computed by hand: wrap modes, filters, levels, borders,
// offsets, layers, anisotropy, wild coordinates.
#include "tests/support/texture_kit.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace quad_sampler_test {

using namespace pipeline;
using tests::all_lanes;
using tests::lookup_at;
using tests::number_surface;
using tests::TextureKit;

constexpr float infinity = std::numeric_limits<float>::infinity();
const float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// Texels 10, 20, 30, 40.
TextureKit row_of_four() {
    TextureKit kit(number_surface({.name = "row", .width = 4},
                                  [](auto, auto, std::uint32_t x, auto) { return 10.0F * static_cast<float>(x + 1); }),
                   TextureKind::line);
    kit.sampler.border = glm::vec4(7.0F);
    return kit;
}

/// Level n of four holds 100 n.
TextureKit pyramid() {
    TextureKit kit(
        number_surface({.name = "pyramid", .width = 8, .height = 8, .levels = 4},
                       [](std::uint32_t level, auto, auto, auto) { return 100.0F * static_cast<float>(level); }));
    kit.sampler.min_filter = Filter::linear_mip_linear;
    kit.sampler.mag_filter = Filter::linear;
    return kit;
}

TextureLookup at_level(float level) {
    TextureLookup lookup = lookup_at({0.5F, 0.5F});
    lookup.lod = all_lanes(level);
    return lookup;
}

TEST(QuadSampler, EveryWrapWithEveryFilter) {
    struct Expected {
        Wrap wrap;
        float beyond, before, far_before; ///< nearest, at texels 4.5, -0.5, -2.5
        float edge, begin;                ///< linear, at 4 and 0
    };
    for (const Expected& expected :
         {Expected{Wrap::repeat, 10, 40, 20, 25, 25}, Expected{Wrap::clamp, 40, 10, 10, 40, 10},
          Expected{Wrap::mirror, 40, 10, 30, 40, 10}, Expected{Wrap::border, 7, 7, 7, 23.5F, 8.5F}}) {
        SCOPED_TRACE(static_cast<int>(expected.wrap));
        TextureKit kit = row_of_four();
        kit.sampler.wrap_u = expected.wrap;
        EXPECT_EQ(kit.at({4.5F / 4}), expected.beyond);
        EXPECT_EQ(kit.at({-0.5F / 4}), expected.before);
        EXPECT_EQ(kit.at({-2.5F / 4}), expected.far_before);
        kit.sampler.mag_filter = kit.sampler.min_filter = Filter::linear;
        EXPECT_EQ(kit.at({1.0F}), expected.edge);
        EXPECT_EQ(kit.at({0.0F}), expected.begin);
        EXPECT_EQ(kit.at({1.75F / 4}), 22.5F);
    }
}

TEST(QuadSampler, EachAxisOfAVolumeWrapsOnItsOwn) {
    TextureKit kit(
        number_surface({.name = "volume", .width = 4, .height = 4, .planes = 4, .shape = SurfaceShape::volume},
                       [](auto, std::uint32_t z, std::uint32_t x, std::uint32_t y) {
                           return static_cast<float>(x + 10 * y + 100 * z);
                       }),
        TextureKind::volume);
    kit.sampler.wrap_u = Wrap::repeat;
    kit.sampler.wrap_v = Wrap::clamp;
    kit.sampler.wrap_w = Wrap::mirror;
    EXPECT_EQ(kit.at({1.625F, 1.625F, 1.625F}), 2.0F + 30.0F + 100.0F);
    kit.sampler.mag_filter = Filter::linear;
    EXPECT_EQ(kit.at({0.5F, 0.5F, 0.5F}), 1.5F + 15.0F + 150.0F);
    kit.sampler.wrap_w = Wrap::border;
    kit.sampler.border.r = 1000.0F;
    EXPECT_EQ(kit.at({0.375F, 0.375F, 1.0F}), (311.0F + 1000.0F) / 2);
}

TEST(QuadSampler, LevelsAreBiasedAndBounded) {
    const auto read = [](float level, auto change) {
        TextureKit kit = pyramid();
        change(kit);
        return kit.sample(at_level(level))[0].r;
    };
    const auto nothing = [](TextureKit&) {};
    EXPECT_EQ(read(0, nothing), 0.0F);
    EXPECT_EQ(read(1.5F, nothing), 150.0F);
    EXPECT_EQ(read(9, nothing), 300.0F);
    EXPECT_EQ(read(1, [](TextureKit& kit) { kit.sampler.lod_bias = 0.25F; }), 125.0F);
    EXPECT_EQ(read(0, [](TextureKit& kit) { kit.sampler.least_lod = 2; }), 200.0F);
    EXPECT_EQ(read(3, [](TextureKit& kit) { kit.sampler.most_lod = 1; }), 100.0F);
    EXPECT_EQ(read(0, [](TextureKit& kit) { kit.view.base_level = 1; }), 100.0F);
    EXPECT_EQ(read(1, [](TextureKit& kit) { kit.view.base_level = 1; }), 200.0F);
    EXPECT_EQ(read(9, [](TextureKit& kit) { kit.view.last_level = 2; }), 200.0F);
    EXPECT_EQ(read(9, [](TextureKit& kit) { kit.view.base_level = 99; }), 300.0F);
    EXPECT_EQ(read(1.5F, [](TextureKit& kit) { kit.sampler.min_filter = Filter::linear_mip_nearest; }), 100.0F);
    EXPECT_EQ(read(1.51F, [](TextureKit& kit) { kit.sampler.min_filter = Filter::linear_mip_nearest; }), 200.0F);
    EXPECT_EQ(read(9, [](TextureKit& kit) { kit.sampler.min_filter = Filter::linear; }), 0.0F);
}

TEST(QuadSampler, TheLongerWayOfTheQuadMakesItsLevel) {
    TextureKit kit = pyramid();
    const auto level = [&](const glm::vec2& right, const glm::vec2& down, float bias = 0.0F) {
        TextureLookup lookup;
        lookup.place[0] = {0.5F, 0.5F + right.x / 8, 0.5F + down.x / 8, 0.5F};
        lookup.place[1] = {0.5F, 0.5F + right.y / 8, 0.5F + down.y / 8, 0.5F};
        lookup.lod = all_lanes(bias);
        return kit.sample(lookup)[3].r / 100.0F;
    };
    EXPECT_EQ(level({2, 0}, {0, 1}), 1.0F);
    EXPECT_EQ(level({0, 1}, {0, 4}), 2.0F);
    EXPECT_EQ(level({0.5F, 0}, {0, 0.5F}), 0.0F);
    EXPECT_NEAR(level({3, 4}, {1, 1}), std::log2(5.0F), 1e-5F);
    EXPECT_EQ(level({2, 0}, {0, 0}, 1), 2.0F);
    EXPECT_EQ(level({2, 0}, {0, 0}, -5), 0.0F);
}

TEST(QuadSampler, LanesWithGradientsHaveTheirOwnLevels) {
    TextureKit kit = pyramid();
    TextureLookup lookup = lookup_at({0.5F, 0.5F});
    lookup.level = LevelOfDetail::gradients;
    lookup.dx[0] = {0.125F, 0.25F, 0.5F, 0.0F};
    lookup.dy[1] = {0.0F, 0.0F, 0.125F, 1.0F};
    const QuadTexels texels = kit.sample(lookup);
    for (std::size_t lane = 0; lane < 4; ++lane) EXPECT_EQ(texels[lane].r, 100.0F * static_cast<float>(lane));
    EXPECT_EQ(kit.work.fetches().size(), 4U);
}

TEST(QuadSampler, OffsetsMoveByTexelsBeforeTheyWrap) {
    TextureKit kit = row_of_four();
    const auto moved = [&](Wrap wrap, float texel, std::int32_t by) {
        kit.sampler.wrap_u = wrap;
        TextureLookup lookup = lookup_at({texel / 4});
        lookup.offset[0] = {by, by, by, by};
        return kit.sample(lookup)[0].r;
    };
    EXPECT_EQ(moved(Wrap::repeat, 0.5F, 2), 30.0F);
    EXPECT_EQ(moved(Wrap::repeat, 2.5F, 3), 20.0F);
    EXPECT_EQ(moved(Wrap::repeat, 0.5F, -1), 40.0F);
    EXPECT_EQ(moved(Wrap::clamp, 5.5F, -2), 40.0F);
    EXPECT_EQ(moved(Wrap::clamp, 3.5F, -2), 20.0F);
    EXPECT_EQ(moved(Wrap::mirror, 3.5F, 2), 30.0F);
}

TEST(QuadSampler, BordersHaveTheChannelsAndTheRangeOfTheFormat) {
    const auto border = [](SurfaceFormat format) {
        TextureKit kit(SurfaceInfo{.name = "t", .format = format});
        kit.sampler.wrap_u = Wrap::border;
        kit.sampler.border = {0.5F, 2.0F, -3.0F, 0.25F};
        return kit.sample(lookup_at({5, 0.5F}))[0];
    };
    EXPECT_EQ(border(SurfaceFormat::r8), glm::vec4(0.5F, 0, 0, 1));
    EXPECT_EQ(border(SurfaceFormat::rgba8), glm::vec4(0.5F, 1, 0, 0.25F));
    EXPECT_EQ(border(SurfaceFormat::rgba8s), glm::vec4(0.5F, 1, -1, 0.25F));
    EXPECT_EQ(border(SurfaceFormat::rgba32f), glm::vec4(0.5F, 2, -3, 0.25F));
    EXPECT_EQ(border(SurfaceFormat::d24s8), glm::vec4(0.5F, 0, 0, 1));
    EXPECT_EQ(std::bit_cast<std::uint32_t>(border(SurfaceFormat::rg32u).g), 2U);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(border(SurfaceFormat::rg32u).a), 1U);
}

// Depths 0.2 and 0.8 side by side: what passes is filtered, not the depths.
TEST(QuadSampler, LayersAreTheNearest) {
    TextureKit kit(number_surface({.name = "layers", .width = 2, .height = 2, .planes = 3},
                                  [](auto, std::uint32_t plane, auto, auto) { return static_cast<float>(plane); }));
    kit.view.arrayed = true;
    const auto layer = [&](float value) { return kit.at({0.5F, 0.5F, value}); };
    EXPECT_EQ(layer(0.49F), 0.0F);
    EXPECT_EQ(layer(0.5F), 1.0F);
    EXPECT_EQ(layer(1.5F), 2.0F);
    EXPECT_EQ(layer(-3), 0.0F);
    EXPECT_EQ(layer(99), 2.0F);
    EXPECT_EQ(layer(infinity), 2.0F);
    EXPECT_EQ(layer(not_a_number), 0.0F);
}

TEST(QuadSampler, RectanglesAreReadInTexels) {
    TextureKit kit(
        number_surface({.name = "t", .width = 7, .height = 3},
                       [](auto, auto, std::uint32_t x, std::uint32_t y) { return static_cast<float>(x + 10 * y); }),
        TextureKind::rectangle);
    kit.sampler.wrap_u = kit.sampler.wrap_v = Wrap::clamp;
    for (std::uint32_t x = 0; x < 7; ++x) EXPECT_EQ(kit.at({static_cast<float>(x), 1}), static_cast<float>(x + 10));
    EXPECT_EQ(kit.at({99, -5}), 6.0F);
    kit.sampler.mag_filter = Filter::linear;
    EXPECT_EQ(kit.at({3, 1.5F}), 12.5F);
    kit.sampler.wrap_u = Wrap::border;
    EXPECT_EQ(kit.at({1e30F, 1.5F}), 0.0F);
}

TEST(QuadSampler, AnisotropicProbesLieAlongTheLongerAxis) {
    TextureKit kit(number_surface({.name = "squares", .width = 16, .height = 2},
                                  [](auto, auto, std::uint32_t x, auto) { return static_cast<float>(x * x); }));
    kit.sampler.anisotropy = 4;
    TextureLookup lookup = lookup_at({0.5F, 0.25F});
    lookup.level = LevelOfDetail::gradients;
    lookup.dx[0] = all_lanes(4.0F / 16);
    lookup.lanes = 1;
    // Probes 1.2 and 0.4 texels to both sides of the middle: texels 6, 7, 8, 9.
    EXPECT_EQ(kit.sample(lookup)[0].r, (36.0F + 49.0F + 64.0F + 81.0F) / 4);
    EXPECT_EQ(kit.work.fetches().size(), 4U);
    kit.sampler.anisotropy = 1;
    EXPECT_EQ(kit.sample(lookup)[0].r, 64.0F);
    EXPECT_EQ(kit.work.fetches().size(), 5U);
}

/// Whatever the coordinates, a value of the texture or of the border comes back.
TEST(QuadSampler, WildCoordinatesEnd) {
    constexpr std::array kinds{TextureKind::line, TextureKind::plane, TextureKind::volume, TextureKind::cube,
                               TextureKind::rectangle};
    const std::array wild{not_a_number, infinity, -infinity, 1e30F, -1e30F, 3.4e38F, -0.0F, 1e-40F};
    for (const TextureKind kind : kinds)
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror, Wrap::border})
            for (const LevelOfDetail level :
                 {LevelOfDetail::implicit, LevelOfDetail::given, LevelOfDetail::gradients}) {
                SurfaceInfo info{.name = "t", .width = 5, .height = 5, .planes = 6, .levels = 3};
                if (kind == TextureKind::volume) info.shape = SurfaceShape::volume;
                TextureKit kit(number_surface(info, [](auto, auto, auto, auto) { return 1.0F; }), kind);
                kit.sampler.min_filter = Filter::linear_mip_linear;
                kit.sampler.mag_filter = Filter::linear;
                kit.sampler.anisotropy = 8;
                kit.sampler.wrap_u = kit.sampler.wrap_v = kit.sampler.wrap_w = wrap;
                kit.sampler.border = glm::vec4(1.0F);
                for (const bool gathers : {false, true})
                    for (const float a : wild)
                        for (const float b : wild) {
                            TextureLookup lookup;
                            lookup.level = level;
                            lookup.place = {{{a, 0.3F, b, a}, {b, a, 0.5F, 1}, {0.1F, b, a, b}, {a, b, a, b}}};
                            lookup.dx = {{{a, b, a, b}, {0, a, b, 1}, {b, b, 1, a}}};
                            lookup.dy = {{{1, b, 0, b}, {b, a, b, 1}, {b, 0, 1, a}}};
                            lookup.lod = {a, b, 1, -b};
                            lookup.gathers = gathers;
                            kit.work.clear();
                            for (const glm::vec4& texel : kit.sample(lookup)) EXPECT_FLOAT_EQ(texel.r, 1.0F);
                        }
            }
}

} // namespace quad_sampler_test
