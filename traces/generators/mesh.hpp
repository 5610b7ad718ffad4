// Vertices and indices in lists, and how they become buffers of a scene.
#pragma once

#include "sim/field.hpp"
#include "sim/random.hpp"
#include "traces/scene.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

using Colour = std::array<std::uint8_t, 4>; ///< linear RGBA

/// Where attributes lie: each in a buffer of its own, or all of a vertex together.
enum class VertexLayout : std::uint8_t { separate, interleaved };

/// Order of drawing of layers that differ in depth.
enum class DepthOrder : std::uint8_t { front_to_back, back_to_front, random };

struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;     ///< empty, or one per position
    std::vector<Colour> colours;        ///< empty, or one per position
    std::vector<std::uint32_t> indices; ///< triangles; empty: the positions themselves
};

/// Appends the mesh as one geometry and returns its number. Indices take 16 bits where 65,536 vertices suffice.
std::uint32_t add_mesh(pipeline::Resources& resources, const Mesh& mesh, VertexLayout layout);

/// Appends the mesh as one geometry for each `vertices_per_part` vertices and `indices_per_part` indices, which share
/// the buffers; indices count from the part's first vertex. Returns the number of parts; the first is the last geometry
/// before the call plus one.
std::uint32_t add_mesh_in_parts(pipeline::Resources& resources, const Mesh& mesh, VertexLayout layout,
                                std::uint32_t vertices_per_part, std::uint32_t indices_per_part);

/// A scene without draws, with one double-sided material of this colour.
Scene scene_of_material(std::string material, const glm::vec4& colour);

/// Draws the geometry once, where it is.
void add_draw(Scene& scene, std::uint32_t geometry);

/// Triangles with their normals weighted by area; positions and indices are given.
void compute_normals(Mesh& mesh);

/// Clearly different colours for consecutive numbers.
Colour colour_of(std::uint64_t number);

/// The depths 1/(n+1) .. n/(n+1) in an order of drawing.
std::vector<float> layer_depths(std::uint32_t n, DepthOrder order, std::uint64_t seed);

template <class T>
void shuffle(std::vector<T>& list, sim::Random& random) {
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random.below(i)]);
}

} // namespace traces

template <>
struct sim::EnumNames<traces::VertexLayout> {
    static constexpr std::array<std::string_view, 2> names{"separate", "interleaved"};
};

template <>
struct sim::EnumNames<traces::DepthOrder> {
    static constexpr std::array<std::string_view, 3> names{"front-to-back", "back-to-front", "random"};
};
