// Soft shadows: how much of the light is covered, where is searched, where lights and receivers may be (specification
// 004, section 6.2, items 7 to 9 and 12).
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "reports/stability/scenes.hpp"
#include "reports/stability/shadow_setting.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports::stability::shadows {

void add_coverage(std::vector<Case>& cases) {
    const auto half_plane = [](double x, double) { return x < 0.0 ? 5.0 : INFINITY; };
    cases.push_back({"shadows.covered-half", Side::below, "occluders over half of the light",
                     "half of it: to 1 / kr with whole steps, to rounding with the texels' own places", "kr", 1.0,
                     [half_plane](Finding& finding) {
                         const AreaLight light = unit_light(0.5);
                         const ShadowMap map = map_of(light, floats_32, {half_plane, plane(10)});
                         const auto off = [&](const ShadowKernelOptions& options) {
                             return visibility(map, options, point(light, 0, 0, 10)) - 0.5;
                         };
                         ShadowKernelOptions exact = all_texels;
                         exact.offset = traces::SampleOffset::exact;
                         finding.error(off(all_texels) * 12.8);
                         finding.require(std::fabs(off(exact)) < 1e-6, "half of it");
                     }});
    cases.push_back({"shadows.covered-once", Side::at, "a whole plane of occluders: their areas add up to the light's",
                     "none: kr^2 A = 1", "of the light", 1e-4, [](Finding& finding) {
                         const AreaLight light = unit_light(0.25);
                         for (const ShadowFormat format : {ShadowFormat::rgba16f, ShadowFormat::rgba32f}) {
                             ShadowMapOptions options = floats_32;
                             options.format = format;
                             finding.error(visibility(map_of(light, options, {plane(5), plane(10)}), all_texels,
                                                      point(light, 0.003, 0, 10)));
                         }
                     }});
    cases.push_back({"shadows.covered-twice", Side::above,
                     "occluders at two depths whose areas on the light overlap: more than all light is subtracted",
                     "0, never less", "of the light", 0.0, [](Finding& finding) {
                         const AreaLight light = unit_light(0.25);
                         // Seen from 10, a texel at 4 spans 0.104 of the light: the middle 13 of a row cover it all.
                         // Those at 2 beside them cover again what the middle has covered.
                         const Layer mixed = [](double x, double) { return std::fabs(x) * 256 < 7 ? 4.0 : 2.0; };
                         const ShadowMap map = map_of(light, floats_32, {mixed, plane(10), nothing, nothing});
                         finding.error(visibility(map, all_texels, point(light, 0, 0, 10)));
                     }});
    const auto samples = [](std::uint32_t most) {
        const AreaLight light = unit_light(0.5);
        const ShadowMap map = map_of(light, floats_32, {plane(5), plane(10)});
        return ShadowKernel(map, {.most_samples = most}).region(point(light, 0, 0, 10));
    };
    // kr = 256 * 0.5 * (1/5 - 1/10) = 12.8: 2 ceil(6.4) + 1 = 15 texels a side.
    cases.push_back({"shadows.samples-below", Side::below,
                     "more samples allowed than the region has texels: 15 * 15 of 226", "all 225, one texel apart",
                     "texels", 0.0, [samples](Finding& finding) {
                         finding.error(samples(226).across - 15.0);
                         finding.error(static_cast<double>(samples(226).step) - 1.0);
                     }});
    cases.push_back({"shadows.samples-at", Side::at, "as many samples allowed as the region has texels: 225",
                     "all 225, one texel apart", "texels", 0.0, [samples](Finding& finding) {
                         finding.error(samples(225).across - 15.0);
                         finding.error(static_cast<double>(samples(225).step) - 1.0);
                     }});
    cases.push_back({"shadows.samples-above", Side::above, "fewer samples than texels: 224, 169, 9, 1",
                     "at most as many, spread over the whole region", "texels", 1e-5, [samples](Finding& finding) {
                         for (const std::uint32_t most : {224U, 169U, 9U, 1U}) {
                             const auto region = samples(most);
                             finding.require(region.across * region.across <= most, "at most");
                             finding.error(static_cast<double>(region.step * static_cast<float>(region.across)) - 15.0);
                         }
                     }});
    cases.push_back({"shadows.gap-filling", Side::whole, "thin bars with gaps between them, gaps filled",
                     "never lighter than without, somewhere darker", "of the light", 1e-6, [](Finding& finding) {
                         const AreaLight light = unit_light(0.5);
                         const Layer comb = [](double x, double) {
                             return std::fmod(std::fabs(x) * 64.0, 2.0) < 1.0 ? 4.0 + 4.0 * std::fabs(x) : INFINITY;
                         };
                         const ShadowMap map = map_of(light, floats_32, {comb, plane(10)});
                         ShadowKernelOptions filled = all_texels;
                         filled.gap_filling = true;
                         double darker = 0.0;
                         for (int i = 0; i < 25; ++i) {
                             const glm::dvec3 at = point(light, 0.06 * i - 0.7, 0.1, 10);
                             const double plain = visibility(map, all_texels, at), full = visibility(map, filled, at);
                             finding.error(std::max(full - plain, 0.0));
                             darker += plain - full;
                         }
                         finding.require(darker > 0.0, "somewhere darker");
                     }});
}

void add_search(std::vector<Case>& cases) {
    const auto width = [](float z_s, float z) {
        return static_cast<double>(traces::search_width(unit_light(), 1024, z_s, z));
    };
    cases.push_back({"shadows.search-inside", Side::below,
                     "search region for z_min between n and z: 1, 5, 9.99, and one float below 10",
                     "1024 (1/z_min - 1/z) in 113 bits, to 6 half places of a float: 921.6, 102.4, 0.1025 texels ...",
                     "relative", 6 * 0x1p-24, [width](Finding& finding) {
                         for (const float z_s : {1.0F, 5.0F, 9.99F, 9.9999F, next_down(10.0F)})
                             finding.error(relative_error(width(z_s, 10), 1024 * (1 / Quad(z_s) - 1 / Quad(10))));
                     }});
    cases.push_back({"shadows.search-at", Side::at, "search region for z_min = z", "no width", "texels", 0.0,
                     [width](Finding& finding) {
                         for (const float z : {1.0F, 10.0F, 1e30F}) finding.error(width(z, z));
                     }});
    cases.push_back({"shadows.search-above", Side::above, "search region for z_min beyond z, and for z_min <= 0",
                     "no width, never negative or infinite", "texels", 0.0, [width](Finding& finding) {
                         for (const float z_s : {10.5F, 1e30F, 0.0F, -1.0F}) finding.error(width(z_s, 10));
                     }});
    cases.push_back(
        {"shadows.search-huge-light", Side::above, "a light of 1e6 and of 1e30 before a map of 16 texels",
         "four times the map, and everything sampled is a speck: lit", "relative", 0.01, [](Finding& finding) {
             for (const double size : {1e6, 1e30}) {
                 const AreaLight light = unit_light(size);
                 ShadowMapOptions options = floats_32;
                 options.resolution = 16;
                 const ShadowMap map = map_of(light, options, {plane(5), plane(10)});
                 finding.require(ShadowKernel(map, all_texels).region(point(light, 0, 0, 10)).width == 64.0F,
                                 "64 texels");
                 finding.error(visibility(map, all_texels, point(light, 0, 0, 10)) - 1.0);
             }
         }});
    cases.push_back({"shadows.level-below", Side::below, "level of the hierarchy for no width and for one texel", "1",
                     "levels", 0.0, [](Finding& finding) {
                         for (const float w : {0.0F, 0.5F, 1.0F}) finding.error(traces::search_level(w, 11) - 1.0);
                     }});
    cases.push_back({"shadows.level-at", Side::at, "level for widths at powers of two and behind them",
                     "ceil(log2 kr) + 1", "levels", 0.0, [](Finding& finding) {
                         for (int exponent = 1; exponent < 9; ++exponent) {
                             const float w = std::ldexp(1.0F, exponent);
                             finding.error(traces::search_level(w, 11) - (exponent + 1.0));
                             finding.error(traces::search_level(w * 1.001F, 11) - (exponent + 2.0));
                         }
                     }});
    cases.push_back({"shadows.level-above", Side::above, "level for widths beyond the map", "the last one", "levels",
                     0.0, [](Finding& finding) {
                         for (const float w : {1024.0F, 1e9F, largest_float})
                             finding.error(traces::search_level(w, 11) - 10.0);
                     }});
    cases.push_back(
        {"shadows.hierarchy-conservative", Side::whole, "least depths of random maps: every level, every place",
         "the least of the four texels' squares, by looking at each texel", "ulp", 0.0, [](Finding& finding) {
             const Layer bumpy = [](double x, double y) {
                 return 5.0 + std::sin(91 * x) * std::cos(57 * y) + (x * y > 0.1 ? INFINITY : 0.0);
             };
             const ShadowMap map =
                 map_of(unit_light(), {.resolution = 32, .format = ShadowFormat::rgba32f}, {bumpy, nothing});
             for (std::uint32_t level = 0; level < map.levels(); ++level)
                 for (int i = 0; i < 40; ++i) {
                     const float u = static_cast<float>(i) * 0.83F - 0.5F, v = 31.0F - static_cast<float>(i) * 0.71F;
                     const int size = 32 >> level, texel = 1 << level;
                     float least = traces::shadow_sentinel(ShadowFormat::rgba32f);
                     for (int k = 0; k < 4; ++k) {
                         const int left = std::clamp(
                             static_cast<int>(std::floor(u / static_cast<float>(texel) - 0.5F)) + k % 2, 0, size - 1);
                         const int top = std::clamp(
                             static_cast<int>(std::floor(v / static_cast<float>(texel) - 0.5F)) + k / 2, 0, size - 1);
                         for (int y = top * texel; y < (top + 1) * texel; ++y)
                             for (int x = left * texel; x < (left + 1) * texel; ++x)
                                 least = std::min(least, map.depth(0, x, y));
                     }
                     finding.error(ulps(map.least(level, u, v), least));
                 }
         }});
}

void add_light_places(std::vector<Case>& cases) {
    const auto lit = [](Finding& finding, std::initializer_list<double> places) {
        const AreaLight light = unit_light();
        const ShadowMap map = map_of(light, floats_32, {plane(1.0), plane(10.0)});
        for (const double z : places) finding.error(visibility(map, all_texels, point(light, 0, 0, z)) - 1.0);
    };
    cases.push_back({"shadows.receiver-behind-light", Side::below,
                     "receivers behind the light, in its plane, and before the near plane", "lit", "of the light", 0.0,
                     [lit](Finding& finding) {
                         lit(finding, {-5.0, -1e-30, 0.0, 1e-30, 0.999});
                     }});
    cases.push_back({"shadows.receiver-at-near", Side::at, "a receiver on the near plane: z = n", "lit", "of the light",
                     0.0, [lit](Finding& finding) { lit(finding, {1.0}); }});
    cases.push_back({"shadows.light-in-surface", Side::above,
                     "a surface through the near plane, receivers just behind it and far away",
                     "a share between none and all of the light, none at 5", "of the light", 1e-3,
                     [](Finding& finding) {
                         const AreaLight light = unit_light();
                         const ShadowMap map = map_of(light, floats_32, {plane(1.0), plane(10.0)});
                         for (const double z : {std::nextafter(1.0, 2.0), 1.0001, 1.1, 5.4999}) {
                             const double seen = visibility(map, all_texels, point(light, 0, 0, z));
                             finding.require(seen >= 0.0 && seen <= 1.0, "within [0,1]");
                         }
                         finding.error(visibility(map_of(light, floats_32, {plane(1.0), plane(2.0)}), all_texels,
                                                  point(light, 0, 0, 5.0)));
                     }});
    cases.push_back({"shadows.receiver-far-away", Side::above,
                     "receivers at 1e6, 1e30 and beyond the floats, at the axis and far beside it",
                     "a share of the light, never NaN", "", 0.0, [](Finding& finding) {
                         for (const ShadowFormat format : {ShadowFormat::rgba16f, ShadowFormat::rgba32f}) {
                             const AreaLight light = unit_light(0.5);
                             const ShadowMap map = map_of(light, {.resolution = 32, .format = format},
                                                          {plane(300), plane(301), plane(302), plane(303)});
                             for (const double z : {1e6, 1e30, 1e300})
                                 for (const double x : {0.0, 1e6, 1e300}) {
                                     const double seen = visibility(map, {.most_samples = 169}, point(light, x, x, z));
                                     finding.require(seen >= 0.0 && seen <= 1.0, fmt::format("share at {} {}", x, z));
                                 }
                         }
                     }});
    cases.push_back({"shadows.light-at-infinity", Side::above,
                     "a light 1e6 times as far as the scene is large: all depths agree in four digits and more",
                     "finite planes that enclose the scene, a whole number of lit and dark points", "", 0.0,
                     [](Finding& finding) {
                         traces::Scene scene = world_scene({{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}});
                         traces::finish_scene(scene);
                         for (const char* place : {"0,1e6,0,0,0,0", "1e15,1e15,0,0,0,0"}) {
                             const AreaLight light = traces::make_area_light(scene, place, 0.1, "stability");
                             finding.require(light.near > 0.0 && light.far > light.near && std::isfinite(light.far),
                                             "0 < near < far");
                             finding.require(std::isfinite(light.near_width) && light.near_width > 0.0, "a frustum");
                         }
                     }});
    cases.push_back(
        {"shadows.light-at-target", Side::at, "a light at its own target", "refused", "", 0.0, [](Finding& finding) {
             traces::Scene scene = world_scene({{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}});
             traces::finish_scene(scene);
             finding.refuses([&] { traces::make_area_light(scene, "1,2,3,1,2,3", 0.1, "stability"); },
                             "expected a target that is not the light's place");
         }});
    cases.push_back({"shadows.point-light", Side::at, "a light of no size",
                     "a hard shadow: all light or none, as one texel says", "of the light", 0.0, [](Finding& finding) {
                         const AreaLight light = unit_light(0.0);
                         const ShadowMap map = map_of(
                             light, floats_32, {[](double x, double) { return x < 0 ? 5.0 : INFINITY; }, plane(10)});
                         ShadowKernelOptions hard;
                         hard.method = traces::ShadowMethod::hard;
                         for (int i = -40; i <= 40; ++i) {
                             const glm::dvec3 at = point(light, 0.05 * i, 0.031 * i, 9.999);
                             finding.error(visibility(map, {}, at) - visibility(map, hard, at));
                         }
                     }});
    cases.push_back(
        {"shadows.empty-map", Side::whole, "a map without a surface, and one of one texel with a surface", "lit; dark",
         "of the light", 0.0, [](Finding& finding) {
             const AreaLight light = unit_light();
             ShadowMapOptions one = floats_32;
             one.resolution = 1;
             finding.error(
                 visibility(map_of(light, floats_32, {nothing, nothing}), all_texels, point(light, 0, 0, 10)) - 1.0);
             finding.error(visibility(map_of(light, one, {nothing, nothing}), all_texels, point(light, 0, 0, 10)) -
                           1.0);
             finding.error(visibility(map_of(light, one, {plane(2), plane(10)}), all_texels, point(light, 0, 0, 10)));
         }});
    const auto slope = [](double gmax, double gscale) {
        const Layer ramp = [](double x, double) { return 5.0 + 2.0 * x; };
        ShadowMapOptions options{.resolution = 64,
                                 .layers = 1,
                                 .format = ShadowFormat::rgba32f,
                                 .bias = ShadowBias::none,
                                 .gscale = static_cast<float>(gscale),
                                 .gmax = static_cast<float>(gmax)};
        return static_cast<double>(map_of(unit_light(), options, {ramp, plane(20)}).bias(0, 20, 20));
    };
    cases.push_back({"shadows.slope-bias-below", Side::below, "slope bias 3 * 2/64 below its bound gmax = 1", "3/32",
                     "relative", 1e-3,
                     [slope](Finding& finding) { finding.error(slope(1.0, 3.0) / (3.0 * 2.0 / 64) - 1.0); }});
    cases.push_back({"shadows.slope-bias-at", Side::at, "slope bias without bound: gmax = 0 is none", "3/32",
                     "relative", 1e-3,
                     [slope](Finding& finding) { finding.error(slope(0.0, 3.0) / (3.0 * 2.0 / 64) - 1.0); }});
    cases.push_back({"shadows.slope-bias-above", Side::above, "slope bias above gmax = 0.05, and with gscale 1e38",
                     "0.05; finite", "ulp", 0.0, [slope](Finding& finding) {
                         finding.error(ulps(static_cast<float>(slope(0.05, 3.0)), 0.05F));
                         finding.require(std::isfinite(slope(0.0, 1e38)), "finite");
                     }});
}

} // namespace reports::stability::shadows

std::vector<reports::stability::Case> reports::stability::shadow_search_cases() {
    std::vector<Case> cases;
    shadows::add_coverage(cases);
    shadows::add_search(cases);
    shadows::add_light_places(cases);
    return cases;
}
