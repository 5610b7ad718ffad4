// Volumes, isosurfaces, translucency and depth of field: extinction, scalars, gaps and lenses at their limits.
#include "models/programs/depth_partition.hpp"
#include "models/programs/isosurface.hpp"
#include "models/programs/nearest_k.hpp"
#include "models/programs/volume.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "reports/stability/replay.hpp"
#include "reports/stability/scenes.hpp"
#include "traces/loads.hpp"
#include "traces/tetrahedra/tetrahedral_mesh.hpp"
#include "traces/workloads/lens_blur.hpp"
#include "traces/workloads/translucency_picture.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports::stability::fields {

const glm::vec3 orange(1.0F, 0.5F, 0.0F);

models::TransferFunction constant(float extinction) { return {{0.0F, orange, extinction}, {1.0F, orange, extinction}}; }

/// What a program keeps of these samples: the four floats behind its entries.
std::array<float, 4> state_after(const pipeline::ModifyProgram& program,
                                 const std::vector<std::array<float, 2>>& samples) {
    std::vector<float> pixel(program.floats_per_pixel());
    program.clear(pixel.data());
    for (const auto& sample : samples) program.insert(pixel.data(), sample.data());
    program.drain(pixel.data());
    std::array<float, 4> state{};
    std::copy_n(pixel.data() + std::size_t{program.k()} * 2, 4, state.begin());
    return state;
}

/// Opacity of one gap of a constant field, and what it has to be: 1 - exp(-extinction length).
void constant_gap(Finding& finding, float extinction, float length) {
    const models::PreintegratedTable table(constant(extinction), std::max(length, smallest_float), 4, 4);
    const glm::vec4 gap = table.gap(0.25F, 0.75F, length);
    const Quad exact = -exponential_less_one(-Quad(extinction) * Quad(length));
    finding.error(relative_error(static_cast<double>(gap.a), exact));
    finding.require(gap.g == 0.5F * gap.r && gap.b == 0.0F, "the colour of the field");
}

void add_extinction(std::vector<Case>& cases) {
    constexpr double bound = 4 * 0x1p-24;
    cases.push_back({"fields.extinction-0", Side::below, "extinction 0, and gaps of no length",
                     "nothing is seen: exactly 0", "relative", 0.0, [](Finding& finding) {
                         constant_gap(finding, 0.0F, 1.0F);
                         constant_gap(finding, 2.0F, 0.0F);
                     }});
    cases.push_back({"fields.extinction-thin", Side::at, "optical depths of 1e-30 to 1: 1 - exp(-x) cancels",
                     "1 - exp(-x) in 113 bits, to 4 half places of a float", "relative", bound, [](Finding& finding) {
                         for (const float length : {1e-30F, 1e-12F, 1e-6F, 1e-3F, 0.1F, 1.0F})
                             constant_gap(finding, 1.0F, length);
                     }});
    cases.push_back({"fields.extinction-1e6", Side::above, "extinction 1e6 and 3e38, gaps of 1 and 3e38",
                     "opacity 1, the colour of the field", "relative", bound, [](Finding& finding) {
                         for (const float extinction : {1e6F, 1e30F, largest_float})
                             for (const float length : {1.0F, largest_float}) constant_gap(finding, extinction, length);
                     }});
    cases.push_back({"fields.volume-below", Side::below, "a volume program with one sample and with none", "nothing",
                     "absolute", 0.0, [](Finding& finding) {
                         models::VolumeSetup setup;
                         setup.transfer = constant(5.0F);
                         const auto program = models::make_volume(setup);
                         for (const auto& samples : {std::vector<std::array<float, 2>>{}, {{{2.0F, 0.5F}}}})
                             for (const float value : state_after(*program, samples))
                                 finding.error(static_cast<double>(value));
                     }});
    cases.push_back(
        {"fields.volume-gaps", Side::at, "a constant field in 1, 5 and 1,000 gaps, two of them of no length",
         "the same opacity, 1 - exp(-2.8) in 113 bits", "relative", 2e-5, [](Finding& finding) {
             models::VolumeSetup setup;
             setup.transfer = constant(0.7F);
             setup.longest_gap = 10.0F;
             const auto program = models::make_volume(setup);
             for (const int gaps : {1, 5, 1000}) {
                 std::vector<std::array<float, 2>> samples{{1.0F, 0.5F}, {1.0F, 0.5F}};
                 for (int i = 1; i <= gaps; ++i)
                     samples.push_back({1.0F + 4.0F * static_cast<float>(i) / static_cast<float>(gaps), 0.3F});
                 samples.push_back({5.0F, 0.9F});
                 finding.error(relative_error(static_cast<double>(state_after(*program, samples)[3]),
                                              -exponential_less_one(-Quad(0.7F) * 4)));
             }
         }});
    cases.push_back({"fields.volume-above", Side::above, "10,000 gaps of extinction 1e6",
                     "opacity 1, never more; the colour of the field", "ulp", 1.0, [](Finding& finding) {
                         models::VolumeSetup setup;
                         setup.transfer = constant(1e6F);
                         const auto program = models::make_volume(setup);
                         std::vector<std::array<float, 2>> samples;
                         for (int i = 0; i < 10000; ++i) samples.push_back({static_cast<float>(i), 0.5F});
                         const auto state = state_after(*program, samples);
                         finding.error(ulps(state[3], 1.0F));
                         finding.error(ulps(state[0], 1.0F));
                         finding.error(ulps(state[1], 0.5F));
                     }});
    // Colour from 0 to 1 over a step of optical depth x: its far end weighs (1 - exp(-x) (1 + x)) / x.
    const auto weight = [](Finding& finding, std::initializer_list<double> depths, bool relative) {
        for (const double x : depths) {
            const models::PreintegratedTable table(
                {{0.0F, glm::vec3(0.0F), static_cast<float>(x)}, {1.0F, glm::vec3(1.0F), static_cast<float>(x)}}, 1.0F,
                2, 2);
            const glm::vec4 gap = table.gap(0.0F, 1.0F, 1.0F);
            const Quad depth(static_cast<float>(x)), through = exponential(-depth);
            const Quad exact = (1 - through * (1 + depth)) / depth;
            finding.error(relative ? relative_error(static_cast<double>(gap.r), exact)
                                   : static_cast<double>(gap.r) - static_cast<double>(exact));
        }
    };
    // The table steps through 32 parts, each thinner by that factor than the whole gap.
    cases.push_back({"fields.far-weight-below", Side::below,
                     "a colour ramp in gaps of optical depth 1e-12 to 3e-2: steps below 1e-3, where (1 - exp(-x)(1 + "
                     "x)) / x is a series",
                     "(1 - exp(-x) (1 + x)) / x in 113 bits", "relative", 4 * 0x1p-24, [weight](Finding& finding) {
                         weight(finding, {1e-12, 1e-8, 1e-4, 0.01, 0.031}, true);
                     }});
    cases.push_back({"fields.far-weight-at", Side::at,
                     "steps of optical depth 1e-3 and its neighbours: 32 of them are 0.032",
                     "both forms agree with 113 bits", "relative", 4 * 0x1p-24, [weight](Finding& finding) {
                         weight(finding, {0.0319999, 0.032, 0.0320001}, true);
                     }});
    cases.push_back({"fields.far-weight-above", Side::above, "a colour ramp in gaps of optical depth 0.04 to 1000",
                     "(1 - exp(-x) (1 + x)) / x in 113 bits", "of the brightest", 4 * 0x1p-24,
                     [weight](Finding& finding) {
                         weight(finding, {0.04, 0.5, 3.0, 50.0, 1000.0}, false);
                     }});
}

void add_scalars(std::vector<Case>& cases) {
    const auto opacity_frame = [](float lo, float hi) {
        traces::TetrahedralMesh mesh{
            "one", {{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {0, 0, 1}}, {lo, lo, lo, hi}, {{0, 1, 2, 3}}, {}};
        traces::Scene scene = traces::scene_of(std::move(mesh));
        scene.name = "one";
        traces::finish_scene(scene);
        const Replay replay(
            scene, {.width = 16, .height = 16, .workload = traces::ray_integral_load().workload, .threads = 1});
        for (const float value : replay.reference.picture)
            if (!std::isfinite(value) || value < 0.0F || value > 1.0F) return -1.0;
        double least = 1.0;
        for (std::size_t i = 0; i < replay.reference.picture.size(); i += 4)
            least = std::min(least, static_cast<double>(replay.reference.picture[i + 2]));
        return least;
    };
    cases.push_back({"fields.scalar-range-0", Side::below,
                     "a field that is 0 everywhere, 7 everywhere, 1e30 everywhere",
                     "a picture of one colour, finite, in which the tetrahedron is seen", "", 0.0,
                     [opacity_frame](Finding& finding) {
                         for (const float value : {0.0F, 7.0F, 1e30F}) {
                             const double seen = opacity_frame(value, value);
                             finding.require(seen >= 0.0 && seen < 0.9, fmt::format("{} everywhere", value));
                         }
                     }});
    cases.push_back({"fields.scalar-range-tiny", Side::at, "a field from 0 to 1e-30, and from 1 to the next float",
                     "a finite picture in which the tetrahedron is seen", "", 0.0, [opacity_frame](Finding& finding) {
                         for (const auto& [lo, hi] : {std::pair(0.0F, 1e-30F), std::pair(1.0F, next_up(1.0F))}) {
                             const double seen = opacity_frame(lo, hi);
                             finding.require(seen >= 0.0 && seen < 1.0, fmt::format("{} to {}", lo, hi));
                         }
                     }});
    cases.push_back({"fields.scalar-range-huge", Side::above,
                     "a field from -1e30 to 1e30: scalars are divided by a power of two",
                     "the picture of -1 to 1, finite", "", 0.0, [opacity_frame](Finding& finding) {
                         const double seen = opacity_frame(-1e30F, 1e30F), small = opacity_frame(-1.0F, 1.0F);
                         finding.require(seen >= 0.0 && std::fabs(seen - small) < 1e-3, "equal pictures");
                     }});
    cases.push_back(
        {"fields.zero-volume", Side::at, "a tetrahedron without volume between two that have some: flat, and a line",
         "its faces are drawn, what lies between them is empty: finite, the opacity of the others", "1/255", 0.01,
         [](Finding& finding) {
             traces::TetrahedralMesh mesh{"flat",
                                          {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, 0}, {0.5F, -1, 0}},
                                          {0, 0.5F, 1, 0.5F, 0.2F},
                                          {{0, 1, 2, 3}, {0, 1, 4, 4}},
                                          {}};
             traces::Scene scene = traces::scene_of(std::move(mesh));
             scene.name = "flat";
             traces::finish_scene(scene);
             const Replay replay(
                 scene, {.width = 16, .height = 16, .workload = traces::ray_integral_load().workload, .threads = 1});
             for (const float value : replay.reference.picture)
                 finding.error(static_cast<double>(1.0F - value) * 255.0);
         }});
    cases.push_back(
        {"fields.inverted", Side::whole, "a tetrahedron with two corners exchanged: its volume is negative",
         "the same faces and the same picture", "1/255", 0.01, [](Finding& finding) {
             const auto picture = [](std::array<std::uint32_t, 4> corners) {
                 traces::TetrahedralMesh mesh{
                     "one", {{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {0, 0, 1}}, {0, 0.3F, 0.6F, 1}, {corners}, {}};
                 traces::Scene scene = traces::scene_of(std::move(mesh));
                 scene.name = "one";
                 traces::finish_scene(scene);
                 return Replay(scene,
                               {.width = 16, .height = 16, .workload = traces::crossings_load().workload, .threads = 1})
                     .reference.picture;
             };
             const auto right = picture({0, 1, 2, 3}), inverted = picture({1, 0, 2, 3});
             for (std::size_t i = 0; i < right.size(); ++i)
                 finding.error(static_cast<double>(right[i] - inverted[i]) * 255.0);
             finding.require(*std::min_element(right.begin(), right.end()) < 1.0F, "something is seen");
         }});
}

models::IsosurfaceState crossings(const std::vector<std::array<float, 2>>& samples) {
    models::IsosurfaceSetup setup;
    setup.iso_values = {0.5F};
    const auto program = models::make_isosurface(setup);
    const auto state = state_after(*program, samples);
    return {state[0], state[1], state[2], state[3]};
}

void add_isosurfaces(std::vector<Case>& cases) {
    cases.push_back({"fields.iso-below", Side::below, "a segment that ends one float below the iso-value",
                     "no crossing", "hits", 0.0, [](Finding& finding) {
                         finding.error(static_cast<double>(crossings({{1, 0}, {2, next_down(0.5F)}}).hits));
                     }});
    cases.push_back(
        {"fields.iso-at", Side::at, "a segment that ends on the iso-value, and the next that begins there",
         "one crossing, at that sample", "hits", 0.0, [](Finding& finding) {
             const auto state = crossings({{1, 0}, {2, 0.5F}, {3, 1}});
             finding.error(static_cast<double>(state.hits) - 1.0);
             finding.error(ulps(state.distance, 2.0F));
             finding.error(static_cast<double>(crossings({{1, 0.5F}, {2, 0.5F}}).hits)); // s1 = s2: no division
         }});
    cases.push_back({"fields.iso-above", Side::above,
                     "segments one float around the iso-value, of no length, and out to the largest floats",
                     "one crossing, between the samples", "hits", 0.0, [](Finding& finding) {
                         for (const auto& samples : {std::vector<std::array<float, 2>>{{1, next_down(0.5F)}, {3, 0.5F}},
                                                     {{2, 0}, {2, 1}},
                                                     {{0, -largest_float}, {largest_float, largest_float}}}) {
                             const auto state = crossings(samples);
                             finding.error(static_cast<double>(state.hits) - 1.0);
                             finding.require(state.distance >= samples[0][0] && state.distance <= samples[1][0],
                                             "between");
                         }
                     }});
}

/// Rays of a view of 1x1 pixels, whose ray is the axis.
double transmittance(double sigma, double from, double to, bool fresnel, float cosine) {
    const pipeline::View view = perspective_view(1, 1, 60, 0.1, 1000);
    const traces::Translucency picture({sigma}, fresnel);
    const std::array<traces::TranslucentSurface, 2> surfaces{{{from, 0, cosine}, {to, 0, cosine}}};
    return picture.passage(surfaces, traces::ViewRays(view), 0, 0).transmittance;
}

void add_translucency(std::vector<Case>& cases) {
    cases.push_back({"fields.absorption-0", Side::below, "translucency: sigma 0, and a path of no length",
                     "all light: exactly 1", "relative", 0.0, [](Finding& finding) {
                         finding.error(transmittance(0.0, 1, 2, false, 1) - 1.0);
                         finding.error(transmittance(1e6, 2, 2, false, 1) - 1.0);
                     }});
    cases.push_back({"fields.absorption", Side::at, "translucency: sigma l from 1e-12 to 700",
                     "exp(-sigma l) in 113 bits", "relative", 2e-13, [](Finding& finding) {
                         for (const double depth : {1e-12, 1e-3, 1.0, 50.0, 700.0})
                             finding.error(
                                 relative_error(transmittance(depth, 1.0, 2.0, false, 1), exponential(-Quad(depth))));
                     }});
    cases.push_back({"fields.absorption-1e6", Side::above, "translucency: sigma 1e6 and 1e300",
                     "no light: 0, not negative and not NaN", "absolute", 0.0, [](Finding& finding) {
                         for (const double sigma : {1e6, 1e300}) finding.error(transmittance(sigma, 1, 2, false, 1));
                     }});
    cases.push_back({"fields.grazing-below", Side::below, "Fresnel: a surface seen edge on, cosine 0",
                     "no light: exactly 0", "absolute", 0.0,
                     [](Finding& finding) { finding.error(transmittance(0.0, 1, 2, true, 0.0F)); }});
    cases.push_back({"fields.grazing-at", Side::at, "Fresnel: cosines of 1e-7 to 0.5 at two interfaces",
                     "(1 - (1 - cos)^5)^2 in 113 bits", "relative", 1e-8, [](Finding& finding) {
                         for (const float cosine : {1e-7F, 1e-3F, 0.5F}) {
                             const Quad grazing = 1 - Quad(cosine),
                                        one = 1 - grazing * grazing * grazing * grazing * grazing;
                             finding.error(relative_error(transmittance(0.0, 1, 2, true, cosine), one * one));
                         }
                     }});
    cases.push_back({"fields.grazing-above", Side::above, "Fresnel: cosine 1", "all light: exactly 1", "relative", 0.0,
                     [](Finding& finding) { finding.error(transmittance(0.0, 1, 2, true, 1.0F) - 1.0); }});
    cases.push_back(
        {"fields.exit-missing", Side::whole,
         "translucency: a surface without a partner, as an open mesh or too few entries leave it",
         "it begins no length: all light", "absolute", 0.0, [](Finding& finding) {
             const traces::Translucency picture({5.0, 5.0}, false);
             const std::array<traces::TranslucentSurface, 3> surfaces{{{1.0, 0, 1}, {1.5, 1, 1}, {2.0, 0, 1}}};
             const auto passage =
                 picture.passage(surfaces, traces::ViewRays(perspective_view(1, 1, 60, 0.1, 1000)), 0, 0);
             finding.error((passage.inside - 1.0) * (std::fabs(passage.inside - 1.0) > 1e-12 ? 1 : 0));
         }});
}

void add_ranges(std::vector<Case>& cases) {
    const auto slot = [](float depth) { // which of two ranges takes a depth; -1: none
        const auto program = models::make_depth_partition({0.25F, 0.5F, 0.75F});
        std::vector<float> pixel(program->floats_per_pixel());
        program->clear(pixel.data());
        const std::array<float, 4> entry{1, 1, 1, depth};
        program->insert(pixel.data(), entry.data());
        return pixel[3] != models::empty_depth ? 0 : pixel[7] != models::empty_depth ? 1 : -1;
    };
    cases.push_back({"fields.range-below", Side::below, "depth partition: one float before each bound",
                     "the range before it; none before the first", "ranges", 0.0, [slot](Finding& finding) {
                         finding.error(slot(next_down(0.25F)) + 1);
                         finding.error(slot(next_down(0.5F)));
                         finding.error(slot(next_down(0.75F)) - 1);
                     }});
    cases.push_back({"fields.range-at", Side::at, "depth partition: depths on the bounds",
                     "the range that begins there; none at the last", "ranges", 0.0, [slot](Finding& finding) {
                         finding.error(slot(0.25F));
                         finding.error(slot(0.5F) - 1);
                         finding.error(slot(0.75F) + 1);
                     }});
    cases.push_back({"fields.range-above", Side::above,
                     "depth partition: one float behind each bound, far outside, NaN",
                     "the range that began there; none", "ranges", 0.0, [slot](Finding& finding) {
                         finding.error(slot(next_up(0.25F)));
                         finding.error(slot(next_up(0.5F)) - 1);
                         for (const float depth : {next_up(0.75F), 1.0F, infinity, -infinity, not_a_number})
                             finding.error(slot(depth) + 1);
                     }});
    const traces::Lens lens{.aperture = 0.5, .focal_length = 0.1, .focus = 5.0, .pixels_per_slope = 200.0};
    // A |z - z_f| / (z (z_f - f)) slopes, 200 pixels each.
    const auto exact = [](Quad z) { return Quad(0.5) * absolute(z - 5) / (z * (5 - Quad(0.1))) * 200; };
    cases.push_back({"fields.lens-near", Side::below, "circle of confusion at and before the lens: 0, 1e-300",
                     "none at the lens, finite before it", "pixels", 0.0, [lens](Finding& finding) {
                         finding.error(lens.circle_of_confusion(0.0));
                         finding.require(std::isfinite(lens.circle_of_confusion(1e-300)), "finite");
                     }});
    cases.push_back(
        {"fields.lens-focus", Side::at, "circle of confusion at the focus and within 1e-15 to 1 of it: z - z_f cancels",
         "0 at it; the formula in 113 bits", "relative", 1e-15, [lens, exact](Finding& finding) {
             finding.error(lens.circle_of_confusion(5.0));
             for (const double away : {1e-15, 1e-9, 1e-3, 1.0})
                 finding.error(relative_error(lens.circle_of_confusion(5.0 + away), exact(Quad(5.0 + away))));
         }});
    cases.push_back({"fields.lens-far", Side::above, "circle of confusion at 1e30 and at infinity",
                     "A / (z_f - f), finite; none at infinity", "relative", 1e-15, [lens, exact](Finding& finding) {
                         finding.error(relative_error(lens.circle_of_confusion(1e30), exact(1e30)));
                         finding.error(lens.circle_of_confusion(std::numeric_limits<double>::infinity()));
                     }});
}

} // namespace reports::stability::fields

std::vector<reports::stability::Case> reports::stability::field_cases() {
    std::vector<Case> cases;
    fields::add_extinction(cases);
    fields::add_scalars(cases);
    fields::add_isosurfaces(cases);
    fields::add_translucency(cases);
    fields::add_ranges(cases);
    return cases;
}
