// Needles, slivers, sub-pixel triangles, clip planes, the eye, the guard band, and coordinates of any size.
#include "pipeline/functional/cull_and_clip.hpp"
#include "pipeline/functional/interpolation.hpp"
#include "pipeline/functional/raster_triangle.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "reports/stability/scenes.hpp"

#include <fmt/format.h>

namespace reports::stability::rasterization {

using pipeline::PrimitiveFate;
using pipeline::ScreenVertex;

constexpr float unit = 1.0F / 256.0F; ///< of the sub-pixel grid

pipeline::FragmentStream drawn(const std::vector<ScreenTriangle>& triangles, std::uint32_t width = 64,
                               std::uint32_t height = 64) {
    traces::Scene scene = screen_scene(triangles);
    return rasterized(scene, pixel_view(width, height));
}

/// Pixel centres inside a triangle whose corners are on the sub-pixel grid, by integers: moved right by an
/// infinitesimal and down by its square, which is another wording of the top-left rule.
std::uint64_t centres_inside(const std::array<glm::vec2, 3>& corners, std::int64_t width, std::int64_t height) {
    std::array<std::array<std::int64_t, 2>, 3> at{};
    for (std::size_t i = 0; i < 3; ++i)
        at[i] = {std::llround(static_cast<double>(corners[i].x) * 256.0) - 128,
                 std::llround(static_cast<double>(corners[i].y) * 256.0) - 128};
    const std::int64_t area =
        (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[2][0] - at[0][0]) * (at[1][1] - at[0][1]);
    const std::int64_t turn = area > 0 ? 1 : -1;
    std::uint64_t inside = 0;
    for (std::int64_t py = 0; py < height; ++py)
        for (std::int64_t px = 0; px < width; ++px) {
            bool in = area != 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const auto &a = at[i], &b = at[(i + 1) % 3];
                const std::int64_t dx = b[0] - a[0], dy = b[1] - a[1];
                const std::int64_t edge = turn * (dx * (py * 256 - a[1]) - dy * (px * 256 - a[0]));
                const std::int64_t right = turn * -dy, down = turn * dx;
                in = in && (edge > 0 || (edge == 0 && (right > 0 || (right == 0 && down > 0))));
            }
            inside += in ? 1 : 0;
        }
    return inside;
}

void equals_integers(Finding& finding, const std::array<glm::vec2, 3>& corners) {
    const pipeline::FragmentStream stream = drawn({{{corners[0], 0.25F}, {corners[1], 0.5F}, {corners[2], 0.75F}}});
    finding.error(static_cast<double>(stream.fragments) - static_cast<double>(centres_inside(corners, 64, 64)));
    finding.require(all_finite(stream), "depths in [0,1], finite colours");
}

void add_thin(std::vector<Case>& cases) {
    cases.push_back({"rasterization.sliver-below", Side::below,
                     "three corners on one line of the sub-pixel grid: no area", "culled as degenerate, no fragment",
                     "fragments", 0.0, [](Finding& finding) {
                         const auto stream = drawn({{{1, 1, 0.5F}, {21, 11, 0.5F}, {41, 21, 0.5F}}});
                         finding.error(static_cast<double>(stream.fragments));
                         finding.require(stream.primitives[0].fate == PrimitiveFate::culled_degenerate, "degenerate");
                     }});
    cases.push_back(
        {"rasterization.sliver-at", Side::at, "the least area there is: one corner a sub-pixel off the line",
         "the fragments of exact integers; depths within the corners'", "fragments", 0.0, [](Finding& finding) {
             equals_integers(finding, {{{0.5F, 0.5F}, {60.5F, 60.5F}, {60.5F, 60.5F + unit}}});
             equals_integers(finding, {{{0.5F, 0.5F}, {60.5F, 60.5F}, {60.5F + unit, 60.5F}}});
             equals_integers(finding, {{{3.5F + unit, 2.5F}, {3.5F, 62.5F}, {3.5F, 2.5F}}});
         }});
    cases.push_back({"rasterization.sliver-above", Side::above,
                     "needles two and seven sub-pixels wide over the whole picture, all directions",
                     "the fragments of exact integers", "fragments", 0.0, [](Finding& finding) {
                         for (int i = 0; i < 48; ++i) {
                             const float x = std::round(63.0F * 256.0F * static_cast<float>(i) / 48.0F) * unit;
                             for (const float wide : {2.0F * unit, 7.0F * unit}) {
                                 equals_integers(finding, {{{31.5F, 31.5F}, {x, 0.0F}, {x + wide, 0.0F}}});
                                 equals_integers(finding, {{{31.5F, 31.5F}, {64.0F, x + wide}, {64.0F, x}}});
                             }
                         }
                     }});
    cases.push_back({"rasterization.needle-depth", Side::whole,
                     "needles from depth 0.25 to 0.75 whose plane has slopes of thousands per pixel",
                     "all depths within the range of the corners", "", 0.0, [](Finding& finding) {
                         for (int i = 0; i < 64; ++i) {
                             const float x = static_cast<float>(i) + 0.5F; // through pixel centres
                             const auto stream = drawn({{{x - unit, 0, 0.25F}, {x, 64, 0.75F}, {x + unit, 64, 0.5F}},
                                                        {{0, x, 0.75F}, {64, x + unit, 0.25F}, {64, x, 0.5F}}});
                             finding.require(stream.fragments > 10, "centres are covered");
                             for (const auto& depths : stream.depths)
                                 for (const float depth : depths)
                                     finding.require(depth >= 0.25F && depth <= 0.75F, "within the corners");
                         }
                         finding.show(
                             coverage_picture(drawn({{{31.5F, 31.5F, 0.0F}, {64, 20, 1.0F}, {64, 20.2F, 0.5F}},
                                                     {{31.5F, 31.5F, 0.0F}, {10, 0, 1.0F}, {10.3F, 0, 0.5F}}})));
                     }});
}

void add_sub_pixel(std::vector<Case>& cases) {
    // A triangle of 2x2 sub-pixels, moved over a pixel's centre in steps of one.
    const auto moved = [](float dx, float dy) {
        const float x = 10.5F + dx * unit, y = 10.5F + dy * unit;
        return std::array<glm::vec2, 3>{{{x, y}, {x, y + 2 * unit}, {x + 2 * unit, y}}};
    };
    cases.push_back({"rasterization.sub-pixel-below", Side::below,
                     "a triangle of 2 sub-pixels, a sub-pixel right of or below a pixel's centre",
                     "no fragment; a tile is visited", "fragments", 0.0, [moved](Finding& finding) {
                         for (const auto& corners : {moved(1, 0), moved(0, 1), moved(1, 1)}) {
                             const auto stream = drawn({{{corners[0], 0.5F}, {corners[1], 0.5F}, {corners[2], 0.5F}}});
                             finding.error(static_cast<double>(stream.fragments));
                             finding.error(static_cast<double>(stream.triangles.at(0).tiles) - 1.0);
                         }
                     }});
    cases.push_back({"rasterization.sub-pixel-at", Side::at,
                     "a triangle of 2 sub-pixels with its corner, left edge or top edge on a pixel's centre",
                     "one fragment: left and top edges own their points", "fragments", 0.0, [moved](Finding& finding) {
                         for (const auto& corners : {moved(0, 0), moved(0, -1), moved(-1, 0)}) {
                             const auto stream = drawn({{{corners[0], 0.5F}, {corners[1], 0.5F}, {corners[2], 0.5F}}});
                             finding.error(static_cast<double>(stream.fragments) - 1.0);
                         }
                     }});
    cases.push_back({"rasterization.sub-pixel-above", Side::above,
                     "a triangle of 2 sub-pixels with its right-hand edge or corners on a pixel's centre",
                     "no fragment: the neighbour's", "fragments", 0.0, [moved](Finding& finding) {
                         for (const auto& corners : {moved(-1, -1), moved(-2, 0), moved(0, -2)}) {
                             const auto stream = drawn({{{corners[0], 0.5F}, {corners[1], 0.5F}, {corners[2], 0.5F}}});
                             finding.error(static_cast<double>(stream.fragments));
                         }
                     }});
    cases.push_back(
        {"rasterization.sub-pixel-mesh", Side::whole,
         "a watertight mesh of 20,000 triangles smaller than a pixel, over all 64x64 pixels", "every pixel once",
         "fragments", 0.0, [](Finding& finding) {
             std::vector<ScreenTriangle> triangles;
             constexpr int cells = 100;
             const auto at = [](int column, int row) { // corners on no grid
                 return glm::vec3(
                     -0.7F + 0.6571F * static_cast<float>(column) + 0.1F * std::sin(7.0F * static_cast<float>(row)),
                     -0.7F + 0.6613F * static_cast<float>(row) + 0.1F * std::cos(5.0F * static_cast<float>(column)),
                     0.5F);
             };
             for (int row = 0; row < cells; ++row)
                 for (int column = 0; column < cells; ++column) {
                     triangles.push_back({at(column, row), at(column, row + 1), at(column + 1, row)});
                     triangles.push_back({at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)});
                 }
             const auto stream = drawn(triangles);
             for (const std::uint32_t count : coverage(stream)) finding.error(static_cast<double>(count) - 1.0);
             finding.show(coverage_picture(stream));
         }});
}

/// Plane y = -1 under an eye at the origin, from z = `nearest` to -100; rows of the picture that it has to cover.
pipeline::FragmentStream ground(float nearest, double near = 0.1) {
    traces::Scene scene = world_scene({{-500, -1, nearest},
                                       {500, -1, nearest},
                                       {-500, -1, -100},
                                       {-500, -1, -100},
                                       {500, -1, nearest},
                                       {500, -1, -100}});
    return rasterized(scene, perspective_view(64, 64, 90.0, near, 1000.0));
}

void add_clip_planes(std::vector<Case>& cases) {
    // At 90 degrees the ray of row y goes down by (y + 0.5 - 32) / 32 per unit of distance.
    const auto rows = [](Finding& finding, const pipeline::FragmentStream& stream, double nearest) {
        const auto counts = coverage(stream);
        for (std::uint32_t y = 0; y < 64; ++y) {
            const double down = (y + 0.5 - 32.0) / 32.0, distance = down > 0 ? 1.0 / down : -1.0;
            if (std::fabs(distance - nearest) < 0.05 || std::fabs(distance - 100.0) < 40.0) continue;
            const double expected = distance > nearest && distance < 100.0 ? 1.0 : 0.0;
            for (std::uint32_t x = 0; x < 64; ++x) finding.error(counts[y * 64 + x] - expected);
        }
        finding.require(all_finite(stream), "depths in [0,1]");
    };
    cases.push_back({"rasterization.near-plane-below", Side::below, "ground that begins behind the near plane",
                     "covered as far as the eye sees it, not clipped", "fragments", 0.0, [rows](Finding& finding) {
                         const auto stream = ground(-1.5F);
                         rows(finding, stream, 1.5);
                         finding.require(!stream.primitives[0].clipped, "not clipped");
                     }});
    cases.push_back({"rasterization.near-plane-at", Side::at,
                     "a triangle with a corner exactly on the near plane: z = -w", "inside, at depth 0", "ulp", 0.0,
                     [](Finding& finding) {
                         const pipeline::Viewport viewport(64, 64);
                         ScreenVertex vertex;
                         vertex.clip = {0.25F, 0.25F, -1.0F, 1.0F};
                         vertex.outside = viewport.outcode(vertex.clip);
                         finding.require((vertex.outside & pipeline::outside::near) == 0, "not outside");
                         viewport.project(vertex);
                         finding.error(ulps(vertex.depth, 0.0F));
                         vertex.clip.z = next_down(-1.0F);
                         finding.require((viewport.outcode(vertex.clip) & pipeline::outside::near) != 0,
                                         "the next float is outside");
                     }});
    cases.push_back({"rasterization.near-plane-above", Side::above,
                     "ground from 10 in front of the eye to 10 behind it", "cut at the near plane, watertight",
                     "fragments", 0.0, [rows](Finding& finding) {
                         const auto stream = ground(10.0F, 1.1);
                         rows(finding, stream, 1.1);
                         finding.require(stream.primitives[0].clipped, "clipped");
                         finding.show(coverage_picture(stream));
                     }});
    cases.push_back({"rasterization.near-plane-behind", Side::above, "a triangle wholly behind the eye", "nothing",
                     "fragments", 0.0, [](Finding& finding) {
                         traces::Scene scene = world_scene({{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}});
                         finding.error(
                             static_cast<double>(rasterized(scene, perspective_view(64, 64, 90, 0.1, 100)).fragments));
                     }});
    cases.push_back({"rasterization.far-plane", Side::whole, "a wall from depth -1 to 2: both planes cut it",
                     "a third of the rows, depths from 0 to 1", "fragments", 0.0, [](Finding& finding) {
                         const auto stream =
                             drawn({{{0, 0, -1}, {0, 192, 2}, {64, 0, -1}}, {{64, 0, -1}, {0, 192, 2}, {64, 192, 2}}},
                                   64, 192);
                         finding.error(static_cast<double>(stream.fragments) - 64.0 * 64.0);
                         finding.error(most_covered(stream) - 1.0);
                         finding.require(all_finite(stream), "depths in [0,1]");
                     }});
    cases.push_back({"rasterization.through-eye", Side::at, "a triangle with a corner in the eye itself: w = 0",
                     "finite depths and colours, each pixel at most once", "fragments", 0.0, [](Finding& finding) {
                         // In the plane of the eye a corner lies far aside and is clipped; in the eye itself it is
                         // inside of all planes, and w = 0 goes on to the division.
                         for (const auto& [aside, w] : std::array<std::array<float, 2>, 7>{
                                  {{1, 0}, {1, 1e-40F}, {1, 1e-30F}, {1, 1e-6F}, {0, 0}, {0, 1e-40F}, {0, 1e-6F}}}) {
                             traces::Scene scene = world_scene({{-aside, -aside, -w}, {1, -1, -1}, {0, 1, -1}});
                             pipeline::View view = pixel_view(64, 64);
                             view.projection = glm::mat4(0.0F);
                             view.projection[0][0] = view.projection[1][1] = 1.0F;
                             view.projection[2][3] = -1.0F; // w = -z; z = 0: the near plane lies in the eye
                             const auto stream = rasterized(scene, view);
                             finding.require(all_finite(stream), "finite");
                             finding.error(std::max(most_covered(stream), 1U) - 1.0);
                         }
                     }});
}

/// A triangle that covers the screen, with one corner `pixels` right of its middle: fragments, and whether it was cut.
void guard_band(Finding& finding, float pixels, bool clipped) {
    const auto stream = drawn({{{-200, -1000, 0.5F}, {-200, 1000, 0.5F}, {32.0F + pixels, 32, 0.5F}}});
    finding.require(stream.primitives[0].clipped == clipped, clipped ? "clipped" : "not clipped");
    finding.error(static_cast<double>(stream.fragments) - 4096.0);
}

void add_guard_band(std::vector<Case>& cases) {
    // 24576 = 768 * 32 pixels: in units of w the band is exact for a viewport of 64.
    cases.push_back({"rasterization.guard-band-below", Side::below, "a corner 24,570 pixels from the middle",
                     "not clipped; 64x64 pixels", "fragments", 0.0,
                     [](Finding& finding) { guard_band(finding, 24570.0F, false); }});
    cases.push_back(
        {"rasterization.guard-band-at", Side::at, "a vertex exactly on the guard band: x = 768 w",
         "inside; one float farther is outside", "", 0.0, [](Finding& finding) {
             const pipeline::Viewport viewport(64, 64);
             for (const float w : {1e-20F, 1.0F, 3e30F}) {
                 const float x = 768.0F * w;
                 finding.require((viewport.outcode({x, 0, 0, w}) & pipeline::outside::must_clip) == 0, "at");
                 finding.require((viewport.outcode({next_up(x), 0, 0, w}) & pipeline::outside::guard_right) != 0,
                                 "right");
                 finding.require((viewport.outcode({-next_up(x), 0, 0, w}) & pipeline::outside::guard_left) != 0,
                                 "left");
                 finding.require((viewport.outcode({0, next_up(x), 0, w}) & pipeline::outside::guard_top) != 0, "top");
                 finding.require((viewport.outcode({0, -next_up(x), 0, w}) & pipeline::outside::guard_bottom) != 0,
                                 "bottom");
             }
         }});
    cases.push_back({"rasterization.guard-band-above", Side::above, "corners 30,000 to 1e9 pixels from the middle",
                     "clipped; 64x64 pixels", "fragments", 0.0, [](Finding& finding) {
                         for (const float pixels : {24600.0F, 30000.0F, 1e6F, 1e9F}) guard_band(finding, pixels, true);
                     }});
    cases.push_back({"rasterization.edge-functions", Side::at,
                     "the largest triangle that clipping can leave, on 16384x16384: edge values near 2^53",
                     "every quad of a column of tiles is full", "quads", 0.0, [](Finding& finding) {
                         constexpr auto far = static_cast<std::int32_t>(pipeline::largest_coordinate);
                         const auto at = [](std::int32_t x, std::int32_t y) {
                             ScreenVertex vertex;
                             vertex.x = x;
                             vertex.y = y;
                             return vertex;
                         };
                         const pipeline::Viewport strip(16, 16384);
                         const auto triangle =
                             pipeline::set_up(at(-far, far), at(far, far), at(far, -far - 256), strip);
                         const Quad exact = Quad(2 * far) * Quad(2 * far + 256);
                         finding.require(Quad(triangle.area) == exact, "the area is exact");
                         double full = 0;
                         pipeline::for_each_quad(
                             triangle, [&](std::int32_t, std::int32_t, unsigned mask) { full += mask == 15U ? 1 : 0; });
                         finding.error(full - 8.0 * 8192.0);
                     }});
}

/// A rectangle over the whole screen, made by positions times `scale` under a matrix that undoes it.
void scaled(Finding& finding, float scale, double expected) {
    traces::Scene scene = world_scene({{0, 0, 0},
                                       {0, 64 * scale, 0},
                                       {64 * scale, 0, 0},
                                       {64 * scale, 0, 0},
                                       {0, 64 * scale, 0},
                                       {64 * scale, 64 * scale, 0}});
    glm::mat4 undo(1.0F);
    undo[0][0] = undo[1][1] = 1.0F / scale;
    undo[3][2] = 0.5F;
    scene.draws[0].instances[0] = undo;
    const auto stream = rasterized(scene, pixel_view(64, 64));
    finding.error(static_cast<double>(stream.fragments) - expected);
    finding.require(all_finite(stream), "finite");
}

void add_coordinates(std::vector<Case>& cases) {
    cases.push_back({"coordinates.tiny", Side::below, "positions of 1e-30 under a matrix of 1e30", "64x64 pixels once",
                     "fragments", 0.0, [](Finding& finding) { scaled(finding, 0x1p-100F, 4096.0); }});
    cases.push_back({"coordinates.smallest", Side::below, "positions of 1e-30 and 1e-45 as they are, before a camera",
                     "no area on the grid: degenerate, no fragment", "fragments", 0.0, [](Finding& finding) {
                         for (const float size : {1e-30F, smallest_float}) {
                             traces::Scene scene = world_scene({{0, 0, -1}, {size, 0, -1}, {0, size, -1}});
                             const auto stream = rasterized(scene, perspective_view(64, 64, 60, 0.1, 10));
                             finding.error(static_cast<double>(stream.fragments));
                             finding.require(stream.primitives[0].fate == PrimitiveFate::culled_degenerate,
                                             "degenerate");
                         }
                     }});
    cases.push_back({"coordinates.huge", Side::at, "positions of 1e30 under a matrix of 1e-30", "64x64 pixels once",
                     "fragments", 0.0, [](Finding& finding) { scaled(finding, 0x1p100F, 4096.0); }});
    cases.push_back({"coordinates.huge-clipped", Side::at, "a rectangle out to 1e5, 1e12 and 1e30 pixels on all sides",
                     "64x64 pixels once", "fragments", 0.0, [](Finding& finding) {
                         for (const float reach : {1e5F, 1e12F, 1e30F}) {
                             const auto both = rectangle(-reach, -reach, reach, reach, 0.5F);
                             const auto stream = drawn({both[0], both[1]});
                             for (const std::uint32_t count : coverage(stream)) finding.error(count - 1.0);
                         }
                     }});
    cases.push_back({"coordinates.overflow", Side::above, "positions near 3e38 that overflow under the matrix",
                     "culled as degenerate, nothing leaves the stage", "fragments", 0.0, [](Finding& finding) {
                         traces::Scene scene = world_scene({{0, 0, 0.5F}, {3e38F, 0, 0.5F}, {0, 64, 0.5F}});
                         glm::mat4 larger(1.0F);
                         larger[0][0] = 100.0F;
                         scene.draws[0].instances[0] = larger;
                         const auto stream = rasterized(scene, pixel_view(64, 64));
                         finding.error(static_cast<double>(stream.fragments));
                         finding.require(stream.primitives[0].fate == PrimitiveFate::culled_degenerate, "degenerate");
                     }});
}

} // namespace reports::stability::rasterization

std::vector<reports::stability::Case> reports::stability::rasterization_cases() {
    std::vector<Case> cases;
    rasterization::add_thin(cases);
    rasterization::add_sub_pixel(cases);
    rasterization::add_clip_planes(cases);
    rasterization::add_guard_band(cases);
    rasterization::add_coordinates(cases);
    return cases;
}
