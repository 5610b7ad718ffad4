// Triangle scenes for comparisons with OpenGL: generated ones, and meshes of the folder of further scenes.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/fragment_stream.hpp"
#include "tests/support/mesa_renderer.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
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

/// The front end's fragments of the scene, under its state.
pipeline::FragmentStream rasterize_scene(const TriangleScene& scene, bool double_sided = true);

std::uint32_t primitive_of(const pipeline::FragmentStream& stream, const pipeline::Quad& quad);

void for_each_fragment(const pipeline::FragmentStream& stream,
                       const std::function<void(std::size_t pixel, std::size_t quad, std::size_t lane)>& visit);

/// Per pixel, what OpenGL is asked for too.
struct OwnPicture {
    std::vector<std::uint32_t> count, id;
    std::vector<float> depth;
};
/// Counts, the last fragment's id and its depth.
OwnPicture count_fragments(const pipeline::FragmentStream& stream);

/// llvmpipe's viewport transform is a fused multiply-add only where the processor has one.
bool fuses_multiply_add();

} // namespace tests
