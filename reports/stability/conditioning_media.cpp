// Absorption (A12), pre-integrated gaps (A16), the search region (A19, A20) and back-projection (A23).
#include "models/programs/preintegration.hpp"
#include "reports/stability/conditioning.hpp"
#include "reports/stability/curve_maker.hpp"
#include "reports/stability/scenes.hpp"
#include "reports/stability/shadow_setting.hpp"
#include "traces/workloads/translucency_picture.hpp"

namespace reports::stability {

namespace {

Curve absorption() {
    const auto transmittance = [](double depth) {
        const std::array<traces::TranslucentSurface, 2> surfaces{{{1.0, 0, 1.0F}, {2.0, 0, 1.0F}}};
        return traces::Translucency({depth}, false)
            .passage(surfaces, traces::ViewRays(perspective_view(1, 1, 60, 0.1, 100.0)), 0, 0)
            .transmittance;
    };
    return make_curve(
        "A12 absorption", "exp(-sigma l)",
        "lengths and sums in binary64; an error of sigma l is one of the result, so digits go with its size", "sigma l",
        1e-12, 700.0,
        {{"the program's", [=](double x) { return right_digits(transmittance(x), exponential(-Quad(x))); }},
         {"in floats", [=](double x) {
              return right_digits(static_cast<double>(std::exp(-static_cast<float>(x))), exponential(-Quad(x)));
          }}});
}

float gap_opacity(float extinction) {
    const glm::vec3 white(1.0F);
    return models::PreintegratedTable({{0.0F, white, extinction}, {1.0F, white, extinction}}, 1.0F, 2, 2)
        .gap(0.0F, 1.0F, 1.0F)
        .a;
}

Curve opacity() {
    return make_curve(
        "A16 opacity of a gap", "1 - exp(-x)", "expm1 (preintegration.cpp)", "optical depth x", 1e-12, 100.0,
        {{"the program's",
          [](double x) {
              const auto depth = static_cast<float>(x);
              return right_digits(static_cast<double>(gap_opacity(depth)), -exponential_less_one(-Quad(depth)));
          }},
         {"as printed, in floats", [](double x) {
              const auto depth = static_cast<float>(x);
              return right_digits(static_cast<double>(1.0F - std::exp(-depth)), -exponential_less_one(-Quad(depth)));
          }}});
}

Curve far_weight() {
    const auto exact = [](Quad x) { return (-exponential_less_one(-x) - x * exponential(-x)) / x; };
    // In 113 bits the formula itself cancels to 113 - 2 log2(1/x) bits: from 1e-10 on that is more than a double has.
    return make_curve("A16 colour of a ramp", "(1 - exp(-x) (1 + x)) / x",
                      "its series for steps thinner than 1e-3 (preintegration.cpp); the table interpolates, which "
                      "costs thick gaps digits of what is far below 1",
                      "optical depth x", 1e-9, 1000.0,
                      {{"the program's",
                        [=](double x) {
                            const auto depth = static_cast<float>(x);
                            const models::PreintegratedTable table(
                                {{0.0F, glm::vec3(0.0F), depth}, {1.0F, glm::vec3(1.0F), depth}}, 1.0F, 2, 2);
                            return right_digits(static_cast<double>(table.gap(0.0F, 1.0F, 1.0F).r), exact(Quad(depth)));
                        }},
                       {"as printed, in doubles",
                        [=](double x) {
                            const auto depth = static_cast<double>(static_cast<float>(x));
                            return right_digits((1.0 - std::exp(-depth) * (1.0 + depth)) / depth, exact(Quad(depth)));
                        }},
                       {"as printed, in floats", [=](double x) {
                            const auto depth = static_cast<float>(x);
                            return right_digits(static_cast<double>((1.0F - std::exp(-depth) * (1.0F + depth)) / depth),
                                                exact(Quad(depth)));
                        }}});
}

/// Depths as the map has them: floats, z_s = z (1 - x).
Curve search_region() {
    const auto behind = [](double x) { return static_cast<float>(10.0 * (1.0 - x)); };
    const auto exact = [=](double x) { return 1024 * (1 / Quad(behind(x)) - Quad(1) / 10); };
    return make_curve(
        "A19, A20 search region", "r l (n / w) (1 / z_min - 1 / z), z_min = z (1 - x), z = 10",
        "as (z - z_min) / z / z_min (shadow_kernel.cpp): z - z_min of floats is exact where they are near each other",
        "x", 0.9, 1e-7,
        {{"the program's",
          [=](double x) {
              return right_digits(
                  static_cast<double>(traces::search_width(shadows::unit_light(), 1024, behind(x), 10.0F)), exact(x));
          }},
         {"as printed, in floats", [=](double x) {
              return right_digits(static_cast<double>(1024.0F * (1.0F / behind(x) - 1.0F / 10.0F)), exact(x));
          }}});
}

Curve back_projection() {
    const auto occluder = [](double x) { return static_cast<float>(10.0 * (1.0 - x)); };
    // A light so wide that no bound is reached: the area is the square of the texel's width on it.
    constexpr double width = 1e6;
    const auto exact = [=](double x) {
        const Quad z = 10, z_s = occluder(x), scale = z_s * z / (z - z_s) / 1024 / Quad(width);
        return scale * scale;
    };
    return make_curve(
        "A23 back-projection", "w / (n r) z_s z / (z - z_s) / l, squared, z_s = z (1 - x), z = 10",
        "z - z_s of floats is exact; what it lost was lost when the depths were rounded. z / (z - z_s) comes first, so "
        "nothing overflows (shadow_kernel.cpp)",
        "x", 0.9, 1e-7,
        {{"the program's",
          [=](double x) {
              return right_digits(static_cast<double>(traces::covered_share(shadows::unit_light(width), 1024, 0, 0,
                                                                            0.5F, occluder(x), 10.0F)),
                                  exact(x));
          }},
         {"with depths in halves", [=](double x) {
              const auto half = [](double z) {
                  return traces::through_shadow_format(traces::ShadowFormat::rgba16f, static_cast<float>(z));
              };
              return right_digits(static_cast<double>(traces::covered_share(shadows::unit_light(width), 1024, 0, 0,
                                                                            0.5F, half(10.0 * (1.0 - x)), half(10.0))),
                                  exact(x));
          }}});
}

} // namespace

std::vector<Curve> medium_curves() {
    return {absorption(), opacity(), far_weight(), search_region(), back_projection()};
}

} // namespace reports::stability
