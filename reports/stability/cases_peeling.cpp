// Multi-pass peeling with a constant added to the captured depth (specification 004, A10 and section 6.1, items 4 to 6
// and 10).
#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/raster_state.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "reports/stability/replay.hpp"
#include "reports/stability/scenes.hpp"
#include "traces/loads.hpp"
#include "traces/shadows/shadow_map.hpp"

#include <fmt/format.h>

namespace reports::stability::peeling {

/// Layers that peeling finds in one pixel with fragments at these depths.
std::vector<float> layers_found(std::span<const float> depths, const std::vector<std::string>& settings) {
    const Replay replay(layers_of(2, 2, depths), {.width = 2, .height = 2, .knobs = {"entry=z", "k=4"}, .threads = 1});
    const pipeline::RunResult run = replay.run("multipass", settings);
    std::vector<float> found;
    for (std::size_t i = 0; i < 4; ++i)
        if (run.kbuffer[i] <= 1.0F) found.push_back(run.kbuffer[i]);
    return found;
}

std::vector<std::string> eps_rule(double eps, const char* format) {
    return {"multipass.rule=eps", fmt::format("multipass.eps={}", eps),
            fmt::format("multipass.depth_format={}", format)};
}

/// The values of the specification; the pair of depths stands on the side asked for, in exact arithmetic.
constexpr std::array sweep{6e-8, 1e-6, 1e-5, 1e-4, 1e-3};

float second_depth(float first, double eps, Side side) {
    auto second = static_cast<float>(static_cast<double>(first) + eps);
    while (Quad(second) < Quad(first) + Quad(eps)) second = next_up(second);
    while (Quad(next_down(second)) >= Quad(first) + Quad(eps)) second = next_down(second);
    return side == Side::below ? next_down(second) : second;
}

void sweep_eps(Finding& finding, Side side, std::size_t layers) {
    for (const double eps : sweep) {
        const std::array depths{0.25F, second_depth(0.25F, eps, side)};
        finding.error(static_cast<double>(layers_found(depths, eps_rule(eps, "d32f")).size()) -
                      static_cast<double>(layers));
    }
}

void add_eps_sweep(std::vector<Case>& cases) {
    cases.push_back({"peeling.eps-below", Side::below,
                     "peeling, eps 6e-8 to 1e-3: the second surface one float nearer than eps behind the first",
                     "one layer: the second surface is lost", "layers", 0.0,
                     [](Finding& finding) { sweep_eps(finding, Side::below, 1); }});
    cases.push_back({"peeling.eps-at", Side::at,
                     "peeling, eps 6e-8 to 1e-3: the second surface at the first float eps behind the first",
                     "two layers", "layers", 0.0, [](Finding& finding) { sweep_eps(finding, Side::at, 2); }});
    cases.push_back({"peeling.eps-above", Side::above, "peeling, eps 6e-8 to 1e-3: four surfaces 2 eps apart",
                     "four layers", "layers", 0.0, [](Finding& finding) {
                         for (const double eps : sweep) {
                             std::array<float, 4> depths{};
                             for (std::size_t i = 0; i < 4; ++i)
                                 depths[i] = static_cast<float>(0.25 + 2.0 * eps * static_cast<double>(i));
                             finding.error(static_cast<double>(layers_found(depths, eps_rule(eps, "d32f")).size()) - 4);
                         }
                     }});
}

void add_eps_zero(std::vector<Case>& cases) {
    cases.push_back({"peeling.eps-zero-captures-itself", Side::below,
                     "eps 0 on D24: a depth that the format rounds down lies behind its own layer",
                     "the one surface is found four times", "layers", 0.0, [](Finding& finding) {
                         // An odd multiple of 2^-25 lies between two codes; below 1/2 it is rounded down. On the screen
                         // it keeps its depth.
                         const float down = 3355443.0F * 0x1p-25F;
                         const std::array depths{down};
                         finding.error(static_cast<double>(layers_found(depths, eps_rule(0.0, "d24")).size()) - 4.0);
                     }});
    cases.push_back({"peeling.eps-half-quantum", Side::at,
                     "eps 2^-25, half a D24 quantum, on D24: the most that rounding moves a depth",
                     "each of 200 surfaces is found once", "layers", 0.0, [](Finding& finding) {
                         for (int i = 0; i < 200; ++i) {
                             const std::array depths{0.003F + 0.0049F * static_cast<float>(i)};
                             finding.error(static_cast<double>(layers_found(depths, eps_rule(0x1p-25, "d24")).size()) -
                                           1.0);
                         }
                     }});
    cases.push_back({"peeling.eps-zero-floats", Side::above, "eps 0 on D32F: two equal depths, then the next float",
                     "depth >= depth: the first surface is found again and again", "layers", 0.0, [](Finding& finding) {
                         const std::array depths{0.5F, next_up(0.5F)};
                         const auto found = layers_found(depths, eps_rule(0.0, "d32f"));
                         finding.error(static_cast<double>(found.size()) - 4.0);
                         for (const float depth : found) finding.error(ulps(depth, 0.5F));
                     }});
    cases.push_back({"peeling.exact-rule", Side::whole, "the exact rule on D32F: equal depths, then the next float",
                     "three layers, none lost, none twice", "layers", 0.0, [](Finding& finding) {
                         const std::array depths{0.5F, 0.5F, next_up(0.5F)};
                         const auto found = layers_found(depths, {"multipass.rule=exact"});
                         finding.error(static_cast<double>(found.size()) - 3.0);
                         finding.require(found == std::vector<float>{0.5F, 0.5F, next_up(0.5F)}, "in their order");
                     }});
}

/// Window depth at distance z of a perspective with planes n and f, in 113 bits: f (z - n) / (z (f - n)).
Quad window(Quad z, Quad n, Quad f) { return f * (z - n) / (z * (f - n)); }

/// Gap behind distance z that eps removes, in first order: eps z^2 (f - n) / (f n).
struct Setting {
    double n, f, z, gap; ///< `gap` as printed in section 6.1, item 5
};
constexpr std::array settings{Setting{1, 100, 10, 0.0099}, Setting{1, 100, 50, 0.248}, Setting{1, 100, 100, 0.99},
                              Setting{5, 100, 50, 0.0475}};

void world_gap(Finding& finding, double share, std::size_t layers) {
    for (const Setting& one : settings) {
        if (one.z + share * one.gap * 1.02 > one.f) continue; // the second surface would lie behind the far plane
        const std::array depths{static_cast<float>(window(one.z, one.n, one.f)),
                                static_cast<float>(window(one.z + share * one.gap, one.n, one.f))};
        finding.error(static_cast<double>(layers_found(depths, eps_rule(1e-4, "d24")).size()) -
                      static_cast<double>(layers));
    }
}

void add_world_gaps(std::vector<Case>& cases) {
    cases.push_back({"peeling.world-gap-below", Side::below,
                     "eps 1e-4 on D24, planes of the specification: a gap 2 % below eps z^2 (f-n)/(f n)",
                     "one layer: 0.0099 at z = 10, 0.248 at z = 50, 0.0475 with n = 5", "layers", 0.0,
                     [](Finding& finding) { world_gap(finding, 0.97, 1); }});
    cases.push_back({"peeling.world-gap-at", Side::at,
                     "the distance of the window depth eps behind a surface, through the program's own conversion",
                     "the printed gaps, to the half of their last digit and the second order", "relative", 0.02,
                     [](Finding& finding) {
                         for (const Setting& one : settings) {
                             const pipeline::EyeDepth depth(perspective_view(2, 2, 60, one.n, one.f).projection);
                             // Backwards: behind the far plane there is none.
                             const double before = depth.distance(depth.window(one.z) - 1e-4F);
                             const double second_order = 1.0 - one.gap / one.z;
                             finding.error((depth.distance(depth.window(one.z)) - before) / one.gap / second_order -
                                           1.0);
                         }
                     }});
    cases.push_back({"peeling.world-gap-above", Side::above,
                     "eps 1e-4 on D24: a gap 4 % above eps z^2 (f-n)/(f n), first and second order", "two layers",
                     "layers", 0.0, [](Finding& finding) { world_gap(finding, 1.04, 2); }});
}

/// Codes of 16-bit floats for two window depths `gap` quanta of [0.5, 1) apart, 2^-11 each.
std::size_t distinct_halves(double gap) {
    const auto half = [](double depth) {
        return traces::through_shadow_format(traces::ShadowFormat::rgba16f, static_cast<float>(depth));
    };
    return half(0.75) == half(0.75 + gap * 0x1p-11) ? 1 : 2;
}

void add_half_depths(std::vector<Case>& cases) {
    const char* subject = "window depths in 16-bit floats: quantum 2^-11 = 4.9e-4 in [0.5, 1), above eps = 1e-4";
    cases.push_back(
        {"peeling.half-depth-below", Side::below, std::string(subject) + "; 1e-4 apart", "one depth", "depths", 0.0,
         [](Finding& finding) { finding.error(static_cast<double>(distinct_halves(1e-4 / 0x1p-11)) - 1.0); }});
    cases.push_back({"peeling.half-depth-at", Side::at, std::string(subject) + "; half a quantum apart, a tie",
                     "one depth: 0.75 is even", "depths", 0.0,
                     [](Finding& finding) { finding.error(static_cast<double>(distinct_halves(0.5)) - 1.0); }});
    cases.push_back({"peeling.half-depth-above", Side::above, std::string(subject) + "; 0.51 of a quantum apart",
                     "two depths", "depths", 0.0,
                     [](Finding& finding) { finding.error(static_cast<double>(distinct_halves(0.51)) - 2.0); }});
}

pipeline::SurfaceFormat format_of(const std::string& name) {
    return name == "d16" ? pipeline::SurfaceFormat::d16 : pipeline::SurfaceFormat::d24;
}
double quantum_of(const std::string& name) { return name == "d16" ? 1.0 / 65535 : 1.0 / 16777215; }

/// Of 8 phases of the quantum, those in which the first drawn of two surfaces stays, the second `quanta` in front of
/// it. Near 0.004 floats are finer than both formats by far.
int first_wins(const std::string& format, double quanta) {
    int wins = 0;
    for (int phase = 0; phase < 8; ++phase) {
        const double near = 0.0039 + (phase + 0.4) / 8.0 * quantum_of(format);
        const auto code = [&](double depth) {
            return pipeline::depth_code(format_of(format), static_cast<float>(depth));
        };
        const auto compare = pipeline::DepthState().compare;
        wins += passes(compare, code(near), code(near + quanta * quantum_of(format))) ? 0 : 1;
    }
    return wins;
}

/// Frames of two planes over 4x4 pixels, the farther one first; pixels whose depth is not that of the nearer one.
int wrong_pixels_of_planes(const std::string& format, double quanta) {
    int wrong = 0;
    for (int phase = 0; phase < 8; ++phase) {
        const double near = 0.3 + (phase + 0.4) / 8.0 * quantum_of(format);
        const std::array depths{static_cast<float>(near + quanta * quantum_of(format)), static_cast<float>(near)};
        const Replay replay(layers_of(4, 4, depths), {.width = 4,
                                                      .height = 4,
                                                      .workload = traces::nearest_surface_load().workload,
                                                      .knobs = {"depth_format=" + format},
                                                      .threads = 1});
        const auto code = pipeline::depth_code(format_of(format), depths[1]);
        const pipeline::RunResult run = replay.run("existing");
        for (const float depth : run.depth) wrong += pipeline::depth_code(format_of(format), depth) == code ? 0 : 1;
    }
    return wrong;
}

void add_z_fighting(std::vector<Case>& cases) {
    const auto wins = [](Finding& finding, double quanta, int expected) {
        for (const char* format : {"d16", "d24"}) finding.error(first_wins(format, quanta) - expected);
    };
    cases.push_back({"z-fighting.equal-planes", Side::at,
                     "two surfaces at one depth on D16 and D24, 8 phases of the quantum", "the first drawn wins 8 of 8",
                     "wins", 0.0, [wins](Finding& finding) { wins(finding, 0.0, 8); }});
    cases.push_back({"z-fighting.half-quantum", Side::below,
                     "the nearer surface half a quantum in front, drawn last: 8 phases of the quantum",
                     "the first drawn wins in 4 of 8 phases: z fighting", "wins", 0.0,
                     [wins](Finding& finding) { wins(finding, 0.5, 4); }});
    cases.push_back({"z-fighting.whole-quantum", Side::above,
                     "the nearer surface 1.01 quanta in front, drawn last: 8 phases of the quantum",
                     "the nearer one wins everywhere", "wins", 0.0,
                     [wins](Finding& finding) { wins(finding, 1.01, 0); }});
    cases.push_back({"z-fighting.frame", Side::whole,
                     "frames of two planes 2 quanta apart on D16 and D24, farther first",
                     "every pixel has the nearer depth", "pixels", 0.0, [](Finding& finding) {
                         for (const char* format : {"d16", "d24"}) finding.error(wrong_pixels_of_planes(format, 2.0));
                     }});
    cases.push_back({"z-fighting.coplanar-triangulations", Side::whole,
                     "one slanted plane, once as two triangles and once as a fan of six others",
                     "the same depth in every pixel, to what rounding the corners leaves", "ulp", 8.0,
                     [](Finding& finding) {
                         const auto plane = [](float x, float y) {
                             return glm::vec3(x, y, 0.2F + x / 256.0F + y / 512.0F); // exact for eighths of a pixel
                         };
                         const auto depths_of = [&](const std::vector<std::array<glm::vec2, 3>>& parts) {
                             std::vector<ScreenTriangle> triangles;
                             for (const auto& part : parts)
                                 triangles.push_back({plane(part[0].x, part[0].y), plane(part[1].x, part[1].y),
                                                      plane(part[2].x, part[2].y)});
                             traces::Scene scene = screen_scene(triangles);
                             const pipeline::FragmentStream stream = rasterized(scene, pixel_view(64, 64));
                             std::vector<float> depths(std::size_t{64} * 64, -1.0F);
                             for (std::size_t i = 0; i < stream.quads.size(); ++i)
                                 for (std::size_t lane = 0; lane < 4; ++lane)
                                     if ((stream.quads[i].covered >> lane & 1U) != 0)
                                         depths[(stream.quads[i].y + lane / 2) * 64 + stream.quads[i].x + lane % 2] =
                                             stream.depths[i][lane];
                             return depths;
                         };
                         const glm::vec2 a(0, 0), b(0, 64), c(64, 64), d(64, 0), m(23.1237F, 41.3761F);
                         const auto two = depths_of({{a, b, c}, {a, c, d}});
                         const auto fan = depths_of({{a, b, m}, {b, c, m}, {c, d, m}, {d, a, m}});
                         for (std::size_t i = 0; i < two.size(); ++i) finding.error(ulps(fan[i], two[i]));
                     }});
}

} // namespace reports::stability::peeling

std::vector<reports::stability::Case> reports::stability::peeling_cases() {
    std::vector<Case> cases;
    peeling::add_eps_sweep(cases);
    peeling::add_eps_zero(cases);
    peeling::add_world_gaps(cases);
    peeling::add_half_depths(cases);
    peeling::add_z_fighting(cases);
    return cases;
}
