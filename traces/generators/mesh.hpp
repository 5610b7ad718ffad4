// Vertices and indices in lists, and how they become buffers of a scene.
#pragma once

#include "sim/field.hpp"
#include "sim/random.hpp"
#include "traces/generators/vertex_format.hpp"
#include "traces/scene.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

using Colour = std::array<std::uint8_t, 4>; ///< linear RGBA

/// Order of drawing of layers that differ in depth.
enum class DepthOrder : std::uint8_t { front_to_back, back_to_front, random };

struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;     ///< empty, or one per position
    std::vector<Colour> colours;        ///< empty, or one per position
    std::vector<std::uint32_t> indices; ///< triangles; empty: the positions themselves
};

/// The vertices and indices of one draw of a mesh; the indices are those of these vertices only.
struct MeshPart {
    std::uint32_t first_vertex = 0, vertices = 0;
    std::uint32_t first_index = 0, indices = 0; ///< both 0 in a mesh without indices
};

/// The whole mesh, and one part for each `vertices` vertices and `indices` indices.
MeshPart whole(const Mesh& mesh);
std::vector<MeshPart> equal_parts(const Mesh& mesh, std::uint32_t vertices, std::uint32_t indices);

/// Appends a geometry and a draw for each part. Parts share the buffers; their indices count from their first vertex.
/// `place` begins the sim::InputError of a part with more than 65,536 vertices where indices have to have 16 bits.
///
/// Attributes that the mesh does not have: colours are white, secondary colours black; texture coordinates and generic
/// attributes are the place of the vertex in the mesh, 0 to 1 along each axis.
void add_draws(Scene& scene, const Mesh& mesh, const std::vector<MeshPart>& parts, const MeshFormat& format,
               std::string_view place);

/// A scene without draws, with one double-sided material of this colour.
Scene scene_of_material(std::string material, const glm::vec4& colour);

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
struct sim::EnumNames<traces::DepthOrder> {
    static constexpr std::array<std::string_view, 3> names{"front-to-back", "back-to-front", "random"};
};
