// Soft shadows at the limits of section 6.2 of specification 004, item by item.
#include "models/programs/nearest_k.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "reports/stability/scenes.hpp"
#include "reports/stability/shadow_setting.hpp"

#include <fmt/format.h>

namespace reports::stability::shadows {

/// Eq. 5.3 in 113 bits: the share of the light behind a texel that reaches half a texel to either side.
Quad exact_share(const AreaLight& light, std::uint32_t r, Quad du, Quad dv, Quad z_s, Quad z) {
    const Quad scale = Quad(light.near_width) / Quad(light.near) / r * z_s * z / (z - z_s) / Quad(light.width);
    const auto side = [scale](Quad at) {
        const auto bounded = [](Quad x) { return x < Quad(-0.5) ? Quad(-0.5) : x > Quad(0.5) ? Quad(0.5) : x; };
        return bounded((at + Quad(0.5)) * scale) - bounded((at - Quad(0.5)) * scale);
    };
    return side(du) * side(dv);
}

void add_divergence(std::vector<Case>& cases) {
    cases.push_back({"shadows.difference-below", Side::below,
                     "an occluder behind the receiver: z < z_s, where the printed formula gives a positive area",
                     "no light is covered, for all texels", "shares", 0.0, [](Finding& finding) {
                         for (const float z_s : {next_up(10.0F), 10.5F, 1000.0F, 1e30F})
                             for (const float du : {-1.0F, 0.0F, 0.5F})
                                 finding.error(
                                     static_cast<double>(covered_share(unit_light(), 1024, du, 0, 0.5F, z_s, 10.0F)));
                     }});
    cases.push_back(
        {"shadows.difference-at", Side::at, "an occluder at the receiver: z = z_s, 0 times infinity at an edge",
         "no light is covered, for all offsets", "shares", 0.0, [](Finding& finding) {
             for (const float z : {1.5F, 10.0F, 60000.0F, 1e30F})
                 for (const float du : {-0.5F, 0.0F, 0.5F, 1.0F})
                     finding.error(static_cast<double>(covered_share(unit_light(), 1024, du, du, 0.5F, z, z)));
         }});
    cases.push_back(
        {"shadows.difference-above", Side::above, "an occluder one float before the receiver: z / (z - z_s) = 2^23",
         "the texel of the receiver covers all light, its neighbours none", "shares", 0.0, [](Finding& finding) {
             for (const float z : {1.5F, 10.0F, 900.0F, 60000.0F}) {
                 const float z_s = next_down(z);
                 finding.error(static_cast<double>(covered_share(unit_light(), 1024, 0, 0, 0.5F, z_s, z)) - 1.0);
                 for (const float du : {-1.0F, 1.0F, 5.0F})
                     finding.error(static_cast<double>(covered_share(unit_light(), 1024, du, 0, 0.5F, z_s, z)));
             }
         }});
    cases.push_back({"shadows.difference-tiny-light", Side::above,
                     "a light of 1e-30, a texel far larger than it, z - z_s one float", "all light or none, never NaN",
                     "shares", 0.0, [](Finding& finding) {
                         for (const double width : {1e-30, 1e-38}) {
                             finding.error(static_cast<double>(covered_share(unit_light(width), 1024, 0, 0, 0.5F,
                                                                             next_down(10.0F), 10.0F)) -
                                           1.0);
                             finding.error(static_cast<double>(
                                 covered_share(unit_light(width), 1024, 1, 0, 0.5F, next_down(10.0F), 10.0F)));
                             finding.error(static_cast<double>(covered_share(unit_light(width), 1024, 0.5F, 0, 0.5F,
                                                                             next_down(10.0F), 10.0F)) -
                                           0.5);
                         }
                     }});
    const auto exact = [](Finding& finding, std::initializer_list<std::array<double, 2>> depths) {
        for (const auto& [z_s, z] : depths)
            for (const double width : {10.0, std::ceil(z_s * z / (z - z_s) / 512.0)}) { // a texel spans half of it
                const AreaLight light = unit_light(width);
                for (const float du : {0.0F, 0.3F, 3.0F})
                    finding.error(
                        relative_error(static_cast<double>(covered_share(
                                           light, 1024, du, 0, 0.5F, static_cast<float>(z_s), static_cast<float>(z))),
                                       exact_share(light, 1024, Quad(du), 0, Quad(static_cast<float>(z_s)),
                                                   Quad(static_cast<float>(z)))));
            }
    };
    constexpr double bound = 8.0 * 0x1p-24;
    cases.push_back({"shadows.product-below", Side::below, "z_s z below 65504: 100 * 600, 250 * 262",
                     "Eq. 5.3 in 113 bits, to 8 half places of a float", "relative", bound, [exact](Finding& finding) {
                         exact(finding, {{100, 600}, {250, 262}});
                     }});
    cases.push_back({"shadows.product-at", Side::at, "z_s z = 65504 = 256 * 255.875, the largest half",
                     "Eq. 5.3 in 113 bits", "relative", bound, [exact](Finding& finding) {
                         exact(finding, {{255.875, 256}});
                     }});
    cases.push_back({"shadows.product-above", Side::above,
                     "z_s z beyond the largest half, and beyond the largest float: 300 * 400, 1e25 * 2e25",
                     "Eq. 5.3 in 113 bits, clamped to the light", "relative", bound, [exact](Finding& finding) {
                         exact(finding, {{300, 400}, {60000, 65504}, {1e25, 2e25}});
                     }});
}

/// Of receivers on a surface at distances of [low, high): the share that the surface itself hides, stored as a half
/// with a constant added.
double self_shadowed(double low, double high, float bias) {
    constexpr int tries = 2000;
    int hidden = 0;
    for (int i = 0; i < tries; ++i) {
        const auto z = static_cast<float>(low + (high - low) * (i + 0.37) / tries);
        hidden += traces::through_shadow_format(ShadowFormat::rgba16f, z) + bias < z ? 1 : 0;
    }
    return static_cast<double>(hidden) / tries;
}

void add_half_bias(std::vector<Case>& cases) {
    cases.push_back(
        {"shadows.uniform-bias-below", Side::below, "a bias of 0.01 at z in [32, 64): half a quantum is 0.0156",
         "the share of places whose rounding is more than 0.01: 36 % / 2 = 18 %", "of all places", 0.005,
         [](Finding& finding) { finding.error(self_shadowed(32, 64, 0.01F) - (0.015625 - 0.01) / 0.03125); }});
    cases.push_back({"shadows.uniform-bias-at", Side::at,
                     "a bias of half a quantum: 2^-7 at [16, 32), 2^-6 at [32, 64)", "no place hides itself",
                     "of all places", 0.0, [](Finding& finding) {
                         finding.error(self_shadowed(16, 32, 0x1p-7F));
                         finding.error(self_shadowed(32, 64, 0x1p-6F));
                     }});
    cases.push_back({"shadows.uniform-bias-above", Side::above,
                     "a bias of 0.01 at z in [8, 16): half a quantum is 0.0039", "no place hides itself",
                     "of all places", 0.0, [](Finding& finding) { finding.error(self_shadowed(8, 16, 0.01F)); }});
    cases.push_back({"shadows.map-quanta", Side::whole,
                     "a map of halves: planes at 1.0004, 9.003, 20.01, 100.02 and 700.2 from the light",
                     "the nearest multiple of 2^(floor(log2 z) - 10)", "half quanta", 0.0, [](Finding& finding) {
                         for (const double z : {1.0004, 9.003, 20.01, 100.02, 700.2}) {
                             const ShadowMap map = map_of(
                                 unit_light(), {.resolution = 2, .format = ShadowFormat::rgba16f}, {plane(z), nothing});
                             const double quantum = std::exp2(std::floor(std::log2(z)) - 10);
                             finding.error(static_cast<double>(map.depth(0, 0, 0)) / quantum - std::round(z / quantum));
                         }
                     }});
}

void add_layers(std::vector<Case>& cases) {
    const auto bias_of = [](const std::vector<Layer>& layers, std::uint32_t layer, ShadowFormat format) {
        return static_cast<double>(
            map_of(unit_light(), {.resolution = 2, .layers = 4, .format = format}, layers).bias(layer, 0, 0));
    };
    cases.push_back({"shadows.midpoint-inside", Side::below, "midpoint bias of a layer with a successor at 6 behind 4",
                     "1", "relative", 1e-6, [bias_of](Finding& finding) {
                         finding.error(bias_of({plane(4), plane(6)}, 0, ShadowFormat::rgba32f) - 1.0);
                     }});
    cases.push_back(
        {"shadows.midpoint-last", Side::at, "midpoint bias of the last captured layer, which has no successor", "0",
         "absolute", 0.0, [bias_of](Finding& finding) {
             finding.error(bias_of({plane(6), plane(4)}, 1, ShadowFormat::rgba32f)); // the next texel begins at 6
             finding.error(bias_of({plane(4)}, 0, ShadowFormat::rgba16f));
         }});
    cases.push_back(
        {"shadows.midpoint-sentinel", Side::above, "midpoint bias before an empty layer: half way to the far sentinel",
         "finite, and no occluder for what lies in front of it: (65504 - 4) / 2", "absolute", 0.0,
         [bias_of](Finding& finding) {
             finding.error(bias_of({plane(4), nothing}, 0, ShadowFormat::rgba16f) - 32750.0);
             finding.require(std::isfinite(bias_of({plane(4), nothing}, 0, ShadowFormat::rgba32f)), "finite");
         }});
    cases.push_back({"shadows.unsorted-layers", Side::above,
                     "a second layer in front of the first, as a torn read leaves it: the midpoint would be negative",
                     "bias 0: no layer shadows itself", "absolute", 0.0, [bias_of](Finding& finding) {
                         finding.error(bias_of({plane(6), plane(4)}, 0, ShadowFormat::rgba32f));
                     }});
    // Section 10.3, S4: two occluders of which each leaves some light, and both together none.
    const auto bleeding = [](std::uint32_t layers) {
        constexpr double edge = 5.0 / 256, begin = -3.0 / 256;
        const Layer first = [](double x, double) { return x < edge ? 4.0 : 10.0; };
        const Layer second = [](double x, double) { return x > begin && x < edge ? 6.0 : 10.0; };
        ShadowMapOptions options = floats_32;
        options.layers = layers;
        const AreaLight light = unit_light(0.5);
        const ShadowMap map = map_of(light, options, {first, second, plane(10.0), nothing});
        return visibility(map, all_texels, point(light, 0, 0, 10));
    };
    // The region is 256 * 0.5 * (1/4 - 1/10) = 19.2 texels wide.
    cases.push_back({"shadows.bleeding-1-layer", Side::below, "two occluders behind each other, one layer",
                     "0.24 of the light bleeds through", "of the light", 1.0 / 19.2,
                     [bleeding](Finding& finding) { finding.error(bleeding(1) - 0.24); }});
    cases.push_back({"shadows.bleeding-2-layers", Side::at, "two occluders behind each other, two layers", "none",
                     "of the light", 1.0 / 19.2, [bleeding](Finding& finding) { finding.error(bleeding(2)); }});
    cases.push_back({"shadows.bleeding-3-layers", Side::above, "two occluders behind each other, three layers", "none",
                     "of the light", 1.0 / 19.2, [bleeding](Finding& finding) { finding.error(bleeding(3)); }});
    // A slanted surface, `step` per texel along x, with its back side `gap` behind: acne is what hides the surface
    // itself.
    const auto acne = [](double gap) {
        constexpr double step = 0.0625;
        ShadowMapOptions options{.resolution = 64, .format = ShadowFormat::rgba32f};
        const Layer front = [](double x, double) { return 20.0 + step * (64.0 * x); },
                    back = [gap](double x, double) { return 20.0 + step * (64.0 * x) + gap; };
        const ShadowMap map = map_of(unit_light(), options, {front, back, nothing, nothing});
        int dark = 0;
        for (int x = 8; x < 56; ++x)
            for (int part = 1; part < 8; ++part) { // places across a texel, on the surface
                const double z = 20.0 + step * (x + part / 8.0 - 32.0);
                dark += map.depth(0, x, 32) + map.bias(0, x, 32) < static_cast<float>(z) ? 1 : 0;
            }
        return static_cast<double>(dark) / (48 * 7);
    };
    cases.push_back({"shadows.acne-below", Side::below,
                     "midpoint bias, the texel's footprint half of the gap between layers", "no place hides itself",
                     "of all places", 0.0, [acne](Finding& finding) { finding.error(acne(0.125)); }});
    cases.push_back({"shadows.acne-at", Side::at,
                     "midpoint bias, the footprint 1.01 of the gap, so that the bias ends just inside the texel's edge",
                     "no place of eighths hides itself", "of all places", 0.0,
                     [acne](Finding& finding) { finding.error(acne(0.0625 * 0.99)); }});
    cases.push_back({"shadows.acne-above", Side::above, "midpoint bias, the footprint four times the gap",
                     "places from 1/8 texel behind the middle on hide themselves: 3 of 7, less those on the bias",
                     "of all places", 0.15, [acne](Finding& finding) {
                         const double share = acne(0.0625 / 4);
                         finding.error(share - 3.0 / 7.0);
                         finding.require(share > 0.2, "acne");
                     }});
    cases.push_back({"shadows.ids-are-draws", Side::whole, "entries that name an object: both triangles of one draw",
                     "one number across the shared edge, so that ids make no acne along it", "ids", 0.0,
                     [](Finding& finding) {
                         const auto program = models::make_nearest_k(models::EntryKind::zo, 1);
                         traces::Scene scene = layers_of(8, 8, std::array{0.5F});
                         const pipeline::FragmentStream stream = rasterized(scene, pixel_view(8, 8));
                         finding.require(stream.triangles.size() == 2, "two triangles");
                         for (pipeline::QuadId id = 0; id < stream.quads.size(); ++id) {
                             std::array<float, 2> entry{};
                             program->make_entry(stream.fragment(id, 0), entry.data());
                             finding.error(static_cast<double>(entry[1]));
                         }
                     }});
}

} // namespace reports::stability::shadows

std::vector<reports::stability::Case> reports::stability::shadow_cases() {
    std::vector<Case> cases;
    shadows::add_divergence(cases);
    shadows::add_half_bias(cases);
    shadows::add_layers(cases);
    return cases;
}
