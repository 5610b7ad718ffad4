// Frames for the geometry front alone: index lists, and what became of their primitives, stated by the test.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/frame.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tests {

/// Triangle lists; every index is below `vertex_count`.
struct IndexedMesh {
    std::string name;
    std::uint32_t vertex_count = 0;
    std::vector<std::uint32_t> indices;
};

IndexedMesh grid_mesh(std::uint32_t columns, std::uint32_t rows); ///< 2 * columns * rows triangles, row by row
IndexedMesh sphere_mesh(std::uint32_t rings, std::uint32_t segments);
IndexedMesh shuffled(IndexedMesh mesh, std::uint64_t seed); ///< the triangles in random order
IndexedMesh random_mesh(std::uint32_t triangles, std::uint32_t vertices, std::uint64_t seed);
/// Blades of five triangles on seven vertices, none shared between blades.
IndexedMesh grass_mesh(std::uint32_t blades);

/// One draw of a frame under construction.
struct SceneDraw {
    pipeline::Topology topology = pipeline::Topology::triangles;
    pipeline::IndexType index_type = pipeline::IndexType::u32;
    std::uint32_t vertex_count = 0;
    std::vector<std::uint32_t> indices; ///< or as many entries as there are vertices to draw, when not indexed
    std::uint32_t instances = 1;
    bool primitive_restart = false;
    std::uint32_t vertex_bytes = 12; ///< of the interleaved vertex: position, then normal, then texcoords
};

/// A frame, and a stream in which every primitive became one triangle.
struct GeometryScene {
    pipeline::Frame frame;
    pipeline::FragmentStream stream;
};

/// vertex_bytes: 12 = position, 24 = with normal, 32 = with texcoord0. `needs` is empty but for the index buffer.
GeometryScene make_scene(const std::vector<SceneDraw>& draws);
GeometryScene make_scene(const IndexedMesh& mesh);

/// Changes what became of primitive `index`: `parts` triangles, 0 with a fate other than drawn. Renumbers the triangles
/// behind it; rebuild() has to be called after the last change.
void set_fate(GeometryScene& scene, std::uint32_t index, pipeline::PrimitiveFate fate, std::uint8_t parts,
              bool clipped);
void rebuild(GeometryScene& scene);

} // namespace tests
