// What textures of recorded programs give beside filtered colours: comparisons, gathers, swizzles, single texels, bits
// of integers, sizes, and the lines that they touch.
#include "tests/support/texture_kit.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace quad_sampler_reads_test {

using namespace pipeline;
using tests::all_lanes;
using tests::lookup_at;
using tests::number_surface;
using tests::TextureKit;

const float not_a_number = std::numeric_limits<float>::quiet_NaN();

TEST(QuadSamplerReads, SwizzlesChooseChannelsAndConstants) {
    TextureKit kit(tests::byte_surface<glm::vec4>({.name = "t", .format = SurfaceFormat::rgba32f}, {{1, 2, 3, 4}}));
    kit.view.swizzle = {Swizzle::alpha, Swizzle::zero, Swizzle::one, Swizzle::green};
    EXPECT_EQ(kit.sample(lookup_at({0.5F, 0.5F}))[0], glm::vec4(4, 0, 1, 2));
    EXPECT_EQ(kit.fetch({})[3], glm::vec4(4, 0, 1, 2));
}

TEST(QuadSamplerReads, EightComparisons) {
    TextureKit kit(number_surface({.name = "depth"}, [](auto, auto, auto, auto) { return 0.5F; }));
    const auto passed = [&](Compare compare) {
        kit.sampler.compare = compare;
        TextureLookup lookup = lookup_at({0.5F, 0.5F});
        lookup.compares = true;
        lookup.reference = {0.25F, 0.5F, 0.75F, not_a_number};
        const QuadTexels texels = kit.sample(lookup);
        unsigned mask = 0;
        for (unsigned lane = 0; lane < 4; ++lane) mask |= texels[lane].r == 1.0F ? 1U << lane : 0U;
        return mask;
    };
    EXPECT_EQ(passed(Compare::never), 0b0000U);
    EXPECT_EQ(passed(Compare::less), 0b0001U);
    EXPECT_EQ(passed(Compare::equal), 0b0010U);
    EXPECT_EQ(passed(Compare::less_equal), 0b0011U);
    EXPECT_EQ(passed(Compare::greater), 0b0100U);
    EXPECT_EQ(passed(Compare::not_equal), 0b1101U);
    EXPECT_EQ(passed(Compare::greater_equal), 0b0110U);
    EXPECT_EQ(passed(Compare::always), 0b1111U);
}

TEST(QuadSamplerReads, ComparisonsAreFiltered) {
    TextureKit kit(number_surface({.name = "depth", .width = 2, .height = 2},
                                  [](auto, auto, std::uint32_t x, auto) { return x == 0 ? 0.2F : 0.8F; }));
    kit.sampler.mag_filter = Filter::linear;
    kit.sampler.wrap_u = kit.sampler.wrap_v = Wrap::border;
    kit.sampler.border = glm::vec4(1.0F);
    TextureLookup lookup = lookup_at({0.75F / 2, 0.5F});
    lookup.compares = true;
    lookup.reference = {0.5F, 0.1F, 0.9F, 0.8F};
    const QuadTexels texels = kit.sample(lookup);
    EXPECT_EQ(texels[0].r, 0.25F);
    EXPECT_EQ(texels[1].r, 1.0F);
    EXPECT_EQ(texels[2].r, 0.0F);
    EXPECT_EQ(texels[3].r, 0.25F);
    lookup.place[0] = all_lanes(0.0F); // half of it is the border
    EXPECT_EQ(kit.sample(lookup)[0].r, 0.5F);
}

TEST(QuadSamplerReads, ReferencesOfFixedPointDepthsAreClamped) {
    TextureKit kit(tests::byte_surface<std::uint16_t>({.name = "depth", .format = SurfaceFormat::d16}, {65535}));
    kit.sampler.compare = Compare::equal;
    TextureLookup lookup = lookup_at({0.5F, 0.5F});
    lookup.compares = true;
    lookup.reference = all_lanes(1.5F);
    EXPECT_EQ(kit.sample(lookup)[0].r, 1.0F);
}

TEST(QuadSamplerReads, GathersGoRoundFromTheLowerLeft) {
    TextureKit kit(
        tests::byte_surface<glm::vec4>({.name = "t", .format = SurfaceFormat::rgba32f, .width = 2, .height = 2},
                                       {{0, 100, 0, 0}, {1, 101, 0, 0}, {10, 110, 0, 0}, {11, 111, 0, 0}}));
    TextureLookup lookup = lookup_at({0.5F, 0.5F});
    lookup.gathers = true;
    EXPECT_EQ(kit.sample(lookup)[0], glm::vec4(10, 11, 1, 0));
    lookup.component = 1;
    EXPECT_EQ(kit.sample(lookup)[0], glm::vec4(110, 111, 101, 100));
    kit.view.swizzle[1] = Swizzle::one;
    EXPECT_EQ(kit.sample(lookup)[0], glm::vec4(1.0F));
    lookup.component = 0;
    lookup.compares = true;
    lookup.reference = all_lanes(5.0F);
    EXPECT_EQ(kit.sample(lookup)[0], glm::vec4(1, 1, 0, 0));
}

TEST(QuadSamplerReads, FetchesKnowLevelsLayersAndEnds) {
    TextureKit kit(number_surface({.name = "t", .width = 4, .height = 4, .planes = 2, .levels = 3},
                                  [](std::uint32_t level, std::uint32_t plane, std::uint32_t x, std::uint32_t y) {
                                      return static_cast<float>(1 + x + 10 * y + 100 * plane + 1000 * level);
                                  }));
    kit.view.arrayed = true;
    TexelLookup lookup;
    lookup.place = {{{3, 1, 0, 4}, {2, 1, -1, 0}, {1, 0, 0, 0}, {}}};
    lookup.level = {0, 1, 0, 0};
    const QuadTexels texels = kit.fetch(lookup);
    EXPECT_EQ(texels[0], glm::vec4(1 + 3 + 20 + 100, 0, 0, 1));
    EXPECT_EQ(texels[1].r, 1012.0F);
    EXPECT_EQ(texels[2], glm::vec4(0.0F));
    EXPECT_EQ(texels[3], glm::vec4(0.0F));
    lookup.place = {};
    lookup.level = {2, 3, -1, 1};
    EXPECT_EQ(kit.fetch(lookup)[0].r, 2001.0F);
    EXPECT_EQ(kit.fetch(lookup)[1].r, 0.0F);
    EXPECT_EQ(kit.fetch(lookup)[2].r, 0.0F);
    kit.view.base_level = 1;
    EXPECT_EQ(kit.fetch(lookup)[3].r, 2001.0F);
}

TEST(QuadSamplerReads, BuffersAreReadByIndexAndEnd) {
    TextureKit kit(number_surface({.name = "buffer", .width = 1000, .shape = SurfaceShape::row},
                                  [](auto, auto, std::uint32_t x, auto) { return static_cast<float>(x); }),
                   TextureKind::buffer);
    TexelLookup lookup;
    lookup.place[0] = {999, 257, 1000, -1};
    const QuadTexels texels = kit.fetch(lookup);
    EXPECT_EQ(texels[0].r, 999.0F);
    EXPECT_EQ(texels[1].r, 257.0F);
    EXPECT_EQ(texels[2], glm::vec4(0.0F));
    EXPECT_EQ(texels[3], glm::vec4(0.0F));
    EXPECT_EQ(kit.work.fetches().size(), 1U);
    EXPECT_EQ(kit.work.lines().size(), 2U);
    EXPECT_EQ(kit.work.lines()[0], (kit.store.address(0, {0, 0}) + 999 * 4) / 64);
}

TEST(QuadSamplerReads, IntegersComeAsTheirBits) {
    TextureKit kit(tests::byte_surface<std::int8_t>({.name = "t", .format = SurfaceFormat::rg8i}, {-2, 100}));
    kit.sampler.mag_filter = Filter::linear; // does not apply
    const QuadTexels sampled = kit.sample(lookup_at({0.3F, 0.3F})), fetched = kit.fetch({});
    for (const glm::vec4& texel : {sampled[0], fetched[0]}) {
        EXPECT_EQ(std::bit_cast<std::int32_t>(texel.r), -2);
        EXPECT_EQ(std::bit_cast<std::int32_t>(texel.g), 100);
        EXPECT_EQ(std::bit_cast<std::int32_t>(texel.b), 0);
        EXPECT_EQ(std::bit_cast<std::int32_t>(texel.a), 1);
    }
}

TEST(QuadSamplerReads, SizesAndLevelsAreToldWithoutGaps) {
    using Size = std::array<std::int32_t, 4>;
    const auto size = [](SurfaceInfo info, TextureKind kind, bool arrayed, std::int32_t level) {
        TextureKit kit(info, kind);
        kit.view.arrayed = arrayed;
        return kit.ask([&](const QuadSampler& sampler) { return sampler.size(level); });
    };
    const SurfaceInfo plane{.name = "t", .width = 12, .height = 6, .planes = 12, .levels = 3};
    EXPECT_EQ(size(plane, TextureKind::plane, false, 1), (Size{6, 3}));
    EXPECT_EQ(size(plane, TextureKind::plane, true, 2), (Size{3, 1, 12}));
    EXPECT_EQ(size(plane, TextureKind::cube, true, 0), (Size{12, 6, 2}));
    EXPECT_EQ(size(plane, TextureKind::line, true, 0), (Size{12, 12}));
    EXPECT_EQ(size(plane, TextureKind::plane, true, 3), Size{});
    EXPECT_EQ(size(plane, TextureKind::plane, true, -1), Size{});
    SurfaceInfo volume = plane;
    volume.shape = SurfaceShape::volume;
    EXPECT_EQ(size(volume, TextureKind::volume, false, 1), (Size{6, 3, 6}));
    TextureKit kit(SurfaceInfo{.name = "t", .width = 8, .height = 8, .levels = 4});
    kit.sampler.min_filter = Filter::linear_mip_linear;
    kit.view.base_level = 1;
    EXPECT_EQ(kit.ask([](const QuadSampler& sampler) { return sampler.levels(); }), 3);
    TextureLookup lookup = lookup_at({0.5F, 0.5F});
    lookup.level = LevelOfDetail::implicit;
    lookup.place[0][1] = 0.5F + 2.0F / 4; // two texels of the base level
    kit.sampler.most_lod = 0.5F;
    EXPECT_EQ(kit.ask([&](const QuadSampler& sampler) { return sampler.levels(lookup)[2]; }), glm::vec2(0.5F, 1.0F));
}

TEST(QuadSamplerReads, AReadTouchesTheLinesOfItsTexels) {
    TextureKit kit(SurfaceInfo{.name = "t", .width = 16, .height = 16, .levels = 5});
    kit.sampler.mag_filter = Filter::linear;
    kit.sampler.min_filter = Filter::linear_mip_linear;
    kit.sample(lookup_at({0.125F, 0.125F})); // four texels of one tile
    EXPECT_EQ(kit.work.lines().size(), 1U);
    kit.work.clear();
    kit.sample(lookup_at({0.25F, 0.25F})); // where four tiles meet
    EXPECT_EQ(kit.work.lines().size(), 4U);
    kit.work.clear();
    TextureLookup lookup = lookup_at({0.125F, 0.125F});
    lookup.lod = all_lanes(0.5F);
    kit.sample(lookup); // and one of the next level, in the same read
    EXPECT_EQ(kit.work.fetches().size(), 1U);
    EXPECT_EQ(kit.work.lines().size(), 2U);
    EXPECT_EQ(kit.work.lines()[1], kit.store.address(0, {0, 0, 1}) / 64);
}

} // namespace quad_sampler_reads_test
