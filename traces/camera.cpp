#include "traces/camera.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace traces {

namespace {

// Everything is computed in double and rounded once, at the end.

struct Sphere {
    glm::dvec3 centre{0.0};
    double radius = 0.0;
};

Sphere bounding_sphere(const Scene& scene) {
    const double radius = static_cast<double>(scene.radius);
    return {(glm::dvec3(scene.lo) + glm::dvec3(scene.hi)) / 2.0, radius > 0.0 ? radius : 1.0};
}

glm::dmat4 perspective(double fovy, double aspect, double near, double far) {
    return far > 0.0 ? glm::perspectiveRH_NO(fovy, aspect, near, far) : glm::infinitePerspectiveRH(fovy, aspect, near);
}

glm::dmat4 look_at(const glm::dvec3& eye, const glm::dvec3& target) {
    const glm::dvec3 forward = glm::normalize(target - eye);
    const bool upright = std::abs(forward.y) < 0.9999;
    return glm::lookAtRH(eye, target, upright ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, -1.0));
}

pipeline::View view_of(const glm::dmat4& view, const glm::dmat4& projection, std::uint32_t width,
                       std::uint32_t height) {
    return {glm::mat4(view), glm::mat4(projection), width, height};
}

double aspect_of(std::uint32_t width, std::uint32_t height) {
    return static_cast<double>(width) / static_cast<double>(height);
}

// One unit of the scene is one pixel (or a part of the viewport); row 0 is at y = +1 in clip space.
pipeline::View screen_view(const Scene& scene, std::uint32_t width, std::uint32_t height) {
    const double across = scene.screen_extent.x > 0.0F ? static_cast<double>(scene.screen_extent.x) : width;
    const double down = scene.screen_extent.y > 0.0F ? static_cast<double>(scene.screen_extent.y) : height;
    glm::dmat4 projection(1.0);
    projection[0][0] = 2.0 / across;
    projection[1][1] = -2.0 / down;
    projection[2][2] = 2.0;
    projection[3] = glm::dvec4(-1.0, 1.0, -1.0, 1.0);
    return view_of(glm::dmat4(1.0), projection, width, height);
}

pipeline::View fitting_view(const Scene& scene, std::uint32_t width, std::uint32_t height) {
    const Sphere sphere = bounding_sphere(scene);
    const double aspect = aspect_of(width, height);
    const double fovy = std::numbers::pi / 4.0;
    const double fovx = 2.0 * std::atan(std::tan(fovy / 2.0) * aspect);
    const double distance = sphere.radius / std::sin(std::min(fovx, fovy) / 2.0);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.3, 0.25, 1.0));
    // A little slack keeps the nearest and the farthest point of a round scene inside the clip volume.
    const double near = (distance - sphere.radius) * 0.99;
    const double far = (distance + sphere.radius) * 1.01;
    return view_of(look_at(sphere.centre + direction * distance, sphere.centre), perspective(fovy, aspect, near, far),
                   width, height);
}

struct Planes {
    double near = 0.0, far = 0.0; ///< far: 0 = infinite
};

/// Of 24 bits, how many the part of the depth range from `nearest` to `farthest` has.
double depth_codes(const Camera& camera, Planes planes, double nearest, double farthest) {
    constexpr double all = 1U << 24U;
    if (camera.orthographic) return all * (farthest - nearest) / (planes.far - planes.near);
    const double end = planes.far > 0.0 ? planes.far / (planes.far - planes.near) : 1.0;
    return all * end * planes.near * (1.0 / nearest - 1.0 / farthest);
}

/// The camera's planes, or nearer ones where those leave the scene too few depths. The bounding sphere counts, not the
/// box: a flat scene seen from the front is not to be stretched over all depths.
Planes planes_of(const Scene& scene, const Camera& camera, const glm::dmat4& view, std::vector<std::string>* notes) {
    constexpr double fewest_codes = 4096, slack = 0.01;
    const Planes given{static_cast<double>(camera.near), static_cast<double>(camera.far)};
    const Sphere sphere = bounding_sphere(scene);
    const double middle = -(view * glm::dvec4(sphere.centre, 1.0)).z;
    const double end = given.far > 0.0 ? given.far : INFINITY;
    const double nearest = std::max(given.near, middle - sphere.radius);
    const double farthest = std::min(end, middle + sphere.radius);
    if (!(nearest < farthest)) return given; // nothing is seen
    const double codes = depth_codes(camera, given, nearest, farthest);
    if (codes >= fewest_codes) return given;
    const double margin = slack * sphere.radius;
    const Planes pulled{std::max({given.near, nearest - margin, camera.orthographic ? 0.0 : nearest / 2.0}),
                        std::min(end, farthest + margin)};
    if (notes != nullptr)
        notes->push_back(fmt::format(
            "the camera's near and far planes, {:g} and {}, leave the scene {} depths of 24 bits: they are moved "
            "to {:.6g} and {:.6g}",
            camera.near, given.far > 0.0 ? fmt::format("{:g}", camera.far) : "infinity", std::floor(codes), pulled.near,
            pulled.far));
    return pulled;
}

pipeline::View camera_view(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                           std::vector<std::string>* notes) {
    const glm::dmat4 view = glm::inverse(glm::dmat4(camera.to_world));
    // The viewport's aspect ratio, not the camera's: pixels are square.
    const double aspect = aspect_of(width, height);
    const auto [near, far] = planes_of(scene, camera, view, notes);
    if (camera.orthographic) {
        const double y = static_cast<double>(camera.ymag), x = y * aspect;
        return view_of(view, glm::orthoRH_NO(-x, x, -y, y, near, far), width, height);
    }
    return view_of(view, perspective(static_cast<double>(camera.fovy), aspect, near, far), width, height);
}

constexpr std::size_t matrix_numbers = 32; ///< of view and projection

pipeline::View matrix_view(const std::vector<double>& numbers, std::uint32_t width, std::uint32_t height) {
    const auto matrix = [&](std::size_t first) {
        glm::dmat4 result;
        for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = numbers[first + static_cast<std::size_t>(i)];
        return result;
    };
    const glm::dmat4 view = matrix(0), projection = matrix(16);
    const auto last_row = [](const glm::dmat4& m) { return glm::dvec4(m[0][3], m[1][3], m[2][3], m[3][3]); };
    const glm::dvec4 affine(0, 0, 0, 1), perspective(0, 0, -1, 0);
    const bool good = last_row(view) == affine && glm::determinant(glm::mat3(glm::mat4(view))) != 0.0F &&
                      (last_row(projection) == affine || last_row(projection) == perspective) &&
                      projection[0][0] * projection[1][1] != 0.0;
    if (!good)
        throw sim::InputError("camera: expected 32 numbers that are a view and a projection matrix, column by column");
    return view_of(view, projection, width, height);
}

/// Depths of the bounding box along the view direction, as near and far plane that enclose what is in front of the eye.
std::array<double, 2> enclosing_planes(const Scene& scene, const glm::dmat4& view) {
    double nearest = INFINITY, farthest = -INFINITY;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1) != 0 ? scene.hi.x : scene.lo.x, (i & 2) != 0 ? scene.hi.y : scene.lo.y,
                                (i & 4) != 0 ? scene.hi.z : scene.lo.z);
        const double depth = -(view * glm::dvec4(corner, 1.0)).z;
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    const double slack = 0.01 * bounding_sphere(scene).radius;
    const double far = farthest > 0.0 ? farthest + slack : 1.0; // the scene may lie behind the eye
    // A far plane at most 1000 times as far as the near one leaves 14 of 24 depth bits to the scene's far half.
    return {std::max(nearest - slack, far / 1000.0), far};
}

pipeline::View free_view(const Scene& scene, const std::string& text, const std::vector<double>& n, std::uint32_t width,
                         std::uint32_t height) {
    const glm::dvec3 eye(n[0], n[1], n[2]), target(n[3], n[4], n[5]);
    if (!(glm::distance(eye, target) > 0.0))
        throw sim::InputError(fmt::format("camera '{}': expected a target that is not the eye", text));
    if (!(n[6] > 0.0 && n[6] < 180.0))
        throw sim::InputError(
            fmt::format("camera '{}': fovy: expected more than 0 and less than 180 degrees, got {}", text, n[6]));
    const glm::dmat4 view = look_at(eye, target);
    const auto planes = enclosing_planes(scene, view);
    return view_of(view, perspective(n[6] * std::numbers::pi / 180.0, aspect_of(width, height), planes[0], planes[1]),
                   width, height);
}

const Camera& numbered_camera(const Scene& scene, const std::string& text) {
    std::size_t number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    if (number < scene.cameras.size()) return scene.cameras[number];
    throw sim::InputError(fmt::format("camera '{}': expected a number below {}, as many cameras as {} has", text,
                                      scene.cameras.size(), scene.name));
}

void check_size(std::uint32_t width, std::uint32_t height) {
    for (const std::uint32_t size : {width, height})
        if (size < 1 || size > 16384)
            throw sim::InputError(
                fmt::format("resolution: expected 1 to 16384 pixels across and down, got {}x{}", width, height));
}

} // namespace

std::optional<std::vector<double>> numbers_in(std::string_view text) {
    std::vector<double> numbers;
    for (;;) {
        const std::size_t comma = text.find(',');
        const auto part = text.substr(0, comma);
        double number = 0.0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
        if (error != std::errc{} || end != part.data() + part.size() || !std::isfinite(number)) return std::nullopt;
        numbers.push_back(number);
        if (comma == std::string_view::npos) return numbers;
        text.remove_prefix(comma + 1);
    }
}

pipeline::View make_view(const Scene& scene, const std::string& camera, std::uint32_t width, std::uint32_t height,
                         std::vector<std::string>* notes) {
    check_size(width, height);
    if (camera == "auto") {
        if (scene.screen_space) return screen_view(scene, width, height);
        return scene.cameras.empty() ? fitting_view(scene, width, height)
                                     : camera_view(scene, scene.cameras[0], width, height, notes);
    }
    if (!camera.empty() && camera.size() <= 9 && camera.find_first_not_of("0123456789") == std::string::npos)
        return camera_view(scene, numbered_camera(scene, camera), width, height, notes);
    const auto numbers = numbers_in(camera);
    if (numbers && numbers->size() == 7) return free_view(scene, camera, *numbers, width, height);
    if (numbers && numbers->size() == matrix_numbers) return matrix_view(*numbers, width, height);
    throw sim::InputError(
        fmt::format("camera '{}': expected auto, the number of a camera, ex,ey,ez,tx,ty,tz,fovy, or the 32 numbers of "
                    "a view and a projection matrix",
                    camera));
}

std::string view_text(const pipeline::View& view) {
    std::string text;
    for (const glm::mat4& matrix : {view.view, view.projection})
        for (int i = 0; i < 16; ++i) text += fmt::format("{}{}", text.empty() ? "" : ",", matrix[i / 4][i % 4]);
    return text;
}

} // namespace traces
