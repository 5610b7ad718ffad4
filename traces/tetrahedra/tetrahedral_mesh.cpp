#include "traces/tetrahedra/tetrahedral_mesh.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <numeric>
#include <span>

namespace traces {

namespace {

using Face = std::array<std::uint32_t, 3>;

constexpr float largest_scalar = 65504.0F;

bool is_degenerate(const Face& face) { return face[0] == face[1] || face[1] == face[2] || face[2] == face[0]; }

Face sorted(Face face) {
    std::sort(face.begin(), face.end());
    return face;
}

std::vector<Face> all_faces(const std::vector<std::array<std::uint32_t, 4>>& tetrahedra) {
    constexpr std::array<std::array<std::size_t, 3>, 4> corners{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    std::vector<Face> faces;
    faces.reserve(tetrahedra.size() * corners.size());
    for (const auto& one : tetrahedra)
        for (const auto& [a, b, c] : corners)
            if (const Face face{one[a], one[b], one[c]}; !is_degenerate(face)) faces.push_back(face);
    return faces;
}

template <class T>
std::uint32_t add_buffer(pipeline::Resources& resources, std::string name, std::span<const T> values) {
    const auto bytes = std::as_bytes(values);
    resources.buffers.push_back({std::move(name), {bytes.begin(), bytes.end()}, 0});
    return static_cast<std::uint32_t>(resources.buffers.size() - 1);
}

pipeline::VertexAttribute floats(pipeline::Semantic semantic, std::uint32_t buffer, std::uint8_t components) {
    pipeline::VertexAttribute attribute;
    attribute.semantic = semantic;
    attribute.components = components;
    attribute.buffer = buffer;
    attribute.stride = components * 4U;
    return attribute;
}

/// Returns the power of two by which all scalars are divided.
int bring_into_range(std::vector<float>& scalars, std::vector<std::string>& notes) {
    float largest = 0.0F;
    for (const float scalar : scalars) largest = std::max(largest, std::fabs(scalar));
    if (largest <= largest_scalar) return 0;
    const int exponent = std::ilogb(largest / largest_scalar) + 1;
    for (float& scalar : scalars) scalar = std::ldexp(scalar, -exponent);
    notes.push_back(fmt::format("scalars are divided by 2^{}, so that none is above {}; parameters are still in the "
                                "file's own scalars",
                                exponent, static_cast<double>(largest_scalar)));
    return exponent;
}

pipeline::Material scalar_material() {
    pipeline::Material material;
    material.name = "scalar";
    material.double_sided = true;
    material.unlit = true;
    return material;
}

Scene scene_of_scalars(const std::string& name, const std::vector<glm::vec3>& positions, std::vector<float>& scalars,
                       std::vector<std::string>& notes) {
    CHECK(scalars.size() == positions.size());
    Scene scene;
    scene.scalar_exponent = bring_into_range(scalars, notes);
    scene.resources = std::make_shared<pipeline::Resources>();
    scene.notes = notes;
    pipeline::Resources& resources = *scene.resources;
    resources.materials.push_back(scalar_material());
    pipeline::Geometry geometry;
    geometry.name = name;
    geometry.vertex_count = static_cast<std::uint32_t>(positions.size());
    const std::uint32_t places = add_buffer(resources, "positions", std::span(positions.data(), positions.size()));
    const std::uint32_t values = add_buffer(resources, "scalars", std::span<const float>(scalars));
    geometry.attributes = {floats(pipeline::Semantic::position, places, 3),
                           floats(pipeline::Semantic::colour, values, 1)};
    resources.geometries.push_back(std::move(geometry));
    scene.draws.push_back({name, 0, 0, {glm::mat4(1.0F)}});
    return scene;
}

} // namespace

std::vector<Face> faces_of(const std::vector<std::array<std::uint32_t, 4>>& tetrahedra) {
    const std::vector<Face> all = all_faces(tetrahedra);
    std::vector<std::uint32_t> order(all.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<Face> keys(all.size());
    std::transform(all.begin(), all.end(), keys.begin(), sorted);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
    std::vector<std::uint32_t> first; // of each face, the place where it is named first
    for (std::size_t i = 0; i < order.size(); ++i)
        if (i == 0 || keys[order[i]] != keys[order[i - 1]]) first.push_back(order[i]);
    std::sort(first.begin(), first.end());
    std::vector<Face> faces;
    faces.reserve(first.size());
    for (const std::uint32_t i : first) faces.push_back(all[i]);
    return faces;
}

Scene scene_of(TetrahedralMesh mesh) {
    Scene scene = scene_of_scalars(mesh.name, mesh.positions, mesh.scalars, mesh.notes);
    const std::vector<Face> faces = faces_of(mesh.tetrahedra);
    pipeline::Geometry& geometry = scene.resources->geometries.front();
    geometry.index_type = pipeline::IndexType::u32;
    geometry.index_count = static_cast<std::uint32_t>(faces.size() * 3);
    geometry.index_buffer = add_buffer(*scene.resources, "faces", std::span<const Face>(faces));
    return scene;
}

Scene scene_of(PointCloud cloud) {
    Scene scene = scene_of_scalars(cloud.name, cloud.positions, cloud.scalars, cloud.notes);
    scene.resources->geometries.front().index_count = static_cast<std::uint32_t>(cloud.positions.size());
    return scene;
}

void add_computed_scalars(TetrahedralMesh& mesh) {
    glm::dvec3 lo(INFINITY), hi(-INFINITY);
    for (const glm::vec3& position : mesh.positions) {
        lo = glm::min(lo, glm::dvec3(position));
        hi = glm::max(hi, glm::dvec3(position));
    }
    const glm::dvec3 middle = (lo + hi) / 2.0;
    const double corner = glm::length(hi - middle);
    mesh.scalars.clear();
    for (const glm::vec3& position : mesh.positions) {
        const double share = glm::length(glm::dvec3(position) - middle) / corner;
        mesh.scalars.push_back(std::isfinite(share) ? static_cast<float>(share) : 0.0F);
    }
    mesh.notes.emplace_back("no scalars at the points: the distance from the middle of the bounding box is taken");
}

} // namespace traces
