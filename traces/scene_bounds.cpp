#include "traces/scene_bounds.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace traces {

namespace {

/// More positions than this of one draw (over all instances) are bounded by the corners of their box instead.
constexpr std::size_t affordable = 50'000'000;

struct Box {
    glm::vec3 lo{std::numeric_limits<float>::max()};
    glm::vec3 hi{std::numeric_limits<float>::lowest()};

    void add(const glm::vec3& point) {
        lo = glm::min(lo, point);
        hi = glm::max(hi, point);
    }
    std::vector<glm::vec3> corners() const {
        std::vector<glm::vec3> list;
        for (int i = 0; i < 8; ++i)
            list.emplace_back((i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y, (i & 4) != 0 ? hi.z : lo.z);
        return list;
    }
};

bool is_finite(const glm::vec3& value) {
    return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z);
}

std::vector<glm::vec3> positions_of(const Scene& scene, const pipeline::Geometry& geometry) {
    const pipeline::AttributeReader read(*scene.resources, *geometry.find(pipeline::Semantic::position));
    std::vector<glm::vec3> positions(geometry.vertex_count);
    for (std::uint32_t i = 0; i < geometry.vertex_count; ++i) {
        positions[i] = glm::vec3(read(i));
        if (!is_finite(positions[i]))
            throw sim::InputError(fmt::format("{}: {}: position {}: expected finite numbers, got ({}, {}, {})",
                                              scene.name, geometry.name, i, positions[i].x, positions[i].y,
                                              positions[i].z));
    }
    return positions;
}

/// Calls visit(point) for every position of every instance, in world space.
template <class Visit>
void visit_world(const Scene& scene, Visit&& visit) {
    std::vector<std::vector<const pipeline::Draw*>> users(scene.resources->geometries.size());
    for (const pipeline::Draw& draw : scene.draws) users[draw.geometry].push_back(&draw);
    for (std::size_t i = 0; i < users.size(); ++i) {
        const std::vector<glm::vec3> positions = positions_of(scene, scene.resources->geometries[i]);
        Box box;
        for (const glm::vec3& position : positions) box.add(position);
        const std::vector<glm::vec3> corners = box.corners();
        for (const pipeline::Draw* draw : users[i]) {
            const bool all = positions.size() * draw->instances.size() <= affordable;
            for (const glm::mat4& matrix : draw->instances)
                for (const glm::vec3& point : all ? positions : corners)
                    visit(glm::vec3(matrix * glm::vec4(point, 1.0F)));
        }
    }
}

} // namespace

Bounds measure_bounds(const Scene& scene) {
    Box box;
    bool finite = true;
    visit_world(scene, [&](const glm::vec3& point) {
        finite = finite && is_finite(point);
        box.add(point);
    });
    if (!finite || !is_finite(box.hi - box.lo))
        throw sim::InputError(fmt::format("{}: expected a bounding box of finite size in world space", scene.name));
    const glm::dvec3 middle = (glm::dvec3(box.lo) + glm::dvec3(box.hi)) / 2.0;
    double largest = 0.0; // squared
    visit_world(scene, [&](const glm::vec3& point) {
        const glm::dvec3 arm = glm::dvec3(point) - middle;
        largest = std::max(largest, glm::dot(arm, arm));
    });
    return {box.lo, box.hi, static_cast<float>(std::sqrt(largest))};
}

} // namespace traces
