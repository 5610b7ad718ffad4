// Texture sampling and mip levels.
#include "pipeline/functional/number_formats.hpp"
#include "pipeline/functional/texture_sampler.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace pipeline {
namespace {

QuadTexcoords everywhere(const glm::vec2& coordinates) {
    QuadTexcoords result;
    result.u.fill(coordinates.x);
    result.v.fill(coordinates.y);
    return result;
}

glm::vec4 sampled(const TextureSampler& sampler, const glm::vec2& coordinates, float level_of_detail = 0.0F) {
    std::array<glm::vec4, 4> colours;
    sampler.sample(everywhere(coordinates), sampler.footprint(level_of_detail), 4U, colours);
    return colours[2];
}

std::uint32_t line_at(const TextureSampler& sampler, const glm::vec2& coordinates, float level_of_detail) {
    std::array<glm::vec4, 4> colours;
    return sampler.sample(everywhere(coordinates), sampler.footprint(level_of_detail), 8U, colours);
}

using tests::texture_of;
using tests::texture_of_one_colour;

constexpr std::uint32_t red = 0xFF0000FF, green = 0x00FF00FF, blue = 0x0000FFFF, white = 0xFFFFFFFF, black = 0x000000FF;
const glm::vec4 pure_red(1, 0, 0, 1), pure_green(0, 1, 0, 1), pure_blue(0, 0, 1, 1), pure_white(1, 1, 1, 1);

/// Four texels in a row, linear values, nearest filter.
Texture row_of_four(Wrap wrap) {
    Texture texture = texture_of(4, 1, {red, green, blue, white});
    texture.srgb = false;
    texture.wrap_u = texture.wrap_v = wrap;
    texture.mag_filter = Filter::nearest;
    return texture;
}

glm::vec4 nearest(Wrap wrap, float u) {
    const Texture texture = row_of_four(wrap);
    return sampled(TextureSampler(texture), {u, 0.5F}, 0.0F);
}

TEST(TextureSampling, RepeatTakesTheFraction) {
    EXPECT_EQ(nearest(Wrap::repeat, 0.1F), pure_red);
    EXPECT_EQ(nearest(Wrap::repeat, 1.3F), pure_green);
    EXPECT_EQ(nearest(Wrap::repeat, -0.3F), pure_blue);
    EXPECT_EQ(nearest(Wrap::repeat, -1e-20F), pure_red); // its fraction rounds to 1, the texel behind the last
    EXPECT_EQ(nearest(Wrap::repeat, 16777215.0F), pure_red);
}

TEST(TextureSampling, ClampStopsAtTheBorder) {
    EXPECT_EQ(nearest(Wrap::clamp, -5.0F), pure_red);
    EXPECT_EQ(nearest(Wrap::clamp, 1.0F), pure_white);
    EXPECT_EQ(nearest(Wrap::clamp, 1e30F), pure_white);
}

TEST(TextureSampling, MirrorRunsBackwardsInOddPeriods) {
    EXPECT_EQ(nearest(Wrap::mirror, 0.1F), pure_red);
    EXPECT_EQ(nearest(Wrap::mirror, 1.1F), pure_white);
    EXPECT_EQ(nearest(Wrap::mirror, 1.9F), pure_red);
    EXPECT_EQ(nearest(Wrap::mirror, -0.1F), pure_red);
    EXPECT_EQ(nearest(Wrap::mirror, -1.1F), pure_white);
    EXPECT_EQ(nearest(Wrap::mirror, 2.3F), pure_green);
}

TEST(TextureSampling, CoordinatesWithoutFractionsAreHarmless) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (const float u : {1e9F, -1e9F, 1e38F, -1e38F, 0x1p23F, 0x1p24F}) {
            const Texture texture = row_of_four(wrap);
            const glm::vec4 colour = sampled(TextureSampler(texture), {u, u}, 0.0F);
            EXPECT_TRUE(std::isfinite(colour.r) && colour.a == 1.0F);
        }
}

TEST(TextureSampling, BilinearWeightsTexelsByTheirCentres) {
    Texture texture = row_of_four(Wrap::clamp);
    texture.mag_filter = Filter::linear;
    const TextureSampler sampler(texture);
    EXPECT_EQ(sampled(sampler, {0.125F, 0.5F}, 0.0F), pure_red);
    EXPECT_EQ(sampled(sampler, {0.25F, 0.5F}, 0.0F), glm::vec4(0.5F, 0.5F, 0, 1));
    EXPECT_EQ(sampled(sampler, {0.0F, 0.5F}, 0.0F), pure_red);
    texture.wrap_u = Wrap::repeat;
    EXPECT_EQ(sampled(sampler, {0.0F, 0.5F}, 0.0F), glm::vec4(1.0F, 0.5F, 0.5F, 1)); // white and red meet
    texture.wrap_u = Wrap::mirror;
    EXPECT_EQ(sampled(sampler, {0.0F, 0.5F}, 0.0F), pure_red);
}

TEST(TextureSampling, OneColourStaysThatColourUnderEveryFilter) {
    for (const Filter filter : {Filter::nearest, Filter::linear, Filter::nearest_mip_nearest,
                                Filter::linear_mip_nearest, Filter::nearest_mip_linear, Filter::linear_mip_linear}) {
        Texture texture = texture_of_one_colour(13, 7, 0x807F1234);
        texture.min_filter = texture.mag_filter = filter;
        texture.make_mips();
        const TextureSampler sampler(texture);
        for (const float lod : {0.0F, 0.3F, 0.5F, 1.7F, 3.0F})
            for (const float u : {0.013F, 0.333F, 0.77F}) {
                const glm::vec4 colour = sampled(sampler, {u, 1.1F - u}, lod);
                EXPECT_EQ(colour.r, srgb_decode_table()[0x80]);
                EXPECT_EQ(colour.a, unorm8_to_float(0x34));
            }
    }
}

TEST(TextureSampling, SrgbIsDecodedBeforeFiltering) {
    Texture texture = texture_of(2, 1, {white, black});
    texture.wrap_u = Wrap::clamp;
    EXPECT_EQ(sampled(TextureSampler(texture), {0.5F, 0.5F}, 0.0F).r, 0.5F); // half the light, not half the code
    EXPECT_EQ(sampled(TextureSampler(texture), {0.5F, 0.5F}, 0.0F).a, 1.0F);
}

TEST(LevelOfDetail, IsTheLogarithmOfTheLongerFootprint) {
    Texture texture = texture_of_one_colour(64, 32, white);
    texture.make_mips();
    const TextureSampler sampler(texture);
    const auto lod = [&](float du_dx, float dv_dy) {
        return sampler.level_of_detail({{0.0F, du_dx, 0.0F, du_dx}, {0.0F, 0.0F, dv_dy, dv_dy}});
    };
    EXPECT_EQ(lod(1.0F / 64, 1.0F / 32), 0.0F);
    EXPECT_EQ(lod(0.5F / 64, 0.5F / 32), 0.0F);
    EXPECT_EQ(lod(4.0F / 64, 1.0F / 32), 2.0F);
    EXPECT_EQ(lod(1.0F / 64, 8.0F / 32), 3.0F);
    EXPECT_EQ(lod(1000.0F, 1.0F), 6.0F);                         // the last level
    EXPECT_GT(lod(std::nextafter(1.0F / 64, 1.0F), 0.0F), 0.0F); // minified, however little
}

TEST(LevelOfDetail, DegenerateCoordinatesMagnify) {
    Texture texture = texture_of_one_colour(64, 64, white);
    texture.make_mips();
    const TextureSampler sampler(texture);
    EXPECT_EQ(sampler.level_of_detail(everywhere({0.3F, 0.4F})), 0.0F);
    EXPECT_EQ(sampler.level_of_detail({{0, 1e38F, -1e38F, 0}, {0, -1e38F, 1e38F, 0}}), 6.0F);
}

TEST(LevelOfDetail, FiltersPickTheirLevels) {
    // Level 0 red, 1 green, 2 blue.
    Texture texture = texture_of_one_colour(4, 4, red);
    texture.srgb = false;
    texture.levels.push_back(texture_of_one_colour(2, 2, green).levels[0]);
    texture.levels.push_back(texture_of_one_colour(1, 1, blue).levels[0]);
    const TextureSampler sampler(texture);
    const auto at = [&](Filter filter, float lod) {
        texture.min_filter = filter;
        return sampled(sampler, {0.5F, 0.5F}, lod);
    };
    EXPECT_EQ(at(Filter::linear, 2.0F), pure_red); // no mip levels
    EXPECT_EQ(at(Filter::linear_mip_nearest, 0.0F), pure_red);
    EXPECT_EQ(at(Filter::linear_mip_nearest, 0.5F), pure_red);
    EXPECT_EQ(at(Filter::linear_mip_nearest, 0.51F), pure_green);
    EXPECT_EQ(at(Filter::nearest_mip_nearest, 1.6F), pure_blue);
    EXPECT_EQ(at(Filter::nearest_mip_nearest, 2.0F), pure_blue);
    EXPECT_EQ(at(Filter::linear_mip_linear, 0.25F), glm::vec4(0.75F, 0.25F, 0, 1));
    EXPECT_EQ(at(Filter::nearest_mip_linear, 1.5F), glm::vec4(0, 0.5F, 0.5F, 1));
    EXPECT_EQ(at(Filter::linear_mip_linear, 2.0F), pure_blue);
}

TEST(MipLevels, HalveRoundingDownToOneTexel) {
    Texture texture = texture_of_one_colour(13, 6, white);
    texture.make_mips();
    ASSERT_EQ(texture.levels.size(), 4U);
    EXPECT_EQ(texture.levels[1].width, 6U);
    EXPECT_EQ(texture.levels[1].height, 3U);
    EXPECT_EQ(texture.levels[2].width, 3U);
    EXPECT_EQ(texture.levels[2].height, 1U);
    EXPECT_EQ(texture.levels[3].width, 1U);
    EXPECT_EQ(texture.levels[3].height, 1U);
    texture.make_mips(); // again: the same
    EXPECT_EQ(texture.levels.size(), 4U);
}

TEST(MipLevels, AverageInLinearLight) {
    Texture texture = texture_of(2, 2, {white, black, black, white});
    texture.make_mips();
    EXPECT_EQ(texture.levels[1].rgba[0], 188); // half the light
    texture.srgb = false;
    texture.make_mips();
    EXPECT_EQ(texture.levels[1].rgba[0], 128);
}

TEST(TextureLines, AreTilesOfFourByFourTexels) {
    Texture texture = texture_of_one_colour(10, 9, white); // 3 x 3 tiles
    texture.wrap_u = texture.wrap_v = Wrap::clamp;
    texture.make_mips();
    Resources resources;
    resources.buffers.push_back({"", std::vector<std::byte>(100), 0});
    resources.textures = {texture};
    resources.place();
    EXPECT_EQ(resources.textures[0].levels[0].address, 256U);
    EXPECT_EQ(resources.textures[0].levels[1].address, 1024U); // 9 tiles of 64 bytes, up to a multiple of 256
    const TextureSampler sampler(resources.textures[0]);
    EXPECT_EQ(line_at(sampler, {0.0F, 0.0F}, 0.0F), 4U);
    EXPECT_EQ(line_at(sampler, {0.39F, 0.0F}, 0.0F), 4U);
    EXPECT_EQ(line_at(sampler, {0.41F, 0.0F}, 0.0F), 5U);
    EXPECT_EQ(line_at(sampler, {0.0F, 0.99F}, 0.0F), 4U + 6U);
    EXPECT_EQ(line_at(sampler, {1.0F, 1.0F}, 0.0F), 4U + 8U);
    EXPECT_EQ(line_at(sampler, {0.0F, 0.0F}, 1.0F), 16U);
}

} // namespace
} // namespace pipeline
