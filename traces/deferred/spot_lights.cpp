#include "traces/deferred/spot_lights.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace traces {

namespace {

constexpr std::uint32_t sides_of_cone = 16;
constexpr double widest_cone = 1.4; // radians to one side: a map of more would be all rim

double size_of(const Scene& scene) { return scene.radius > 0.0F ? static_cast<double>(scene.radius) : 1.0; }

/// An axis across a direction.
glm::dvec3 across(const glm::dvec3& direction) {
    return std::abs(direction.y) < 0.99 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
}

SpotLight spot_of_scene(const Light& light, const Scene& scene) {
    const glm::dmat4 world(light.to_world);
    SpotLight spot;
    spot.place = glm::dvec3(world[3]);
    spot.direction = glm::normalize(-glm::dvec3(world[2]));
    const glm::dvec3 colour(light.colour);
    spot.colour = colour / std::max({colour.r, colour.g, colour.b, 1e-30});
    spot.range = light.range > 0.0F
                     ? static_cast<double>(light.range)
                     : glm::distance(spot.place, glm::dvec3(scene.lo + scene.hi) / 2.0) + 2.0 * size_of(scene);
    spot.outer = std::clamp(static_cast<double>(light.outer_cone), 1e-3, widest_cone);
    spot.inner = std::clamp(static_cast<double>(light.inner_cone), 0.0, 0.999 * spot.outer);
    return spot;
}

// On a ring above the scene, each a golden angle behind the one before.
SpotLight generated(std::uint32_t number, const Scene& scene) {
    const double golden = 2.0 * std::numbers::pi / (1.0 + std::numbers::phi), angle = number * golden;
    const double radius = size_of(scene), height = 0.9 + 0.3 * std::fmod(number * std::numbers::phi, 1.0);
    const glm::dvec3 middle = glm::dvec3(scene.lo + scene.hi) / 2.0;
    const auto on_ring = [&](double at, double share) {
        return middle + radius * share * glm::dvec3(std::cos(at), 0.0, std::sin(at));
    };
    SpotLight spot;
    spot.place = on_ring(angle, 0.8) + glm::dvec3(0.0, radius * height, 0.0);
    spot.direction = glm::normalize(on_ring(angle + 2.0, 0.4) - spot.place);
    for (int i = 0; i < 3; ++i) spot.colour[i] = 0.7 + 0.3 * std::cos(angle + 2.0 * std::numbers::pi * i / 3.0);
    spot.range = 2.6 * radius;
    spot.inner = 0.3;
    spot.outer = 0.5;
    return spot;
}

template <class Element>
std::uint32_t add_buffer(pipeline::Resources& resources, const char* name, const std::vector<Element>& elements) {
    pipeline::Buffer buffer;
    buffer.name = name;
    buffer.bytes.resize(elements.size() * sizeof(Element));
    std::memcpy(buffer.bytes.data(), elements.data(), buffer.bytes.size());
    resources.buffers.push_back(std::move(buffer));
    return static_cast<std::uint32_t>(resources.buffers.size() - 1);
}

// Apex in the origin, along -z to z = -1, the circle of radius 1 there lies within its base.
pipeline::Geometry unit_cone(pipeline::Resources& resources) {
    std::vector<glm::vec3> positions{{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, -1.0F}};
    std::vector<std::uint32_t> indices;
    const double outside = 1.0 / std::cos(std::numbers::pi / sides_of_cone);
    for (std::uint32_t i = 0; i < sides_of_cone; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides_of_cone;
        positions.emplace_back(outside * std::cos(angle), outside * std::sin(angle), -1.0);
        const std::uint32_t here = 2 + i, next = 2 + (i + 1) % sides_of_cone;
        indices.insert(indices.end(), {0, here, next, 1, next, here});
    }
    pipeline::Geometry cone;
    cone.name = "light volume";
    cone.vertex_count = static_cast<std::uint32_t>(positions.size());
    pipeline::VertexAttribute position;
    position.buffer = add_buffer(resources, "light volume", positions);
    cone.attributes = {position};
    cone.index_type = pipeline::IndexType::u32;
    cone.index_count = static_cast<std::uint32_t>(indices.size());
    cone.index_buffer = add_buffer(resources, "light volume indices", indices);
    return cone;
}

} // namespace

double SpotLight::arrives(const glm::dvec3& at) const {
    const glm::dvec3 way = at - place;
    const double distance = glm::length(way);
    if (!(distance > 0.0 && distance < range)) return 0.0;
    const double cosine = glm::dot(way / distance, direction), edge = std::cos(outer), full = std::cos(inner);
    const double t = std::clamp((cosine - edge) / (full - edge), 0.0, 1.0), near = 1.0 - distance / range;
    return near * near * t * t * (3.0 - 2.0 * t);
}

pipeline::View SpotLight::view(std::uint32_t map_size) const {
    return {glm::mat4(glm::lookAtRH(place, place + direction, across(direction))),
            glm::mat4(glm::perspectiveRH_NO(2.0 * outer, 1.0, lamp(), range)), map_size, map_size};
}

glm::dmat4 SpotLight::volume() const {
    const double base = range * std::tan(outer);
    return glm::inverse(glm::lookAtRH(place, place + direction, across(direction))) *
           glm::scale(glm::dmat4(1.0), glm::dvec3(base, base, range));
}

bool SpotLight::touches(const glm::dvec3& centre, double radius) const {
    const glm::dvec3 way = centre - place;
    const double along = glm::dot(way, direction);
    if (along < -radius || along > range + radius) return false;
    const double out = std::sqrt(std::max(glm::dot(way, way) - along * along, 0.0));
    const double slope = std::tan(outer) / std::cos(std::numbers::pi / sides_of_cone);
    return out - along * slope <= radius * std::sqrt(1.0 + slope * slope);
}

std::vector<SpotLight> spot_lights(const Scene& scene, std::uint32_t count) {
    std::vector<SpotLight> lights;
    for (const Light& light : scene.lights)
        if (light.kind == LightKind::spot && lights.size() < count) lights.push_back(spot_of_scene(light, scene));
    for (std::uint32_t i = 0; lights.size() < count; ++i) lights.push_back(generated(i, scene));
    return lights;
}

std::vector<std::uint32_t> add_light_volumes(pipeline::Frame& frame, const std::vector<SpotLight>& lights) {
    std::vector<std::uint32_t> draws;
    if (lights.empty()) return draws;
    auto resources = std::make_shared<pipeline::Resources>(*frame.resources);
    const auto geometry = static_cast<std::uint32_t>(resources->geometries.size());
    const auto material = static_cast<std::uint32_t>(resources->materials.size());
    resources->geometries.push_back(unit_cone(*resources));
    resources->materials.push_back({.name = "light volume"});
    resources->place();
    for (const SpotLight& light : lights) {
        draws.push_back(static_cast<std::uint32_t>(frame.draws.size()));
        frame.draws.push_back(
            {fmt::format("light {}", draws.size() - 1), geometry, material, {glm::mat4(light.volume())}});
    }
    frame.resources = std::move(resources);
    return draws;
}

} // namespace traces
