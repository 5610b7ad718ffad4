// Reads of surfaces by shaders: values, and the lines that are recorded with them.
#include "pipeline/surface_access.hpp"
#include "models/programs/nearest_k.hpp"
#include "pipeline/functional/surface_texel.hpp"

#include <array>
#include <gtest/gtest.h>

namespace pipeline {
namespace {

/// Texel (x, y) of each level holds 100 * level + x + 10 * y.
SurfaceStore ramp(std::uint32_t width, std::uint32_t height, std::uint32_t levels = 1, std::uint32_t planes = 1) {
    const std::vector<SurfaceInfo> list{{.name = "ramp",
                                         .format = SurfaceFormat::r32f,
                                         .width = width,
                                         .height = height,
                                         .planes = planes,
                                         .levels = levels}};
    SurfaceStore store(list);
    for (std::uint32_t level = 0; level < levels; ++level)
        for (std::uint32_t row = 0; row < store.rows(0, level); ++row)
            for (std::uint32_t x = 0; x < list[0].width_of(level); ++x)
                pack_colour(SurfaceFormat::r32f, glm::vec4(static_cast<float>(100 * level + x + 10 * row)),
                            store.written(0, {x, row, level}));
    return store;
}

constexpr std::array<SurfaceId, 1> only_surface{0};

Lanes all(float value) { return {value, value, value, value}; }

TEST(SurfaceAccess, FetchesSingleTexelsOfThePixelsAsked) {
    const SurfaceStore store = ramp(8, 8);
    SurfaceAccess access(store, only_surface);
    const QuadTexels texels = access.fetch(0, {2, 3, 2, 8}, {4, 4, 5, 0}, 0b1011);
    EXPECT_EQ(texels[0].r, 42.0F);
    EXPECT_EQ(texels[1].r, 43.0F);
    EXPECT_EQ(texels[2], glm::vec4(0.0F)); // not asked
    EXPECT_EQ(texels[3], glm::vec4(0.0F)); // outside
    EXPECT_EQ(texels[0].a, 1.0F);
}

TEST(SurfaceAccess, PlanesLieRowsApart) {
    const SurfaceStore store = ramp(4, 4, 1, 2);
    SurfaceAccess access(store, only_surface);
    EXPECT_EQ(access.fetch(0, {1, 1, 1, 1}, {2, 2, 2, 2}, 1, 1)[0].r, static_cast<float>(1 + 10 * (16 + 2)));
}

TEST(SurfaceAccess, BilinearIsExactAtCentresAndHalfwayBetween) {
    const SurfaceStore store = ramp(8, 8);
    SurfaceAccess access(store, only_surface);
    const SurfaceSampler sampler{.linear = true};
    EXPECT_EQ(access.sample(0, sampler, all(2.5F / 8), all(3.5F / 8), 1)[0].r, 32.0F);
    EXPECT_EQ(access.sample(0, sampler, all(3.0F / 8), all(3.5F / 8), 1)[0].r, 32.5F);
    EXPECT_EQ(access.sample(0, sampler, all(3.0F / 8), all(4.0F / 8), 1)[0].r, 37.5F);
}

TEST(SurfaceAccess, WrapModesReachBeyondTheEdge) {
    const SurfaceStore store = ramp(4, 4);
    SurfaceAccess access(store, only_surface);
    const auto at = [&](Wrap wrap, float u) {
        const SurfaceSampler sampler{.wrap_u = wrap, .border = glm::vec4(7.0F)};
        return access.sample(0, sampler, all(u), all(0.125F), 1)[0].r;
    };
    EXPECT_EQ(at(Wrap::repeat, 1.125F), 0.0F);
    EXPECT_EQ(at(Wrap::repeat, -0.125F), 3.0F);
    EXPECT_EQ(at(Wrap::clamp, 1.125F), 3.0F);
    EXPECT_EQ(at(Wrap::mirror, 1.125F), 3.0F);
    EXPECT_EQ(at(Wrap::mirror, -0.3F), 1.0F);
    EXPECT_EQ(at(Wrap::border, 1.125F), 7.0F);
    EXPECT_EQ(at(Wrap::border, -0.001F), 7.0F);
    EXPECT_EQ(at(Wrap::border, 0.999F), 3.0F);
    const SurfaceSampler linear{.linear = true, .wrap_u = Wrap::border, .border = glm::vec4(7.0F)};
    EXPECT_EQ(access.sample(0, linear, all(0.0F), all(0.125F), 1)[0].r, 3.5F); // half border, half texel 0
    EXPECT_EQ(access.sample(0, linear, all(1e30F), all(0.125F), 1)[0].r, 7.0F);
}

TEST(SurfaceAccess, TrilinearBlendsTwoLevels) {
    const SurfaceStore store = ramp(8, 8, 4);
    SurfaceAccess access(store, only_surface);
    const SurfaceSampler sampler{.linear = true, .mips = true};
    const auto centre = all(0.5F);
    const float fine = access.sample_level(0, sampler, centre, centre, 1, 0.0F)[0].r;
    const float coarse = access.sample_level(0, sampler, centre, centre, 1, 1.0F)[0].r;
    EXPECT_EQ(fine, 38.5F);
    EXPECT_EQ(coarse, 116.5F);
    EXPECT_EQ(access.sample_level(0, sampler, centre, centre, 1, 0.25F)[0].r, fine + (coarse - fine) * 0.25F);
    EXPECT_EQ(access.sample_level(0, sampler, centre, centre, 1, 99.0F)[0].r, 300.0F);
    const SurfaceSampler nearest{.mips = true};
    EXPECT_EQ(access.sample_level(0, nearest, centre, centre, 1, 0.5F)[0].r, 44.0F);
    EXPECT_EQ(access.sample_level(0, nearest, centre, centre, 1, 0.51F)[0].r, 122.0F);
}

TEST(SurfaceAccess, LevelFollowsFromTheDerivatives) {
    const SurfaceStore store = ramp(8, 8, 4);
    SurfaceAccess access(store, only_surface);
    const SurfaceSampler sampler{.linear = true, .mips = true};
    const float two_texels = 2.0F / 8;
    const Lanes u{0.5F, 0.5F + two_texels, 0.5F, 0.5F + two_texels}, v = all(0.5F);
    EXPECT_EQ(access.sample(0, sampler, u, v, 1)[0].r, access.sample_level(0, sampler, u, v, 1, 1.0F)[0].r);
}

TEST(QuadWork, RecordsTheDistinctLinesOfEachRead) {
    const SurfaceStore store = ramp(16, 16);
    QuadWork work;
    SurfaceAccess access(store, only_surface, &work);
    access.fetch(0, {0, 1, 0, 1}, {0, 0, 1, 1}, 15);  // one block of 16 bytes
    access.fetch(0, {3, 4, 3, 4}, {0, 0, 0, 0}, 15);  // two tiles of 64 bytes
    access.fetch(0, {3, 4, 3, 4}, {0, 0, 0, 0}, 0b1); // one pixel
    ASSERT_EQ(work.fetches().size(), 3U);
    EXPECT_EQ(work.lines(work.fetches()[0]).size(), 1U);
    EXPECT_EQ(work.lines(work.fetches()[1]).size(), 2U);
    EXPECT_EQ(work.lines(work.fetches()[2]).size(), 1U);
    EXPECT_EQ(work.lines(work.fetches()[0])[0], store.address(0, {0, 0}) / 64);
    EXPECT_EQ(work.fetches()[0].texel_bytes, 4U);
}

TEST(QuadWork, RunsAsLongAsTheLongestPixel) {
    QuadWork work;
    work.issue(3, 15);
    work.issue(10, 0b0010);
    work.issue(2, 0b0100);
    EXPECT_EQ(work.instructions(), 13U);
    work.clear();
    EXPECT_EQ(work.instructions(), 0U);
}

TEST(SurfaceAccess, KBuffersAreReadTargetByTarget) {
    SurfaceInfo kbuffer{.name = "k-buffer", .width = 4, .height = 4};
    kbuffer.program = models::make_nearest_k(models::EntryKind::rgbz, 3);
    SurfaceStore store(std::vector<SurfaceInfo>{kbuffer});
    reinterpret_cast<float*>(store.written(0, {1, 0}))[4] = 5.0F;
    QuadWork work;
    SurfaceAccess access(store, only_surface, &work);
    const auto pixels = access.pixels(0, {0, 1, 0, 1}, {0, 0, 1, 1}, 0b0011, 1, 2);
    EXPECT_EQ(pixels[1][4], 5.0F);
    EXPECT_EQ(pixels[2], nullptr);
    ASSERT_EQ(work.fetches().size(), 2U);
    EXPECT_EQ(work.lines(work.fetches()[0])[0] + 1, work.lines(work.fetches()[1])[0]);
    EXPECT_EQ(work.fetches()[0].texel_bytes, 16U);
}

} // namespace
} // namespace pipeline
