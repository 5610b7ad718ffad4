// A geometry in hand: its triangles as vertex numbers, its vertices as records of bytes.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/functional/vertex_fetch.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace traces {

using pipeline::names_a_vertex_twice;

constexpr std::uint32_t no_vertex = ~std::uint32_t{0};

/// Vertices and indices of one geometry, apart from the buffers of a scene.
struct TriangleMesh {
    /// Attributes that lie side by side in one buffer. What else lies between them goes along unread.
    struct Stream {
        std::string name;
        std::uint32_t stride = 0;       ///< bytes per vertex
        std::vector<std::byte> records; ///< vertices * stride
    };
    std::string name;
    pipeline::Topology topology = pipeline::Topology::triangles;
    pipeline::IndexType index_type = pipeline::IndexType::none; ///< narrowest to be written; none: as few bytes as do
    bool primitive_restart = false;                             ///< an index of no_vertex ends a strip or a fan
    std::uint32_t vertices = 0;
    std::vector<Stream> streams;
    std::vector<pipeline::VertexAttribute> attributes; ///< `buffer` is a stream, `offset` lies in its record
    std::vector<std::uint32_t> indices;                ///< each below `vertices`, or no_vertex
};

enum class TopologyWanted : std::uint8_t { list, as_it_is };

/// The mesh of a geometry without the vertices that no triangle names; the others keep their order and their places
/// beside each other. As lists, strips and fans lose the triangles that name a vertex twice (they drew nothing but
/// stitched).
TriangleMesh take_mesh(const pipeline::Resources& resources, const pipeline::Geometry& geometry, TopologyWanted wanted);

/// Appends the mesh with buffers of its own; returns the number of the geometry. Indices are left out where none are
/// needed and none were asked for, and wider than asked for where they have to be. `index_type` none asks for 16 bits.
std::uint32_t write_mesh(pipeline::Resources& resources, const TriangleMesh& mesh);

/// Moves vertex i to new_number[i], or drops it where that is no_vertex; `count` vertices are left. Indices follow.
void renumber_vertices(TriangleMesh& mesh, const std::vector<std::uint32_t>& new_number, std::uint32_t count);

/// The triangles of a list at `first`, `first + 1` ... with the vertices that they name, in their order.
TriangleMesh cut_mesh(const TriangleMesh& mesh, std::size_t first_triangle, std::size_t triangles);

/// One attribute of all vertices, packed.
struct Column {
    pipeline::VertexAttribute format; ///< buffer, offset and stride mean nothing here
    std::vector<std::byte> elements;
};
using Columns = std::vector<Column>;
/// Which attributes lie side by side, in which order, by number.
using Grouping = std::vector<std::vector<std::size_t>>;

Columns columns_of(const TriangleMesh& mesh);
Grouping grouping_of(const TriangleMesh& mesh);
/// Replaces attributes and streams. Elements and records begin at multiples of `align` bytes from that of vertex 0.
void lay_out(TriangleMesh& mesh, const Columns& columns, const Grouping& groups, std::uint32_t align);

} // namespace traces
