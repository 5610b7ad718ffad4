// Window depth and distance with near and far planes of any ratio; perspective interpolation; level of detail.
#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/functional/interpolation.hpp"
#include "pipeline/functional/texture_sampler.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "reports/stability/scenes.hpp"
#include "traces/view_rays.hpp"

#include <fmt/format.h>

namespace reports::stability::distances {

using pipeline::EyeDepth;
using pipeline::ScreenVertex;

/// Distance of a window depth in 113 bits, from the matrix that the program has: with n = 2 w - 1,
/// (m32 - n m33) / (m22 - n m23) in glm's columns, where distance is -z.
Quad exact_distance(const glm::mat4& m, Quad window) {
    const Quad n = 2 * window - 1;
    return (Quad(m[3][2]) - n * Quad(m[3][3])) / (Quad(m[2][2]) - n * Quad(m[2][3]));
}

/// The largest relative error of distances of window depths over [0,1], its ends and their neighbours among them.
void distances_of(Finding& finding, double near, double far) {
    const glm::mat4 projection = perspective_view(4, 4, 60, near, far).projection;
    const EyeDepth depth(projection);
    for (int i = 0; i <= 200; ++i) {
        float window = static_cast<float>(i) / 200.0F;
        if (i == 199) window = next_down(1.0F);
        if (i == 1) window = smallest_float;
        const Quad exact = exact_distance(projection, Quad(window));
        if (exact <= 0 || exact > Quad(largest_float)) continue; // beyond: bounded by the largest float
        finding.error(relative_error(depth.distance(window), exact));
    }
}

/// Window depths of distances between the planes, beside f (z - n) / (z (f - n)) of the real planes.
void windows_of(Finding& finding, double near, double far) {
    const EyeDepth depth(perspective_view(4, 4, 60, near, far).projection);
    for (int i = 0; i <= 100; ++i) {
        const Quad z = near * std::pow(far / near, i / 100.0), n = near, f = far;
        finding.error((static_cast<double>(depth.window(static_cast<double>(z))) -
                       static_cast<double>(f * (z - n) / (z * (f - n)))) *
                      0x1p24);
    }
}

void add_planes(std::vector<Case>& cases) {
    constexpr double bound = 4 * 0x1p-53;
    cases.push_back({"distances.planes-close", Side::below, "planes 1 and 1.0001: all distances agree in four digits",
                     "the distance in 113 bits of the same matrix", "relative", bound,
                     [](Finding& finding) { distances_of(finding, 1.0, 1.0001); }});
    cases.push_back({"distances.planes-usual", Side::at, "planes 0.1 and 100, 1 and 1000",
                     "the distance in 113 bits of the same matrix", "relative", bound, [](Finding& finding) {
                         distances_of(finding, 0.1, 100.0);
                         distances_of(finding, 1.0, 1000.0);
                     }});
    cases.push_back({"distances.planes-far", Side::above,
                     "planes 1e-4 and 1e10: the matrix holds no more than -1 and -2e-4",
                     "the distance in 113 bits of the same matrix, bounded by the largest float", "relative", bound,
                     [](Finding& finding) {
                         distances_of(finding, 1e-4, 1e10);
                         distances_of(finding, 1e-4, 1e30);
                     }});
    cases.push_back({"distances.window-close", Side::below,
                     "window depths with planes 1 and 1.0001, from a matrix of floats",
                     "f (z - n) / (z (f - n)) of the planes; entries of 2e4 rounded by 2^-10", "2^-24", 20000.0,
                     [](Finding& finding) { windows_of(finding, 1.0, 1.0001); }});
    cases.push_back({"distances.window-usual", Side::at, "window depths with planes 0.1 and 100",
                     "f (z - n) / (z (f - n)) of the planes, the matrix's rounding aside", "2^-24", 3.0,
                     [](Finding& finding) { windows_of(finding, 0.1, 100.0); }});
    cases.push_back({"distances.window-far", Side::above, "window depths with planes 1e-4 and 1e10",
                     "f (z - n) / (z (f - n)) of the planes", "2^-24", 3.0,
                     [](Finding& finding) { windows_of(finding, 1e-4, 1e10); }});
    cases.push_back({"distances.at-and-behind-eye", Side::below, "distances 0, -1, -1e30 and a NaN window depth",
                     "window depth 0; the distances of 0 or 1", "absolute", 0.0, [](Finding& finding) {
                         const EyeDepth depth(perspective_view(4, 4, 60, 0.1, 100).projection);
                         for (const double z : {0.0, -1.0, -1e30}) finding.error(static_cast<double>(depth.window(z)));
                         finding.error(depth.distance(-3.0F) - depth.distance(0.0F));
                         finding.error(depth.distance(not_a_number) - depth.distance(1.0F));
                     }});
    cases.push_back({"distances.no-far-plane", Side::above,
                     "a projection without far plane at window depth 1, and at 1e30 and 1e300",
                     "the largest float; window depth 1", "absolute", 0.0, [](Finding& finding) {
                         const EyeDepth depth(perspective_view(4, 4, 60, 0.1, 0).projection);
                         for (const float window : {1.0F, 2.0F, infinity})
                             finding.error(depth.distance(window) - static_cast<double>(largest_float));
                         finding.require(depth.distance(next_down(1.0F)) < 1e8, "finite in front of it");
                         for (const double z : {1e30, 1e300}) finding.error(static_cast<double>(depth.window(z)) - 1.0);
                     }});
    cases.push_back({"distances.codes-left", Side::at,
                     "depth codes between 1 and 1000 with near planes 1, 0.01 and 1e-4 and a far plane of 1e10",
                     "D24 has 2^24 n / 1 of them behind distance 1: 167,605 with 0.01, 1,676 with 1e-4", "relative",
                     0.01, [](Finding& finding) {
                         for (const double near : {0.01, 1e-4}) {
                             const EyeDepth depth(perspective_view(4, 4, 60, near, 1e10).projection);
                             const double codes =
                                 (static_cast<double>(depth.window(1000)) - static_cast<double>(depth.window(1))) *
                                 16777215;
                             const Quad n = near, f = 1e10,
                                        exact = (f * (1000 - n) / (1000 * (f - n)) - f * (1 - n) / (f - n)) * 16777215;
                             finding.error(codes / static_cast<double>(exact) - 1.0);
                         }
                     }});
    cases.push_back(
        {"distances.rays", Side::whole, "lengths of a pixel's ray between two distances that agree in 1 to 15 digits",
         "the difference times the ray's slope, in 113 bits of the places", "of the distance", 4e-16,
         [](Finding& finding) {
             const pipeline::View view = perspective_view(64, 64, 90, 0.1, 1e6);
             const traces::ViewRays rays(view);
             for (const double apart : {0.1, 1e-6, 1e-12, 1e-15}) {
                 const double from = 1000.0, to = from * (1.0 + apart);
                 const glm::dvec3 a = rays.place(50, 3, 1.0); // at distance 1: the slope
                 const Quad slope = square_root(Quad(a.x) * a.x + Quad(a.y) * a.y + 1);
                 finding.error((rays.length(50, 3, from, to) - static_cast<double>(slope * (Quad(to) - Quad(from)))) /
                               from / 3);
             }
         }});
}

/// A triangle over the screen whose corners have these w; attributes 0, 1 and -1 at the corners.
struct Corners {
    std::array<ScreenVertex, 3> vertices;
    pipeline::RasterTriangle raster;
};

Corners corners_of(const std::array<glm::vec2, 3>& at, const std::array<float, 3>& w) {
    const pipeline::Viewport viewport(64, 64);
    Corners result;
    for (std::size_t i = 0; i < 3; ++i) {
        ScreenVertex& vertex = result.vertices[i];
        vertex.clip = {(at[i].x / 32.0F - 1.0F) * w[i], (1.0F - at[i].y / 32.0F) * w[i], 0.0F, w[i]};
        viewport.project(vertex);
    }
    result.raster = pipeline::set_up(result.vertices[0], result.vertices[1], result.vertices[2], viewport);
    return result;
}

/// Share of corners 1 and 2 at the centre of pixel (x, y): edge functions by integers, weighed with 1/w in 113 bits.
std::array<Quad, 2> exact_shares(const Corners& corners, int x, int y) {
    std::array<Quad, 3> share{};
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenVertex &a = corners.vertices[(i + 1) % 3], &b = corners.vertices[(i + 2) % 3];
        const Quad edge = Quad(b.x - a.x) * (y * 256 - a.y) - Quad(b.y - a.y) * (x * 256 - a.x);
        share[i] = edge / Quad(corners.vertices[i].clip.w);
    }
    const Quad sum = share[0] + share[1] + share[2];
    return {share[1] / sum, share[2] / sum};
}

void weights(Finding& finding, const std::array<float, 3>& w) {
    const Corners corners = corners_of({{{-1, -1}, {-1, 130}, {130, -1}}}, w);
    const pipeline::AttributePlanes planes(corners.raster, corners.vertices);
    for (int y = 0; y < 64; y += 6)
        for (int x = 0; x < 64; x += 6) {
            if (x + y > 120) continue;
            const pipeline::CornerWeights got = planes.at(x, y, 15);
            const auto exact = exact_shares(corners, x, y);
            finding.error(relative_error(static_cast<double>(got.of1[0]), exact[0]));
            finding.error(relative_error(static_cast<double>(got.of2[0]), exact[1]));
        }
}

void add_interpolation(std::vector<Case>& cases) {
    constexpr double bound = 1.01 * 0x1p-24; // one rounding to float
    cases.push_back({"interpolation.equal-w", Side::below, "perspective weights where all corners have one w",
                     "edge functions over the area in 113 bits", "relative", bound, [](Finding& finding) {
                         weights(finding, {1, 1, 1});
                         weights(finding, {1e-20F, 1e-20F, 1e-20F});
                     }});
    cases.push_back({"interpolation.w-ratio", Side::at, "perspective weights with w from 1 to 1000",
                     "edge functions over w in 113 bits", "relative", bound, [](Finding& finding) {
                         weights(finding, {1, 10, 1000});
                         weights(finding, {1000, 1, 3});
                     }});
    cases.push_back({"interpolation.w-extreme", Side::above, "perspective weights with w from 1e-20 to 1e20",
                     "edge functions over w in 113 bits, of shares that are floats at all", "relative", bound,
                     [](Finding& finding) {
                         weights(finding, {1e-10F, 1, 1e10F});
                         weights(finding, {1e15F, 1, 1e15F});
                     }});
    cases.push_back({"interpolation.equal-attributes", Side::whole,
                     "an attribute that is the same at all corners, w equal, of one size, and from 1e-10 to 1e10",
                     "exactly that value in every pixel", "ulp", 0.0, [](Finding& finding) {
                         for (const std::array<float, 3>& w :
                              {std::array{1.0F, 1.0F, 1.0F}, {1.0F, 3.0F, 7.0F}, {1e-10F, 1.0F, 1e10F}}) {
                             const Corners corners = corners_of({{{-1, -1}, {-1, 130}, {130, -1}}}, w);
                             const pipeline::AttributePlanes planes(corners.raster, corners.vertices);
                             for (int y = 0; y < 64; y += 2)
                                 for (const float value : {0.1F, -7e30F, smallest_float})
                                     for (const float got :
                                          planes.at(2 * (y / 4), y, 15).interpolate(value, value, value))
                                         finding.error(ulps(got, value));
                         }
                     }});
    cases.push_back(
        {"interpolation.within-range", Side::whole,
         "slivers one sub-pixel wide with w from 1 to 1e6: attributes from 0 to 1",
         "within [0,1] but for two roundings in every covered pixel", "ulp of 1", 2.0, [](Finding& finding) {
             for (int i = 0; i < 60; ++i) {
                 const float y = static_cast<float>(i) + 0.5F;
                 const Corners corners =
                     corners_of({{{0.5F, 0.5F}, {63.5F, y}, {63.5F, y + 1.0F / 256.0F}}}, {1, 1e6F, 30});
                 const pipeline::AttributePlanes planes(corners.raster, corners.vertices);
                 pipeline::for_each_quad(corners.raster, [&](std::int32_t x, std::int32_t row, unsigned mask) {
                     const auto got = planes.at(x, row, mask).interpolate(0.0F, 1.0F, 0.5F);
                     for (unsigned lane = 0; lane < 4; ++lane)
                         if ((mask >> lane & 1U) != 0)
                             finding.error(std::max({0.0, -static_cast<double>(got[lane]),
                                                     static_cast<double>(got[lane]) - 1.0}) *
                                           0x1p24);
                 });
             }
         }});
    cases.push_back({"interpolation.beyond-eye", Side::above,
                     "helper pixels beyond the plane of the eye: 1/w changes its sign next to a covered pixel",
                     "finite weights: those of the covered pixel", "", 0.0, [](Finding& finding) {
                         // Half a pixel below the base of a triangle 50.5 pixels high the share of the apex is -1/101,
                         // that of the base 102/101: with 102 as the base's w row 61 lies in the plane of the eye
                         // itself.
                         for (const std::array<float, 3>& w : {std::array{1e-6F, 1e6F, 1e6F}, {1.0F, 102.0F, 102.0F}}) {
                             const Corners corners = corners_of({{{10.5F, 10.5F}, {12, 61}, {11, 61}}}, w);
                             const pipeline::AttributePlanes planes(corners.raster, corners.vertices);
                             pipeline::for_each_quad(corners.raster,
                                                     [&](std::int32_t x, std::int32_t y, unsigned mask) {
                                                         const auto got = planes.at(x, y, mask);
                                                         for (const pipeline::Lanes& weights : {got.of1, got.of2})
                                                             for (const float weight : weights)
                                                                 finding.require(std::fabs(weight) < 1e7F, "finite");
                                                     });
                         }
                     }});
}

pipeline::Texture texture(std::uint32_t size) {
    pipeline::Texture result;
    for (; size > 0; size /= 2)
        result.levels.push_back({size, size, std::vector<std::uint8_t>(std::size_t{size} * size * 4, 128), 0});
    return result;
}

/// Level of a quad whose pixels are `texels` apart along u, beside log2 in 113 bits.
void level(Finding& finding, std::uint32_t size, double texels) {
    const pipeline::Texture image = texture(size);
    const pipeline::TextureSampler sampler(image);
    pipeline::QuadTexcoords at;
    const auto step = static_cast<float>(texels / size);
    at.u = {0.0F, step, 0.0F, step};
    const double got = static_cast<double>(sampler.level_of_detail(at));
    const Quad exact_texels = Quad(step) * size,
               exact = exact_texels > 1 ? logarithm(exact_texels) / logarithm(2) : Quad(0);
    const double last = static_cast<double>(image.levels.size() - 1);
    finding.error(got - std::min(static_cast<double>(exact), last));
    const auto footprint = sampler.footprint(static_cast<float>(got));
    finding.require(footprint.level < image.levels.size() && footprint.blend >= 0.0F && footprint.blend < 1.0F,
                    "a level of the texture");
}

void add_levels(std::vector<Case>& cases) {
    constexpr double bound = 0x1p-21; // half a float at 8 to 16 levels, and the least level above none
    cases.push_back({"level-of-detail.magnified", Side::below,
                     "pixels 0, 1e-30, 0.5 texels and one float less than a texel apart",
                     "level 0: the magnification filter", "levels", 0.0, [](Finding& finding) {
                         for (const double texels : {0.0, 1e-30, 0.5, static_cast<double>(next_down(1.0F))})
                             level(finding, 1024, texels);
                     }});
    cases.push_back({"level-of-detail.one-texel", Side::at, "pixels one texel apart, and one float more",
                     "level 0, then just above it, for the minification filter", "levels", bound, [](Finding& finding) {
                         level(finding, 1024, 1.0);
                         level(finding, 1024, static_cast<double>(next_up(1.0F)));
                         const pipeline::Texture image = texture(1024);
                         const pipeline::TextureSampler sampler(image);
                         pipeline::QuadTexcoords at;
                         at.u = {0.0F, next_up(1.0F) / 1024.0F, 0.0F, 0.0F};
                         finding.require(sampler.level_of_detail(at) > 0.0F, "above 0");
                         at.u = {0.0F, 1.0F / 1024.0F, 0.0F, 0.0F};
                         finding.require(sampler.level_of_detail(at) == 0.0F, "none at one texel");
                     }});
    cases.push_back({"level-of-detail.minified", Side::above, "pixels 1.5 to 1024 texels apart",
                     "log2 of the texels in 113 bits", "levels", bound, [](Finding& finding) {
                         for (const double texels : {1.5, 2.0, 3.7, 100.0, 1023.9, 1024.0})
                             level(finding, 1024, texels);
                     }});
    cases.push_back({"level-of-detail.beyond-last", Side::above, "pixels 1e4 to 2^24 textures apart", "the last level",
                     "levels", 0.0, [](Finding& finding) {
                         for (const double texels : {1e7, 0x1p34}) level(finding, 1024, texels);
                     }});
    cases.push_back(
        {"level-of-detail.one-texel-texture", Side::at,
         "a texture of one texel, pixels far apart, coordinates at the seam and of 2^24", "its colour", "ulp", 0.0,
         [](Finding& finding) {
             pipeline::Texture image = texture(1);
             image.srgb = false;
             for (const pipeline::Wrap wrap : {pipeline::Wrap::repeat, pipeline::Wrap::clamp, pipeline::Wrap::mirror}) {
                 image.wrap_u = image.wrap_v = wrap;
                 const pipeline::TextureSampler sampler(image);
                 const pipeline::QuadTexcoords at{{-1e-30F, 1.0F, 0x1p24F, -0x1p24F},
                                                  {next_down(1.0F), -0.0F, 0.5F, 1e-45F}};
                 std::array<glm::vec4, 4> colours{};
                 sampler.sample(at, sampler.footprint(sampler.level_of_detail(at)), 15, colours);
                 for (const glm::vec4& colour : colours) finding.error(ulps(colour.r, 128.0F / 255.0F));
             }
         }});
    cases.push_back(
        {"level-of-detail.seam", Side::at,
         "repeated texture of two texels: coordinates one float before 0 and 1, and on them",
         "both texels' mean at a seam, whichever side a float rounds to", "1/255", 1e-4, [](Finding& finding) {
             pipeline::Texture image = texture(2);
             image.srgb = false;
             image.levels[0].rgba = {0, 0, 0, 255, 200, 0, 0, 255, 0, 0, 0, 255, 200, 0, 0, 255};
             const pipeline::TextureSampler sampler(image);
             const pipeline::QuadTexcoords at{{-1e-30F, 0.0F, next_down(1.0F), 1.0F}, {0.5F, 0.5F, 0.5F, 0.5F}};
             std::array<glm::vec4, 4> colours{};
             sampler.sample(at, {0, 0.0F, true}, 15, colours);
             for (const glm::vec4& colour : colours)
                 finding.error((static_cast<double>(colour.r) - 100.0 / 255.0) * 255.0);
         }});
}

} // namespace reports::stability::distances

std::vector<reports::stability::Case> reports::stability::distance_cases() {
    std::vector<Case> cases;
    distances::add_planes(cases);
    distances::add_interpolation(cases);
    distances::add_levels(cases);
    return cases;
}
