// Triangle scenes for comparisons with OpenGL: generated ones, and meshes of the folder of further scenes.
#pragma once

#include "pipeline/draw.hpp"
#include "tests/support/mesa_renderer.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace tests {

/// Triangles of about `size` pixels at random places and depths, within the screen. With `grid` > 0 their corners lie
/// on multiples of 1/grid pixel, so that many pixel centres fall on edges.
TriangleScene random_soup(std::uint32_t triangles, double size, std::uint64_t seed, std::uint32_t grid = 0);

/// The same, but the triangles may cross the edges of the screen and the near and far planes.
TriangleScene clipped_soup(std::uint32_t triangles, double size, std::uint64_t seed);

/// Spheres in rows, in perspective; each of 2 * rings * segments triangles.
TriangleScene sphere_grid(std::uint32_t spheres_in_row, std::uint32_t rings, std::uint32_t segments);

/// The positions of the first mesh of a .glb or .gltf below the folder of further scenes, seen in perspective as a
/// whole; nothing when the file is not there.
std::optional<TriangleScene> mesh_scene(const std::filesystem::path& relative);

/// The scene as one draw of the pipeline: resources, draws, and a view with the same clip matrix.
struct PipelineScene {
    pipeline::Resources resources;
    std::vector<pipeline::Draw> draws;
    pipeline::View view;
};
PipelineScene pipeline_scene(const TriangleScene& scene, bool double_sided = true);

} // namespace tests
