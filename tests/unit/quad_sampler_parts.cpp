// Textures of which other surfaces have a level of a plane: texels, and the lines of memory, come from those.
#include "tests/support/texture_kit.hpp"

#include <gtest/gtest.h>

namespace quad_sampler_parts_test {

using namespace pipeline;
using tests::lookup_at;
using tests::number_surface;

/// A surface whose texels are 100 times their plane, plus the level; `part` is a surface of its own, of 7.
struct WithPart {
    WithPart(SurfaceInfo whole, TextureKind kind, TexturePart part)
        : infos{number_surface(whole, [](std::uint32_t level, std::uint32_t plane, auto,
                                         auto) { return static_cast<float>(100 * plane + level); }),
                number_surface(
                    {.name = "part", .width = whole.width_of(part.level), .height = whole.height_of(part.level)},
                    [](auto, auto, auto, auto) { return 7.0F; })},
          store(infos) {
        view.kind = kind;
        part.slot = 1;
        view.parts = {part};
        sampler.min_filter = sampler.mag_filter = Filter::nearest;
    }
    float at(const TextureLookup& lookup) {
        SurfaceAccess access(store, slots, &work);
        return QuadSampler(access, view, sampler).sample(lookup)[0].r;
    }

    std::array<SurfaceInfo, 2> infos;
    SurfaceStore store;
    TextureView view;
    SamplerState sampler;
    QuadWork work;
    std::array<SurfaceId, 2> slots{0, 1};
};

TEST(QuadSamplerParts, ALevelIsReadWhereItIs) {
    WithPart texture({.name = "t", .width = 8, .height = 8, .levels = 4}, TextureKind::plane, {1, 0});
    texture.sampler.min_filter = Filter::linear_mip_linear;
    texture.sampler.mag_filter = Filter::linear;
    TextureLookup lookup = lookup_at({0.5F, 0.5F});
    EXPECT_EQ(texture.at(lookup), 0.0F);
    lookup.lod = tests::all_lanes(1.0F);
    EXPECT_EQ(texture.at(lookup), 7.0F);
    lookup.lod = tests::all_lanes(1.5F);
    EXPECT_EQ(texture.at(lookup), 4.5F); // half of it, half of level 2
    lookup.lod = tests::all_lanes(2.0F);
    EXPECT_EQ(texture.at(lookup), 2.0F);
}

TEST(QuadSamplerParts, TheLinesAreThoseOfThePart) {
    WithPart texture({.name = "t", .width = 8, .height = 8, .levels = 2}, TextureKind::plane, {1, 0});
    texture.sampler.min_filter = Filter::nearest_mip_nearest;
    TextureLookup lookup = lookup_at({0.1F, 0.1F});
    lookup.lod = tests::all_lanes(1.0F);
    texture.at(lookup);
    ASSERT_EQ(texture.work.lines().size(), 1U);
    EXPECT_EQ(texture.work.lines()[0], texture.store.address(1, {0, 0, 0}) / 64);
}

TEST(QuadSamplerParts, AFaceIsReadAlsoOverTheEdgesOfOthers) {
    WithPart cube({.name = "c", .width = 4, .height = 4, .planes = 6}, TextureKind::cube, {0, 2});
    EXPECT_EQ(cube.at(lookup_at({0.0F, 1.0F, 0.0F})), 7.0F);   // +y
    EXPECT_EQ(cube.at(lookup_at({1.0F, 0.0F, 0.0F})), 0.0F);   // +x
    EXPECT_EQ(cube.at(lookup_at({0.0F, 0.0F, 1.0F})), 400.0F); // +z
    cube.sampler.mag_filter = cube.sampler.min_filter = Filter::linear;
    EXPECT_EQ(cube.at(lookup_at({1.0F, 1.0F, 0.0F})), 3.5F); // where +x and +y meet
}

TEST(QuadSamplerParts, ASliceIsReadAndBlendedWithItsNeighbours) {
    WithPart volume({.name = "v", .width = 2, .height = 2, .planes = 4, .shape = SurfaceShape::volume},
                    TextureKind::volume, {0, 1});
    EXPECT_EQ(volume.at(lookup_at({0.5F, 0.5F, 1.5F / 4})), 7.0F);
    EXPECT_EQ(volume.at(lookup_at({0.5F, 0.5F, 2.5F / 4})), 200.0F);
    volume.sampler.mag_filter = volume.sampler.min_filter = Filter::linear;
    EXPECT_EQ(volume.at(lookup_at({0.5F, 0.5F, 0.5F})), 103.5F);
}

} // namespace quad_sampler_parts_test
