// Meshes to prepare, and what became of them, found without the code under test.
#pragma once

#include "traces/generators/mesh.hpp"
#include "traces/preparation.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tests {

/// A scene of one draw of each mesh, with indices where the mesh has some.
traces::Scene scene_of(const std::vector<traces::Mesh>& meshes,
                       traces::VertexLayout layout = traces::VertexLayout::separate);

/// A bumpy square of 2 * columns * rows triangles with normals and colours.
traces::Mesh hill_mesh(std::uint32_t columns, std::uint32_t rows, std::uint64_t seed);
/// Any three vertices make a triangle: edges with many faces, vertices without any, triangles drawn twice.
traces::Mesh soup_mesh(std::uint32_t triangles, std::uint32_t vertices, std::uint64_t seed);
/// A hill with triangles among its own that name a vertex twice or three times.
traces::Mesh degenerate_mesh(std::uint64_t seed);

/// What the corners of a triangle read, attribute by attribute, the smallest corner first.
using TriangleValues = std::array<std::vector<float>, 3>;
/// Of all draws, instance by instance in world space, sorted; without those of two equal corners if so asked. Only the
/// attributes that do not depend on the instance are compared besides positions.
std::vector<TriangleValues> triangle_values(const traces::Scene& scene, bool with_degenerate);

/// prepare_scene() with one specification.
traces::PreparedScene prepared(const traces::Scene& scene, const std::string& spec);
/// ... with several, in order.
traces::PreparedScene prepared_in_turn(const traces::Scene& scene, const std::vector<std::string>& specs);
/// The message of the sim::InputError, or "".
std::string preparation_error(const traces::Scene& scene, const std::string& spec);

} // namespace tests
