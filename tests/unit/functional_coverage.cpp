// Which pixels do triangles cover, and in which order do their quads come?
#include "pipeline/functional/raster_triangle.hpp"
#include "sim/random.hpp"
#include "tests/support/functional_scene.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <set>

namespace pipeline {
namespace {

struct Point {
    std::int32_t x, y; ///< sub-pixel units
};

ScreenVertex at(const Point& point) {
    ScreenVertex vertex;
    vertex.x = point.x;
    vertex.y = point.y;
    return vertex;
}

/// Inside, with pixel centres moved right by an infinitesimal and down by its square: another wording of the top-left
/// rule.
bool covers(const std::array<Point, 3>& corners, std::int64_t px, std::int64_t py) {
    const std::int64_t x = px * 256, y = py * 256;
    const std::int64_t area = (std::int64_t{corners[1].x} - corners[0].x) * (corners[2].y - corners[0].y) -
                              (std::int64_t{corners[2].x} - corners[0].x) * (corners[1].y - corners[0].y);
    const std::int64_t turn = area > 0 ? 1 : -1;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point &a = corners[i], &b = corners[(i + 1) % 3];
        const std::int64_t dx = std::int64_t{b.x} - a.x, dy = std::int64_t{b.y} - a.y;
        const std::int64_t edge = turn * (dx * (y - a.y) - dy * (x - a.x));
        const std::int64_t to_the_right = turn * -dy, down = turn * dx;
        if (!(edge > 0 || (edge == 0 && (to_the_right > 0 || (to_the_right == 0 && down > 0))))) return false;
    }
    return true;
}

struct Walked {
    std::vector<Quad> quads;
    std::uint32_t tiles = 0;
};

Walked walk(const std::array<Point, 3>& corners, const Viewport& viewport) {
    Walked result;
    const RasterTriangle triangle = set_up(at(corners[0]), at(corners[1]), at(corners[2]), viewport);
    result.tiles = for_each_quad(triangle, [&](std::int32_t x, std::int32_t y, unsigned mask) {
        result.quads.push_back(
            {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 0, static_cast<std::uint8_t>(mask), 0, 0});
    });
    return result;
}

bool has_area(const std::array<Point, 3>& corners) {
    return signed_area(at(corners[0]), at(corners[1]), at(corners[2])) != 0;
}

/// The order of fragment_stream.hpp.
bool in_order(const Quad& a, const Quad& b) {
    const auto key = [](const Quad& quad) { return std::array<int, 4>{quad.y / 8, quad.x / 8, quad.y, quad.x}; };
    return key(a) < key(b);
}

std::array<Point, 3> random_triangle(sim::Random& random, std::int32_t width, std::int32_t height) {
    // From slivers and sub-pixel triangles to ones far larger than the screen, often with corners on pixel centres.
    const double reach = std::exp2(12.0 * random.uniform() - 2.0) * 256.0;
    const bool on_centres = random.below(4) == 0;
    std::array<Point, 3> corners;
    const double x = random.uniform() * width * 256.0, y = random.uniform() * height * 256.0;
    for (Point& corner : corners) {
        corner.x = static_cast<std::int32_t>(x + (random.uniform() - 0.5) * reach);
        corner.y = static_cast<std::int32_t>(y + (random.uniform() - 0.5) * reach);
        if (on_centres) corner = {corner.x / 256 * 256, corner.y / 256 * 256};
    }
    if (random.below(8) == 0) corners[2].x = corners[1].x; // a vertical edge
    if (random.below(8) == 0) corners[1].y = corners[0].y; // a horizontal edge
    return corners;
}

RC_GTEST_PROP(Coverage, EqualsTheDefinitionPixelByPixel, (std::uint64_t seed)) {
    sim::Random random(seed, "coverage");
    const auto width = static_cast<std::int32_t>(1 + random.below(70)),
               height = static_cast<std::int32_t>(1 + random.below(70));
    const Viewport viewport(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
    for (int repeat = 0; repeat < 20; ++repeat) {
        const std::array<Point, 3> corners = random_triangle(random, width, height);
        if (!has_area(corners)) continue;
        const Walked walked = walk(corners, viewport);
        std::vector<std::uint32_t> counts(static_cast<std::size_t>(width * height));
        for (const Quad& quad : walked.quads)
            for (std::int32_t lane = 0; lane < 4; ++lane)
                if (((quad.covered >> lane) & 1) != 0)
                    ++counts.at(static_cast<std::size_t>((quad.y + lane / 2) * width + quad.x + lane % 2));
        for (std::int32_t y = 0; y < height; ++y)
            for (std::int32_t x = 0; x < width; ++x)
                RC_ASSERT(counts[static_cast<std::size_t>(y * width + x)] == (covers(corners, x, y) ? 1U : 0U));
    }
}

RC_GTEST_PROP(Coverage, QuadsComeTileByTileRowByRow, (std::uint64_t seed)) {
    sim::Random random(seed, "order");
    const Viewport viewport(200, 120);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const std::array<Point, 3> corners = random_triangle(random, 200, 120);
        if (!has_area(corners)) continue;
        const Walked walked = walk(corners, viewport);
        std::set<std::pair<int, int>> tiles;
        for (std::size_t i = 0; i < walked.quads.size(); ++i) {
            const Quad& quad = walked.quads[i];
            RC_ASSERT(quad.x % 2 == 0 && quad.y % 2 == 0 && quad.covered != 0);
            tiles.emplace(quad.x / 8, quad.y / 8);
            if (i > 0) RC_ASSERT(in_order(walked.quads[i - 1], quad));
        }
        RC_ASSERT(walked.tiles >= std::max<std::size_t>(tiles.size(), 1));
    }
}

/// A mesh of jittered cells that reaches beyond the screen on all sides. Nothing turns over.
tests::MeshData jittered_mesh(sim::Random& random, float width, float height, double cell) {
    tests::MeshData mesh;
    const auto columns = static_cast<std::uint32_t>(static_cast<double>(width) / cell) + 4;
    const auto rows = static_cast<std::uint32_t>(static_cast<double>(height) / cell) + 4;
    const auto jitter = [&] { return (random.uniform() - 0.5) * 0.5; };
    const bool on_grid = random.below(3) == 0; // corners on pixel centres and borders: ties
    for (std::uint32_t row = 0; row <= rows; ++row)
        for (std::uint32_t column = 0; column <= columns; ++column) {
            double x = (column - 2.0 + jitter()) * cell, y = (row - 2.0 + jitter()) * cell;
            if (on_grid && cell >= 4.0) {
                x = std::round(x * 2.0) / 2.0;
                y = std::round(y * 2.0) / 2.0;
            }
            mesh.positions.emplace_back(x, y, 0.5);
        }
    const auto corner = [&](std::uint32_t column, std::uint32_t row) { return row * (columns + 1) + column; };
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = corner(column, row), b = corner(column + 1, row);
            const std::uint32_t c = corner(column, row + 1), d = corner(column + 1, row + 1);
            const bool falling = random.below(2) == 0;
            const std::array<std::uint32_t, 6> cut = falling ? std::array<std::uint32_t, 6>{a, b, d, a, d, c}
                                                             : std::array<std::uint32_t, 6>{a, b, c, c, b, d};
            mesh.indices.insert(mesh.indices.end(), cut.begin(), cut.end());
        }
    return mesh;
}

RC_GTEST_PROP(Coverage, AWatertightMeshCoversEveryPixelOnce, (std::uint64_t seed)) {
    sim::Random random(seed, "mesh");
    tests::FunctionalScene scene(61, 47);
    scene.add(jittered_mesh(random, 61, 47, std::exp2(random.uniform() * 7.0 - 1.0)));
    FrontEndOptions options;
    options.threads = 1;
    const FragmentStream stream = scene.rasterize(options);
    for (const std::uint32_t count : tests::coverage_counts(stream)) RC_ASSERT(count == 1U);
    RC_ASSERT(stream.fragments == 61U * 47U);
}

TEST(Coverage, ThinTrianglesVisitOnlyTheTilesTheyTouch) {
    const Viewport viewport(16384, 16384);
    const Walked walked = walk({{{0, 0}, {16383 * 256, 16380 * 256}, {16383 * 256, 16384 * 256}}}, viewport);
    EXPECT_GE(walked.tiles, 2048U);
    EXPECT_LE(walked.tiles, 3 * 2048U);
    EXPECT_FALSE(walked.quads.empty());
}

TEST(Coverage, BetweenPixelCentresThereIsATileButNoQuad) {
    const Viewport viewport(64, 64);
    const Walked walked = walk({{{10, 10}, {100, 20}, {50, 100}}}, viewport);
    EXPECT_TRUE(walked.quads.empty());
    EXPECT_EQ(walked.tiles, 1U);
}

TEST(Coverage, TheLastPixelOfTheLargestViewport) {
    const Viewport viewport(16384, 16384);
    constexpr std::int32_t last = 16383 * 256;
    const Walked walked = walk({{{last - 100, last - 100}, {last + 128, last - 100}, {last, last + 128}}}, viewport);
    ASSERT_EQ(walked.quads.size(), 1U);
    EXPECT_EQ(walked.quads[0].x, 16382);
    EXPECT_EQ(walked.quads[0].y, 16382);
    EXPECT_EQ(walked.quads[0].covered, 8);
}

TEST(Coverage, EdgeFunctionsOfTheLargestTriangleDoNotOverflow) {
    // Corners at the ends of what clipping and the viewport can leave.
    constexpr auto far = static_cast<std::int32_t>(largest_coordinate);
    const Viewport viewport(16384, 16384);
    const RasterTriangle triangle = set_up(at({-far, far}), at({far, far}), at({far, -far - 256}), viewport);
    std::uint64_t quads = 0, full = 0;
    const std::uint32_t tiles = for_each_quad(triangle, [&](std::int32_t, std::int32_t, unsigned mask) {
        ++quads;
        full += mask == 15U ? 1U : 0U;
    });
    EXPECT_EQ(tiles, 2048U * 2048U);
    EXPECT_EQ(quads, 8192U * 8192U);
    EXPECT_EQ(full, quads);
}

} // namespace
} // namespace pipeline
