// Which pixels points and lines cover, against the definitions of the specification, and what lies over them.
#include "pipeline/functional/points_lines.hpp"
#include "sim/random.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace functional_points_lines_test {
namespace {

using namespace pipeline;

using tests::FunctionalScene;
using tests::MeshData;

__extension__ using Wide = __int128;
using Pixels = std::set<std::pair<int, int>>;

ScreenVertex at(std::int32_t x, std::int32_t y) {
    ScreenVertex vertex;
    vertex.x = x;
    vertex.y = y;
    vertex.clip.w = 1.0F;
    vertex.window = glm::vec2(x, y) / 256.0F;
    return vertex;
}

Pixels pixels_of(const CoveredQuads& covered) {
    Pixels pixels;
    for (const CoveredQuad& quad : covered.quads)
        for (int lane = 0; lane < 4; ++lane)
            if ((quad.mask >> lane & 1U) != 0) {
                EXPECT_TRUE(pixels.emplace(quad.x + lane % 2, quad.y + lane / 2).second) << "twice";
            }
    return pixels;
}

Pixels point(double x, double y, float size) {
    const ScreenVertex centre = at(static_cast<std::int32_t>(x * 256), static_cast<std::int32_t>(y * 256));
    return pixels_of(
        quads_of_rectangle(PointSquare::pixels(PointSquare(centre, size).corners(centre)), {0, 0, 32, 32}));
}

// Here pixel centres have whole coordinates.
TEST(PointRule, SquaresOwnTheirLeftAndTopBorders) {
    EXPECT_EQ(point(5, 7, 1), (Pixels{{5, 7}}));
    EXPECT_EQ(point(5.49, 7.49, 1), (Pixels{{5, 7}}));
    EXPECT_EQ(point(5.5, 7, 1), (Pixels{{5, 7}})); // [5, 6): the left border goes through a centre
    EXPECT_EQ(point(5.51, 7, 1), (Pixels{{6, 7}}));
    EXPECT_EQ(point(5, 7, 2), (Pixels{{4, 6}, {5, 6}, {4, 7}, {5, 7}}));
    EXPECT_EQ(point(5.5, 7.5, 2), (Pixels{{5, 7}, {6, 7}, {5, 8}, {6, 8}}));
    EXPECT_EQ(point(5, 7, 3).size(), 9U);
    EXPECT_EQ(point(5, 7, 1.5F), (Pixels{{5, 7}}));
    EXPECT_EQ(point(5.25, 7, 1.5F), (Pixels{{5, 7}}));         // [4.5, 6)
    EXPECT_EQ(point(5.26, 7, 1.5F), (Pixels{{5, 7}, {6, 7}})); // [4.51, 6.01)
    EXPECT_EQ(point(5, 7, 0.01F), (Pixels{{5, 7}}));           // 1 pixel at least
    EXPECT_EQ(point(0, 0, 5), point(0, 0, 5.2F));              // cut by the screen
    EXPECT_EQ(point(0, 0, 5).size(), 9U);
    EXPECT_EQ(point(-3, 0, 5).size(), 0U);
}

TEST(PointRule, QuadsComeInOrderAndTilesAreCounted) {
    const CoveredQuads covered = quads_of_rectangle({5, 5, 20, 11}, {0, 0, 32, 32});
    EXPECT_EQ(covered.tiles, 6U);
    for (std::size_t i = 1; i < covered.quads.size(); ++i) {
        const auto key = [&](const CoveredQuad& q) { return std::array{q.y / 8, q.x / 8, q.y, q.x}; };
        EXPECT_LT(key(covered.quads[i - 1]), key(covered.quads[i]));
    }
}

/// OpenGL 4.5, section 14.5.1, word for word: a fragment for every pixel whose diamond the line meets and does not end
/// in, both ends moved by -(e, e^2). Coordinates grow by 2^24, e is 2^12 of these.
struct DiamondRule {
    std::int64_t ax, ay, bx, by;

    DiamondRule(const ScreenVertex& a, const ScreenVertex& b)
        : ax(scaled(a.x) - 4096), ay(scaled(a.y) - 1), bx(scaled(b.x) - 4096), by(scaled(b.y) - 1) {}

    static std::int64_t scaled(std::int64_t subpixels) { return subpixels << 24; }

    bool produces(int px, int py) const {
        const std::int64_t x = scaled(256) * px, y = scaled(256) * py;
        // The part of the line, from low to high, on the inner side of all four borders; fractions.
        Wide low = 0, low_of = 1, high = 1, high_of = 1;
        bool ends_inside = true;
        for (const int sx : {-1, 1})
            for (const int sy : {-1, 1}) {
                const std::int64_t a = sx * (ax - x) + sy * (ay - y) - scaled(128);
                const std::int64_t b = sx * (bx - x) + sy * (by - y) - scaled(128);
                ends_inside &= b < 0;
                if (a >= 0 && b >= 0) return false;
                if (a < 0 && b < 0) continue;
                const Wide of = a >= 0 ? Wide{a} - b : Wide{b} - a, place = a >= 0 ? Wide{a} : -Wide{a};
                if (a >= 0 && place * low_of > low * of) low = place, low_of = of;
                if (a < 0 && place * high_of < high * of) high = place, high_of = of;
            }
        return !ends_inside && low * high_of < high * low_of;
    }
};

Pixels by_the_rule(const ScreenVertex& a, const ScreenVertex& b) {
    const DiamondRule rule(a, b);
    Pixels pixels;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x)
            if (rule.produces(x, y)) pixels.emplace(x, y);
    return pixels;
}

TEST(LineRule, IsTheDiamondExitRule) {
    sim::Random random(3, "lines");
    for (const std::uint64_t grid : {1U, 32U, 64U, 128U, 256U})
        for (int i = 0; i < 3000; ++i) {
            const auto place = [&] { return static_cast<std::int32_t>(random.below(24 * 256 / grid) * grid); };
            const ScreenVertex a = at(place(), place());
            ScreenVertex b = at(place(), place());
            if (i % 4 == 0) b = at(a.x + static_cast<std::int32_t>(random.below(5) * grid), b.y); // short or steep
            if (i % 4 == 1) b = at(a.x + (b.y - a.y), b.y);                                       // diagonal
            ASSERT_EQ(pixels_of(quads_of_line(RasterLine(a, b, 1), {0, 0, 24, 24})), by_the_rule(a, b))
                << a.x << ", " << a.y << " to " << b.x << ", " << b.y;
        }
}

TEST(LineRule, StripsCoverNoPixelTwiceWhereTheyMeet) {
    const ScreenVertex a = at(512, 512), b = at(2560, 1024), c = at(5120, 1500);
    const auto drawn = [](const ScreenVertex& from, const ScreenVertex& to) {
        return pixels_of(quads_of_line(RasterLine(from, to, 1), {0, 0, 24, 24}));
    };
    Pixels both = drawn(a, b);
    for (const auto& pixel : drawn(b, c)) EXPECT_TRUE(both.insert(pixel).second);
    EXPECT_EQ(both.size(), 18U);
    EXPECT_TRUE(both.contains({2, 2}));
    EXPECT_FALSE(both.contains({20, 6})); // the last end lies in its diamond
}

// The middle of an odd width lies where the thin line does; an even one begins a pixel before what lies in the middle.
TEST(LineRule, WideLinesRepeatPixelsAcross) {
    sim::Random random(4, "wide lines");
    for (int i = 0; i < 2000; ++i) {
        const auto place = [&] { return static_cast<std::int32_t>(2048 + random.below(2048)); };
        const ScreenVertex a = at(place(), place()), b = at(place(), place());
        for (const int width : {2, 3, 6}) {
            const bool along_x = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
            const std::int32_t moved = 128 * (width - 1);
            const auto shifted = [&](const ScreenVertex& v) {
                return along_x ? at(v.x, v.y - moved) : at(v.x - moved, v.y);
            };
            Pixels expected;
            for (const auto& [x, y] : by_the_rule(shifted(a), shifted(b)))
                for (int k = 0; k < width; ++k) expected.emplace(along_x ? x : x + k, along_x ? y + k : y);
            const auto wide = static_cast<float>(width);
            ASSERT_EQ(pixels_of(quads_of_line(RasterLine(a, b, wide + 0.4F), {0, 0, 24, 24})), expected);
        }
    }
}

TEST(LineRule, LinesOfNoLengthAreNothing) {
    EXPECT_TRUE(quads_of_line(RasterLine(at(512, 512), at(512, 512), 3), {0, 0, 24, 24}).quads.empty());
    EXPECT_TRUE(quads_of_line(RasterLine(at(512, 512), at(520, 512), 1), {0, 0, 24, 24}).quads.empty()); // one diamond
}

FunctionalScene scene_of(Topology topology, const std::vector<glm::vec3>& positions) {
    FunctionalScene scene(32, 32);
    MeshData mesh;
    mesh.positions = positions;
    for (std::size_t i = 0; i < positions.size(); ++i)
        mesh.colours.emplace_back(static_cast<float>(i) / 8, 1.0F, 0.0F, 1.0F);
    scene.add(mesh);
    scene.resources.geometries[0].topology = topology;
    return scene;
}

FragmentStream rasterize(FunctionalScene& scene, const RasterState& state) {
    FrontEndOptions options;
    options.states = {&state, 1};
    return scene.rasterize(options);
}

TEST(Points, AreCulledByTheirCentres) {
    const float infinity = std::numeric_limits<float>::infinity();
    FunctionalScene scene = scene_of(
        Topology::points,
        {{4, 4, 0.5F}, {-0.25F, 4, 0.5F}, {31.9F, 31.9F, 0.5F}, {8, 8, 1.5F}, {infinity, 0, 0.5F}, {20, 8, 0.25F}});
    RasterState state;
    state.point_size = 4;
    state.culling = FaceCulling::both; // points have no face
    state.clip_planes = 1;
    state.clip_plane[0] = {0, 0, 1, -0.375F}; // cuts the last one
    const FragmentStream stream = rasterize(scene, state);
    std::vector<PrimitiveFate> fates;
    for (const Primitive& primitive : stream.primitives) fates.push_back(primitive.fate);
    EXPECT_EQ(fates, (std::vector{PrimitiveFate::drawn, PrimitiveFate::culled_outside, PrimitiveFate::drawn,
                                  PrimitiveFate::culled_outside, PrimitiveFate::culled_degenerate,
                                  PrimitiveFate::culled_outside}));
    EXPECT_EQ(stream.triangles.size(), 2U);
    EXPECT_EQ(stream.fragments, 16U + 4U);
}

TEST(Points, ReachBeyondTheViewportButNotTheScissor) {
    FunctionalScene scene = scene_of(Topology::points, {{16, 16, 0.5F}});
    RasterState state;
    state.viewport = PixelRectangle{10, 10, 2, 2};
    state.point_size = 8;
    EXPECT_EQ(rasterize(scene, state).fragments, 64U); // around (11, 11)
    state.scissor = PixelRectangle{0, 0, 11, 32};
    EXPECT_EQ(rasterize(scene, state).fragments, 32U);
}

TEST(Points, HaveOneDepthAndColourAndSpriteCoordinates) {
    FunctionalScene scene = scene_of(Topology::points, {{8, 8, 0.25F}, {20, 20, 0.75F}});
    scene.resources.materials[0].base_texture = static_cast<std::int32_t>(
        scene.add_texture(tests::texture_of(2, 2, {0xFF0000FF, 0x00FF00FF, 0x0000FFFF, 0xFFFFFFFF})));
    Texture& texture = scene.resources.textures[0];
    texture.srgb = false;
    texture.min_filter = texture.mag_filter = Filter::nearest;
    RasterState state;
    state.point_size = 4;
    state.depth.bias_constant = 1e6F; // of polygons only
    state.point_sprites = true;
    const FragmentStream stream = rasterize(scene, state);
    ASSERT_EQ(stream.fragments, 32U);
    for (std::size_t i = 0; i < stream.quads.size(); ++i) {
        const bool second = stream.triangles[stream.quads[i].triangle].primitive == 1;
        const int left = second ? 18 : 6;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            EXPECT_EQ(stream.depths[i][lane], second ? 0.75F : 0.25F);
            const bool right_half = stream.quads[i].x + static_cast<int>(lane % 2) >= left + 2;
            const bool lower_half = stream.quads[i].y + static_cast<int>(lane / 2) >= left + 2;
            // red is texel's red * vertex's red; green the texel's.
            EXPECT_EQ(stream.colours[i][lane].r, second && right_half == lower_half ? 0.125F : 0.0F);
            EXPECT_EQ(stream.colours[i][lane].g, right_half ? 1.0F : 0.0F);
        }
    }
}

TEST(Lines, InterpolateFromEndToEnd) {
    FunctionalScene scene = scene_of(Topology::lines, {{0.5F, 4.5F, 0.0F}, {16.5F, 4.5F, 1.0F}});
    RasterState state;
    state.line_width = 3;
    const FragmentStream stream = rasterize(scene, state);
    EXPECT_EQ(stream.fragments, 48U);
    for (std::size_t i = 0; i < stream.quads.size(); ++i)
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if ((stream.quads[i].covered >> lane & 1) == 0) continue;
            const auto column = static_cast<float>(stream.quads[i].x + lane % 2);
            EXPECT_EQ(stream.depths[i][lane], column / 16);
            EXPECT_EQ(stream.colours[i][lane].r, column / 128);
        }
}

TEST(Lines, AreClippedAtPlanesAndDrawnInTheViewport) {
    // Depth from -1 to 2 over 24 pixels: the middle third is left; its colours are those of its own part.
    FunctionalScene scene = scene_of(Topology::lines, {{4.5F, 4.5F, -1.0F}, {28.5F, 4.5F, 2.0F}});
    const FragmentStream stream = rasterize(scene, {});
    EXPECT_TRUE(stream.primitives[0].clipped);
    EXPECT_EQ(stream.fragments, 8U);
    for (std::size_t i = 0; i < stream.quads.size(); ++i)
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if ((stream.quads[i].covered >> lane & 1) == 0) continue;
            const auto column = static_cast<float>(stream.quads[i].x + lane % 2);
            EXPECT_NEAR(stream.depths[i][lane], (column - 12) / 8, 1e-6);
            EXPECT_NEAR(stream.colours[i][lane].r, (column - 4) / 24 / 8, 1e-6);
        }
    FunctionalScene beyond = scene_of(Topology::line_strip, {{-100, 4.5F, 0.5F}, {200, 4.5F, 0.5F}, {200, 90, 0.5F}});
    const FragmentStream across = rasterize(beyond, {});
    EXPECT_EQ(across.fragments, 32U); // every pixel of the row, the last one too
    EXPECT_EQ(across.primitives[1].fate, PrimitiveFate::culled_outside);
}

TEST(Lines, LoopsEndWhereTheyBegin) {
    FunctionalScene scene = scene_of(
        Topology::line_loop, {{4.5F, 4.5F, 0.5F}, {12.5F, 4.5F, 0.5F}, {12.5F, 12.5F, 0.5F}, {4.5F, 12.5F, 0.5F}});
    const FragmentStream stream = rasterize(scene, {});
    EXPECT_EQ(stream.primitives.size(), 4U);
    EXPECT_EQ(stream.fragments, 32U);
    for (const std::uint32_t count : tests::coverage_counts(stream)) EXPECT_LE(count, 1U);
}

TEST(PointsAndLines, CoverAllSamplesOfAPixel) {
    FunctionalScene scene = scene_of(Topology::line_strip, {{0.5F, 4.5F, 0.5F}, {16.5F, 4.5F, 0.5F}});
    scene.view.samples = 4;
    const FragmentStream stream = rasterize(scene, {});
    EXPECT_EQ(stream.groups, 8U);
    EXPECT_EQ(stream.fragments, 64U);
}

} // namespace
} // namespace functional_points_lines_test
