#include "traces/scene.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "traces/generators.hpp"
#include "traces/gltf_import.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace traces {

namespace {

struct Box {
    glm::vec3 lo{std::numeric_limits<float>::max()};
    glm::vec3 hi{std::numeric_limits<float>::lowest()};

    void add(const glm::vec3& point) {
        lo = glm::min(lo, point);
        hi = glm::max(hi, point);
    }
};

bool is_finite(const glm::vec4& value) {
    return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z) && std::isfinite(value.w);
}

/// The positions of a geometry, each checked once however many draws use it.
std::vector<glm::vec3> positions_of(const Scene& scene, const pipeline::Geometry& geometry) {
    const pipeline::AttributeReader read(*scene.resources, *geometry.find(pipeline::Semantic::position));
    std::vector<glm::vec3> positions(geometry.vertex_count);
    for (std::uint32_t i = 0; i < geometry.vertex_count; ++i) {
        const glm::vec4 position = read(i);
        if (!is_finite(position))
            throw sim::InputError(fmt::format("{}: {}: position {}: expected finite numbers, got ({}, {}, {})",
                                              scene.name, geometry.name, i, position.x, position.y, position.z));
        positions[i] = glm::vec3(position);
    }
    return positions;
}

/// A plain scale and translation maps boxes to boxes; anything else needs the points.
bool keeps_axes(const glm::mat4& matrix) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (row != column && matrix[column][row] != 0.0F) return false;
    return true;
}

void add_instance(Box& world, const glm::mat4& matrix, const std::vector<glm::vec3>& points) {
    for (const glm::vec3& point : points) world.add(glm::vec3(matrix * glm::vec4(point, 1.0F)));
}

std::vector<glm::vec3> corners_of(const Box& box) {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back((i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y,
                             (i & 4) != 0 ? box.hi.z : box.lo.z);
    return corners;
}

// The box of the turned points is exact; the box of their turned box, taken for very many points, may be larger.
void add_geometry(Box& world, const Scene& scene, std::uint32_t index,
                  const std::vector<const pipeline::Draw*>& draws) {
    constexpr std::size_t affordable = 50'000'000;
    const std::vector<glm::vec3> positions = positions_of(scene, scene.resources->geometries[index]);
    Box local;
    for (const glm::vec3& position : positions) local.add(position);
    const std::vector<glm::vec3> corners = corners_of(local);
    for (const pipeline::Draw* draw : draws) {
        const bool exact = positions.size() * draw->instances.size() <= affordable;
        for (const glm::mat4& matrix : draw->instances)
            add_instance(world, matrix, exact && !keeps_axes(matrix) ? positions : corners);
    }
}

void measure_box(Scene& scene) {
    std::vector<std::vector<const pipeline::Draw*>> users(scene.resources->geometries.size());
    for (const pipeline::Draw& draw : scene.draws) users[draw.geometry].push_back(&draw);
    Box world;
    for (std::uint32_t i = 0; i < users.size(); ++i) add_geometry(world, scene, i, users[i]);
    scene.lo = world.lo;
    scene.hi = world.hi;
    const glm::vec3 size = world.hi - world.lo;
    for (const glm::vec3& value : {world.lo, world.hi, size})
        if (!is_finite(glm::vec4(value, 0.0F)))
            throw sim::InputError(fmt::format("{}: expected a bounding box of finite size in world space", scene.name));
}

void check_draws(const Scene& scene) {
    for (const pipeline::Draw& draw : scene.draws) {
        CHECK(draw.geometry < scene.resources->geometries.size());
        CHECK(draw.material < scene.resources->materials.size());
        CHECK(!draw.instances.empty());
    }
}

} // namespace

void finish_scene(Scene& scene) {
    check_draws(scene);
    scene.resources->validate(scene.name);
    scene.resources->place();
    scene.triangles_drawn = 0;
    scene.vertices = 0;
    for (const pipeline::Draw& draw : scene.draws)
        scene.triangles_drawn +=
            std::uint64_t{scene.resources->geometries[draw.geometry].triangle_count()} * draw.instances.size();
    for (const pipeline::Geometry& geometry : scene.resources->geometries) scene.vertices += geometry.vertex_count;
    if (scene.triangles_drawn == 0)
        throw sim::InputError(fmt::format("{}: expected at least one triangle to draw", scene.name));
    measure_box(scene);
}

Scene load_scene(const std::string& spec) {
    if (spec.starts_with("gen:")) return generate_scene(spec);
    const std::size_t hash = spec.rfind('#');
    if (hash == std::string::npos) return import_gltf(spec);
    return import_gltf(spec.substr(0, hash), spec.substr(hash + 1));
}

} // namespace traces
