// Depth reconstruction, path lengths (A12), circles of confusion (A14), perspective interpolation, level of detail.
#include "reports/stability/conditioning.hpp"

#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/functional/interpolation.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/functional/texture_sampler.hpp"
#include "reports/stability/curve_maker.hpp"
#include "reports/stability/scenes.hpp"
#include "traces/view_rays.hpp"
#include "traces/workloads/lens_blur.hpp"

namespace reports::stability {

namespace {

/// From the entries of the matrix, in 113 bits.
Quad distance_of(const glm::mat4& m, Quad window) {
    const Quad n = 2 * window - 1;
    return Quad(m[3][2]) / (Quad(m[2][2]) + n); // of a perspective: m23 = -1, m33 = 0
}

Curve depth_reconstruction(std::string id, double near, double far) {
    const glm::mat4 matrix = perspective_view(4, 4, 60, near, far).projection;
    const pipeline::EyeDepth depth(matrix);
    const auto window_at = [](double before_far) { return static_cast<float>(1.0 - before_far); };
    return make_curve(
        std::move(id), fmt::format("distance of a window depth, planes {} and {}: m32 / (m22 + 2 w - 1)", near, far),
        "the whole numbers of the matrix are joined before w is added (eye_depth.cpp): nothing cancels twice",
        "1 - window depth", 0.99, 6e-8,
        {{"the program's",
          [=](double x) {
              return right_digits(depth.distance(window_at(x)), distance_of(matrix, Quad(window_at(x))));
          }},
         {"as printed, in floats", [=](double x) {
              const float n = 2.0F * window_at(x) - 1.0F;
              return right_digits(static_cast<double>(matrix[3][2] / (matrix[2][2] + n)),
                                  distance_of(matrix, Quad(window_at(x))));
          }}});
}

/// Length between surfaces at 10 and a share behind, through window depths in a format.
Curve path_length() {
    const pipeline::View view = perspective_view(64, 64, 60, 0.1, 100.0);
    const traces::ViewRays rays(view);
    const pipeline::EyeDepth depth(view.projection);
    const auto stored = [=](double distance, pipeline::SurfaceFormat format) {
        return pipeline::depth_value(format, pipeline::depth_code(format, depth.window(distance)));
    };
    const glm::dvec3 way = rays.place(40, 20, 1.0);
    const Quad slope = square_root(Quad(way.x) * way.x + Quad(way.y) * way.y + Quad(way.z) * way.z);
    const auto length = [=](double gap, pipeline::SurfaceFormat format) {
        return rays.length(40, 20, depth.distance(stored(10.0, format)),
                           depth.distance(stored(10.0 * (1.0 + gap), format)));
    };
    return make_curve(
        "A12 path length", "l = back - front, surfaces at 10 and 10 (1 + x), planes 0.1 and 100",
        "none can: digits are lost where the depth format rounds; the difference itself is exact in binary64", "x", 1.0,
        1e-12,
        {{"of distances",
          [=](double gap) {
              return right_digits(rays.length(40, 20, 10.0, 10.0 * (1.0 + gap)),
                                  slope * (Quad(10.0 * (1.0 + gap)) - 10));
          }},
         {"through D32F",
          [=](double gap) {
              return right_digits(length(gap, pipeline::SurfaceFormat::d32f), slope * Quad(10) * Quad(gap));
          }},
         {"through D24",
          [=](double gap) {
              return right_digits(length(gap, pipeline::SurfaceFormat::d24), slope * Quad(10) * Quad(gap));
          }},
         {"through D16", [=](double gap) {
              return right_digits(length(gap, pipeline::SurfaceFormat::d16), slope * Quad(10) * Quad(gap));
          }}});
}

Curve circle_of_confusion() {
    const traces::Lens lens{.aperture = 0.5, .focal_length = 0.1, .focus = 5.0, .pixels_per_slope = 200.0};
    const auto exact = [](double z) { return Quad(0.5) * absolute(Quad(z) - 5) / (Quad(z) * (5 - Quad(0.1))) * 200; };
    return make_curve(
        "A14 circle of confusion", "A |z - z_f| / (z (z_f - f)), z = z_f (1 + x)",
        "distances stay in binary64, in which z - z_f is exact near the focus (lens_blur.cpp)", "x", 1.0, 1e-15,
        {{"the program's",
          [=](double x) { return right_digits(lens.circle_of_confusion(5.0 * (1.0 + x)), exact(5.0 * (1.0 + x))); }},
         {"distances as floats", [=](double x) {
              return right_digits(lens.circle_of_confusion(static_cast<double>(static_cast<float>(5.0 * (1.0 + x)))),
                                  exact(5.0 * (1.0 + x)));
          }}});
}

/// Share of a corner whose w is x times that of the others, at the middle of the screen.
Curve perspective_weights() {
    const auto corners_of = [](double ratio) {
        const pipeline::Viewport viewport(64, 64);
        const std::array<glm::vec2, 3> at{{{-1, -1}, {-1, 130}, {130, -1}}};
        std::array<pipeline::ScreenVertex, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const float w = i == 1 ? static_cast<float>(ratio) : 1.0F;
            corners[i].clip = {(at[i].x / 32.0F - 1.0F) * w, (1.0F - at[i].y / 32.0F) * w, 0.0F, w};
            viewport.project(corners[i]);
        }
        return corners;
    };
    const auto shares = [=](double ratio, bool by_floats) {
        const auto corners = corners_of(ratio);
        std::array<Quad, 3> share{};
        std::array<float, 3> rounded{};
        for (std::size_t i = 0; i < 3; ++i) {
            const pipeline::ScreenVertex &a = corners[(i + 1) % 3], &b = corners[(i + 2) % 3];
            share[i] =
                (Quad(b.x - a.x) * (30 * 256 - a.y) - Quad(b.y - a.y) * (20 * 256 - a.x)) / Quad(corners[i].clip.w);
            const float fx = static_cast<float>(b.x - a.x) * (30 * 256.0F - static_cast<float>(a.y)),
                        fy = static_cast<float>(b.y - a.y) * (20 * 256.0F - static_cast<float>(a.x));
            rounded[i] = (fx - fy) / corners[i].clip.w;
        }
        const Quad exact = share[1] / (share[0] + share[1] + share[2]);
        if (by_floats)
            return right_digits(static_cast<double>(rounded[1] / (rounded[0] + rounded[1] + rounded[2])), exact);
        const auto raster = pipeline::set_up(corners[0], corners[1], corners[2], pipeline::Viewport(64, 64));
        return right_digits(static_cast<double>(pipeline::AttributePlanes(raster, corners).at(20, 30, 15).of1[0]),
                            exact);
    };
    return make_curve(
        "perspective interpolation", "(e1 / w1) / (e0 / w0 + e1 / w1 + e2 / w2), w1 = x, w0 = w2 = 1",
        "edge functions are integers, exact in binary64 (raster_triangle.hpp); one rounding to a float at the end", "x",
        1e-15, 1e15,
        {{"the program's", [=](double ratio) { return shares(ratio, false); }},
         {"edges in floats", [=](double ratio) { return shares(ratio, true); }}});
}

Curve level_of_detail() {
    pipeline::Texture texture;
    for (std::uint32_t size = 1024; size > 0; size /= 2)
        texture.levels.push_back({size, size, std::vector<std::uint8_t>(std::size_t{size} * size * 4), 0});
    const auto shared = std::make_shared<const pipeline::Texture>(std::move(texture));
    const auto step_of = [](double more) { return static_cast<float>((1.0 + more) / 1024.0); };
    const auto exact = [=](double more) { return logarithm(Quad(step_of(more)) * 1024) / logarithm(2); };
    return make_curve(
        "level of detail", "log2 of the texels between pixels, texels = 1 + x",
        "squares are formed in binary64 (texture_sampler.cpp), so that the excess over 1 keeps a float's digits", "x",
        2e-7, 1000.0,
        {{"the program's",
          [=](double more) {
              pipeline::QuadTexcoords at;
              at.u = {0.0F, step_of(more), 0.0F, step_of(more)};
              return right_digits(static_cast<double>(pipeline::TextureSampler(*shared).level_of_detail(at)),
                                  exact(more));
          }},
         {"squares in floats", [=](double more) {
              const float texels = step_of(more) * 1024.0F;
              return right_digits(static_cast<double>(0.5F * std::log2(texels * texels)), exact(more));
          }}});
}

} // namespace

std::vector<Curve> distance_curves() {
    return {depth_reconstruction("depth reconstruction", 0.1, 100.0),
            depth_reconstruction("depth reconstruction, far", 1e-4, 1e10),
            path_length(),
            circle_of_confusion(),
            perspective_weights(),
            level_of_detail()};
}

std::vector<Curve> conditioning_curves() {
    std::vector<Curve> curves = distance_curves();
    for (Curve& curve : medium_curves()) curves.push_back(std::move(curve));
    return curves;
}

} // namespace reports::stability
