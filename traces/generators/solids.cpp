#include "traces/generators/solids.hpp"

#include <cmath>
#include <numbers>

namespace traces {

Mesh sphere_mesh(const glm::dvec3& centre, double radius, std::uint32_t segments) {
    constexpr double pi = std::numbers::pi;
    const std::uint32_t rings = std::max(segments / 2, 2U);
    Mesh mesh;
    for (std::uint32_t ring = 0; ring <= rings; ++ring)
        for (std::uint32_t i = 0; i < segments; ++i) {
            const double polar = pi * ring / rings, azimuth = 2.0 * pi * i / segments;
            // The sine of a pole is exactly none, so that its vertices coincide.
            const double across = ring == 0 || ring == rings ? 0.0 : std::sin(polar);
            const glm::dvec3 normal(across * std::cos(azimuth), std::cos(polar), across * std::sin(azimuth));
            mesh.positions.emplace_back(glm::vec3(centre + radius * normal));
            mesh.normals.emplace_back(glm::vec3(normal));
        }
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t i = 0; i < segments; ++i) {
            const std::uint32_t next = (i + 1) % segments, above = ring * segments, below = above + segments;
            if (ring > 0) mesh.indices.insert(mesh.indices.end(), {above + i, above + next, below + i});
            if (ring + 1 < rings) mesh.indices.insert(mesh.indices.end(), {above + next, below + next, below + i});
        }
    return mesh;
}

Mesh box_mesh(const glm::dvec3& lo, const glm::dvec3& hi) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool far : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const bool at_u : {false, true})
                for (const bool at_v : {false, true}) {
                    glm::dvec3 corner = far ? hi : lo;
                    corner[u] = at_u ? hi[u] : lo[u];
                    corner[v] = at_v ? hi[v] : lo[v];
                    glm::vec3 normal(0.0F);
                    normal[axis] = far ? 1.0F : -1.0F;
                    mesh.positions.emplace_back(glm::vec3(corner));
                    mesh.normals.push_back(normal);
                }
            if (far)
                mesh.indices.insert(mesh.indices.end(), {first, first + 2, first + 1, first + 1, first + 2, first + 3});
            else
                mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first + 2, first + 1, first + 3});
        }
    return mesh;
}

void add_object(Scene& scene, Mesh mesh, std::string name, const glm::vec4& colour, std::string_view place) {
    pipeline::Material material;
    material.name = name;
    material.base_colour = colour;
    material.double_sided = true;
    const auto number = static_cast<std::uint32_t>(scene.resources->materials.size());
    scene.resources->materials.push_back(std::move(material));
    mesh.name = std::move(name);
    const std::size_t draws = scene.draws.size();
    add_draws(scene, mesh, {whole(mesh)}, {}, place);
    for (std::size_t i = draws; i < scene.draws.size(); ++i) scene.draws[i].material = number;
}

Scene empty_scene() {
    Scene scene;
    scene.resources = std::make_shared<pipeline::Resources>();
    return scene;
}

} // namespace traces
