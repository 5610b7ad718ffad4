// Cube maps: faces, places on them, what lies beyond their edges.
#include "pipeline/functional/cube_faces.hpp"
#include "tests/support/texture_kit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <utility>

namespace cube_faces_test {

using namespace pipeline;
using tests::all_lanes;
using tests::lookup_at;
using tests::TextureKit;

using Direction = std::array<float, 3>;

/// The direction of a place on a face: table 8.19 of the specification solved for it; s and t in [-1,1].
glm::dvec3 direction_of(std::uint32_t face, double s, double t) {
    switch (face) {
    case 0:
        return {1, -t, -s};
    case 1:
        return {-1, -t, s};
    case 2:
        return {s, 1, t};
    case 3:
        return {s, -1, -t};
    case 4:
        return {s, -t, 1};
    default:
        return {-s, -t, -1};
    }
}
glm::dvec3 centre_of(const CubeTexel& texel, std::int32_t size) {
    const auto at = [&](std::int32_t index) { return (2.0 * index + 1.0) / size - 1.0; };
    return glm::normalize(direction_of(texel.face, at(texel.column), at(texel.row)));
}

TEST(CubeFaces, AxesMeetTheMiddlesOfTheFaces) {
    for (std::uint32_t face = 0; face < 6; ++face) {
        Direction direction{};
        direction[face / 2] = face % 2 == 0 ? 3.0F : -3.0F;
        const CubePlace place = cube_place(direction);
        EXPECT_EQ(place.face, face);
        EXPECT_EQ(place.s, 0.5F);
        EXPECT_EQ(place.t, 0.5F);
    }
}

TEST(CubeFaces, PlacesAreThoseOfTheTable) {
    for (std::uint32_t face = 0; face < 6; ++face)
        for (const double s : {-0.75, 0.0, 0.5})
            for (const double t : {-0.5, 0.25}) {
                const glm::vec3 direction(direction_of(face, s, t) * 7.0);
                const CubePlace place = cube_place({direction.x, direction.y, direction.z});
                EXPECT_EQ(place.face, face);
                EXPECT_FLOAT_EQ(place.s, static_cast<float>((s + 1) / 2));
                EXPECT_FLOAT_EQ(place.t, static_cast<float>((t + 1) / 2));
            }
}

TEST(CubeFaces, EqualComponentsHaveAnOrder) {
    EXPECT_EQ(cube_place({1, 1, 1}).face, 4U);
    EXPECT_EQ(cube_place({1, -1, -1}).face, 5U);
    EXPECT_EQ(cube_place({1, 1, 0}).face, 2U);
    EXPECT_EQ(cube_place({1, -1, 0}).face, 3U);
    EXPECT_EQ(cube_place({0, 1, -1}).face, 5U);
    EXPECT_TRUE(std::isnan(cube_place({0, 0, 0}).s));
    EXPECT_EQ(cube_place({0, 3e38F, -3e38F}).t, 0.0F);
}

TEST(CubeFaces, DerivativesAreThoseOfThePlaces) {
    for (std::uint32_t face = 0; face < 6; ++face) {
        const glm::vec3 middle(direction_of(face, 0.3, -0.4) * 2.0);
        const Direction direction{middle.x, middle.y, middle.z}, change{0.5F, -0.3F, 0.2F};
        constexpr float step = 1.0F / 1024;
        Direction ahead = direction, behind = direction;
        for (std::size_t i = 0; i < 3; ++i) {
            ahead[i] += step * change[i];
            behind[i] -= step * change[i];
        }
        const std::array<double, 2> derivative = cube_derivative(face, direction, change);
        const CubePlace after = cube_place(ahead), before = cube_place(behind);
        EXPECT_NEAR(derivative[0], static_cast<double>(after.s - before.s) / (2 * step), 1e-4);
        EXPECT_NEAR(derivative[1], static_cast<double>(after.t - before.t) / (2 * step), 1e-4);
    }
}

// The neighbour over an edge lies nearer than any other texel of its face, and its neighbour is the first one.
TEST(CubeFaces, NeighboursOverEdgesTouchAndComeBack) {
    for (const std::int32_t size : {1, 2, 5, 8})
        for (std::uint32_t face = 0; face < 6; ++face)
            for (std::int32_t along = 0; along < size; ++along)
                for (const CubeTexel& beyond : {CubeTexel{face, -1, along}, CubeTexel{face, size, along},
                                                CubeTexel{face, along, -1}, CubeTexel{face, along, size}}) {
                    const CubeTexel from{face, std::clamp(beyond.column, 0, size - 1),
                                         std::clamp(beyond.row, 0, size - 1)};
                    const CubeTexel found = beyond_edge(beyond, size);
                    ASSERT_NE(found.face, face);
                    ASSERT_GE(std::min(found.column, found.row), 0);
                    ASSERT_LT(std::max(found.column, found.row), size);
                    const double nearness = glm::dot(centre_of(from, size), centre_of(found, size));
                    for (std::int32_t i = 0; i < size * size; ++i)
                        EXPECT_LE(glm::dot(centre_of(from, size), centre_of({found.face, i % size, i / size}, size)),
                                  nearness + 1e-12);
                    bool back = false;
                    for (const auto& [column, row] :
                         {std::pair{-1, 0}, std::pair{1, 0}, std::pair{0, -1}, std::pair{0, 1}}) {
                        const CubeTexel next{found.face, found.column + column, found.row + row};
                        if (std::min(next.column, next.row) >= 0 && std::max(next.column, next.row) < size) continue;
                        const CubeTexel returned = beyond_edge(next, size);
                        back |=
                            returned.face == from.face && returned.column == from.column && returned.row == from.row;
                    }
                    EXPECT_TRUE(back) << face << ": " << beyond.column << ", " << beyond.row;
                }
}

/// Each face holds its number.
TextureKit numbered_faces(std::uint32_t cubes = 1) {
    TextureKit kit(
        tests::number_surface({.name = "cube", .width = 4, .height = 4, .planes = 6 * cubes},
                              [](auto, std::uint32_t plane, auto, auto) { return static_cast<float>(plane); }),
        TextureKind::cube);
    kit.sampler.mag_filter = Filter::linear;
    kit.sampler.wrap_u = kit.sampler.wrap_v = Wrap::clamp;
    return kit;
}

TEST(CubeTextures, SeamlessFiltersReachOverEdgesAndCorners) {
    TextureKit kit = numbered_faces();
    EXPECT_EQ(kit.at({1, 0, 0}), 0.0F);
    EXPECT_EQ(kit.at({1, 0, 1}), 2.0F);                           // +z and +x
    EXPECT_EQ(kit.at({1, 0, -1}), 2.5F);                          // -z and +x
    EXPECT_FLOAT_EQ(kit.at({1, 1, 1}), (0.0F + 2.0F + 4.0F) / 3); // and at the corner +y
    EXPECT_NEAR(kit.at({1, 0, 0.9999F}), 2.0F, 0.01F);            // the same from the other side
    kit.sampler.seamless = false;
    EXPECT_EQ(kit.at({1, 0, 1}), 4.0F);
    EXPECT_EQ(kit.at({1, 0, -1}), 5.0F);
    kit.sampler.wrap_u = Wrap::border;
    kit.sampler.border.r = 100;
    EXPECT_EQ(kit.at({1, 0, 1}), 52.0F);
}

TEST(CubeTextures, LayersAreSixPlanesEach) {
    TextureKit kit = numbered_faces(3);
    kit.view.arrayed = true;
    EXPECT_EQ(kit.at({0, -1, 0, 1}), 9.0F);
    EXPECT_EQ(kit.at({0, 0, 1, 7}), 16.0F);
    EXPECT_EQ(kit.at({1, 0, 1, 1}), 8.0F); // +z and +x of the second one
}

TEST(CubeTextures, LanesMayMeetDifferentFaces) {
    TextureKit kit = numbered_faces();
    TextureLookup lookup = lookup_at({});
    lookup.place = {{{1, 0, 0, 0.1F}, {0, -1, 0, 0.2F}, {0, 0, 1, -1}, {}}};
    const QuadTexels texels = kit.sample(lookup);
    EXPECT_EQ(texels[0].r, 0.0F);
    EXPECT_EQ(texels[1].r, 3.0F);
    EXPECT_EQ(texels[2].r, 4.0F);
    EXPECT_EQ(texels[3].r, 5.0F);
}

TEST(CubeTextures, LevelsFollowFromWaysOnTheFace) {
    TextureKit kit(
        tests::number_surface({.name = "cube", .width = 8, .height = 8, .planes = 6, .levels = 4},
                              [](std::uint32_t level, auto, auto, auto) { return static_cast<float>(level); }),
        TextureKind::cube);
    kit.sampler.min_filter = Filter::linear_mip_linear;
    TextureLookup lookup;
    lookup.place = {{all_lanes(5), {0, 5, 0, 5}, all_lanes(0), {}}}; // half a face, 4 texels
    EXPECT_EQ(kit.sample(lookup)[0].r, 2.0F);
    lookup.level = LevelOfDetail::gradients;
    lookup.dy[2] = {2.5F, 1.25F, 5, 0}; // the division by the longest component counts
    const QuadTexels texels = kit.sample(lookup);
    EXPECT_EQ(texels[0].r, 1.0F);
    EXPECT_EQ(texels[1].r, 0.0F);
    EXPECT_EQ(texels[2].r, 2.0F);
}

} // namespace cube_faces_test
