#include "traces/area_light.hpp"

#include "sim/check.hpp"
#include "traces/camera.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace traces {

namespace {

// A map that is wider would spend its texels on the rim; 120 degrees across.
const double widest_slope = std::tan(std::numbers::pi / 3.0);

glm::dvec3 middle_of(const Scene& scene) { return (glm::dvec3(scene.lo) + glm::dvec3(scene.hi)) / 2.0; }

double radius_of(const Scene& scene) { return scene.radius > 0.0F ? static_cast<double>(scene.radius) : 1.0; }

AreaLight looking(const glm::dvec3& from, const glm::dvec3& forward, const glm::dvec3& up) {
    AreaLight light;
    light.centre = from;
    light.forward = glm::normalize(forward);
    light.right = glm::normalize(glm::cross(light.forward, up));
    light.up = glm::cross(light.right, light.forward);
    return light;
}

AreaLight looking(const glm::dvec3& from, const glm::dvec3& target) {
    const glm::dvec3 forward = glm::normalize(target - from);
    const bool upright = std::abs(forward.y) < 0.9999;
    return looking(from, forward, upright ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, -1.0));
}

// Planes that enclose what lies in front of the light; a far plane at most 1000 times as far as the near one.
void set_frustum(AreaLight& light, const Scene& scene, double slope) {
    double nearest = INFINITY, farthest = -INFINITY;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1) != 0 ? scene.hi.x : scene.lo.x, (i & 2) != 0 ? scene.hi.y : scene.lo.y,
                                (i & 4) != 0 ? scene.hi.z : scene.lo.z);
        const double z = light.seen(corner).z;
        nearest = std::min(nearest, z);
        farthest = std::max(farthest, z);
    }
    const double slack = 0.01 * radius_of(scene);
    light.far = farthest > 0.0 ? farthest + slack : 1.0; // everything may lie behind the light
    light.near = std::max(nearest - slack, light.far / 1000.0);
    light.near_width = 2.0 * slope * light.near;
}

// Of the cone around the bounding sphere.
double sphere_slope(const AreaLight& light, const Scene& scene) {
    const double distance = glm::distance(light.centre, middle_of(scene)), radius = 1.01 * radius_of(scene);
    if (distance <= radius) return widest_slope;
    return std::min(radius / std::sqrt(distance * distance - radius * radius), widest_slope);
}

AreaLight spot_light(const Scene& scene, const Light& spot) {
    const glm::dmat4 world(spot.to_world);
    AreaLight light = looking(glm::dvec3(world[3]), -glm::dvec3(world[2]), glm::dvec3(world[1]));
    set_frustum(light, scene, std::min(std::tan(static_cast<double>(spot.outer_cone)), widest_slope));
    return light;
}

AreaLight free_light(const Scene& scene, const glm::dvec3& from, const glm::dvec3& target) {
    AreaLight light = looking(from, target);
    set_frustum(light, scene, sphere_slope(light, scene));
    return light;
}

AreaLight automatic_light(const Scene& scene) {
    for (const Light& one : scene.lights)
        if (one.kind == LightKind::spot) return spot_light(scene, one);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.45, 1.0, 0.35));
    return free_light(scene, middle_of(scene) + direction * (3.0 * radius_of(scene)), middle_of(scene));
}

AreaLight numbered_light(const Scene& scene, const std::string& text, const std::string& place) {
    std::size_t number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    if (number >= scene.lights.size())
        throw sim::InputError(fmt::format("{}: light '{}': expected a number below {}, as many lights as {} has", place,
                                          text, scene.lights.size(), scene.name));
    if (scene.lights[number].kind != LightKind::spot)
        throw sim::InputError(
            fmt::format("{}: light '{}': expected a spot light, which has a place and a direction", place, text));
    return spot_light(scene, scene.lights[number]);
}

} // namespace

pipeline::View AreaLight::view(std::uint32_t resolution) const {
    const double half = near_width / 2.0;
    return {glm::mat4(glm::lookAtRH(centre, centre + forward, up)),
            glm::mat4(glm::frustumRH_NO(-half, half, -half, half, near, far)), resolution, resolution};
}

glm::dvec3 spread_over(const SquareLight& light, std::uint32_t i, std::uint32_t count) {
    std::uint32_t x = 0, y = 0, parts = 1;
    for (; count > 1; count /= 4, parts *= 2) {
        x = x * 2 + i % 2;
        y = y * 2 + i / 2 % 2;
        i /= 4;
    }
    const auto middle = [parts](std::uint32_t at) { return (2.0 * at + 1.0) / parts - 1.0; };
    return light.centre + middle(x) * light.u + middle(y) * light.v;
}

AreaLight make_area_light(const Scene& scene, const std::string& light, double size, const std::string& place) {
    AreaLight result;
    const auto numbers = numbers_in(light);
    if (light == "auto") {
        result = automatic_light(scene);
    } else if (light.size() <= 9 && !light.empty() && light.find_first_not_of("0123456789") == std::string::npos) {
        result = numbered_light(scene, light, place);
    } else if (numbers && numbers->size() == 6) {
        const std::vector<double>& n = *numbers;
        const glm::dvec3 from(n[0], n[1], n[2]), target(n[3], n[4], n[5]);
        if (!(glm::distance(from, target) > 0.0))
            throw sim::InputError(
                fmt::format("{}: light '{}': expected a target that is not the light's place", place, light));
        result = free_light(scene, from, target);
    } else {
        throw sim::InputError(fmt::format("{}: light '{}': expected auto, the number of a spot light, or "
                                          "px,py,pz,tx,ty,tz",
                                          place, light));
    }
    result.width = size * glm::distance(result.centre, middle_of(scene));
    return result;
}

} // namespace traces
