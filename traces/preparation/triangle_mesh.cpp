#include "traces/preparation/triangle_mesh.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <numeric>
#include <span>

namespace traces {

using pipeline::Geometry;
using pipeline::IndexType;
using pipeline::Resources;
using pipeline::Topology;
using pipeline::VertexAttribute;

namespace {

std::vector<std::uint32_t> list_of(const Resources& resources, const Geometry& geometry) {
    const bool stitched = geometry.topology != Topology::triangles;
    const pipeline::PrimitiveReader read(resources, geometry);
    const std::uint32_t triangles = geometry.triangle_count();
    std::vector<std::uint32_t> list;
    list.reserve(std::size_t{triangles} * 3);
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const std::array<std::uint32_t, 3> corners = read(i);
        if (!stitched || !names_a_vertex_twice(corners)) list.insert(list.end(), corners.begin(), corners.end());
    }
    return list;
}

std::vector<std::uint32_t> indices_as_they_are(const Resources& resources, const Geometry& geometry) {
    const pipeline::IndexReader read(resources, geometry);
    std::vector<std::uint32_t> indices(geometry.index_count);
    const std::uint32_t restart = pipeline::restart_index(geometry.index_type);
    for (std::uint32_t i = 0; i < geometry.index_count; ++i) {
        indices[i] = read(i);
        if (geometry.primitive_restart && indices[i] == restart) indices[i] = no_vertex;
    }
    return indices;
}

/// Renumbers the named vertices from 0 in their order, and returns their old numbers.
std::vector<std::uint32_t> compact(std::vector<std::uint32_t>& indices) {
    std::uint32_t first = no_vertex, last = 0;
    for (const std::uint32_t vertex : indices) {
        if (vertex == no_vertex) continue;
        first = std::min(first, vertex);
        last = std::max(last, vertex);
    }
    if (first > last) return {};
    std::vector<std::uint32_t> number(std::size_t{last} - first + 1, no_vertex);
    for (const std::uint32_t vertex : indices)
        if (vertex != no_vertex) number[vertex - first] = 0;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < number.size(); ++i) {
        if (number[i] == no_vertex) continue;
        number[i] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(first + static_cast<std::uint32_t>(i));
    }
    for (std::uint32_t& vertex : indices)
        if (vertex != no_vertex) vertex = number[vertex - first];
    return kept;
}

/// Copies what lies between the first and the last attribute of a record, for every vertex of `kept`.
TriangleMesh::Stream gather(const pipeline::Buffer& buffer, std::uint64_t base, std::uint32_t stride,
                            std::uint64_t extent, std::span<const std::uint32_t> kept) {
    TriangleMesh::Stream stream{buffer.name, stride, std::vector<std::byte>(kept.size() * stride)};
    std::byte* target = stream.records.data();
    for (const std::uint32_t vertex : kept) {
        std::memcpy(target, buffer.bytes.data() + base + std::uint64_t{vertex} * stride, extent);
        target += stride;
    }
    return stream;
}

void take_streams(TriangleMesh& mesh, const Resources& resources, std::span<const std::uint32_t> kept) {
    std::vector<std::size_t> order(mesh.attributes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const VertexAttribute &x = mesh.attributes[a], &y = mesh.attributes[b];
        return std::pair(x.buffer, x.offset) < std::pair(y.buffer, y.offset);
    });
    for (std::size_t i = 0; i < order.size();) {
        const VertexAttribute lowest = mesh.attributes[order[i]];
        std::uint64_t extent = 0;
        for (; i < order.size(); ++i) { // while they fit into one record
            VertexAttribute& attribute = mesh.attributes[order[i]];
            const std::uint64_t end = attribute.offset - lowest.offset + attribute.bytes();
            if (attribute.buffer != lowest.buffer || attribute.stride != lowest.stride || end > lowest.stride) break;
            extent = std::max(extent, end);
            attribute.offset -= lowest.offset;
            attribute.buffer = static_cast<std::uint32_t>(mesh.streams.size());
        }
        mesh.streams.push_back(gather(resources.buffers[lowest.buffer], lowest.offset, lowest.stride, extent, kept));
    }
}

bool counts_up(std::span<const std::uint32_t> indices) {
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] != i) return false;
    return true;
}

template <class Index>
std::vector<std::byte> bytes_as(std::span<const std::uint32_t> indices) {
    std::vector<std::byte> bytes(indices.size() * sizeof(Index));
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const auto index = static_cast<Index>(indices[i]);
        std::memcpy(bytes.data() + i * sizeof(Index), &index, sizeof(Index));
    }
    return bytes;
}

std::vector<std::byte> index_bytes(std::span<const std::uint32_t> indices, IndexType type) {
    if (type == IndexType::u8) return bytes_as<std::uint8_t>(indices);
    return type == IndexType::u16 ? bytes_as<std::uint16_t>(indices) : bytes_as<std::uint32_t>(indices);
}

IndexType index_type_of(const TriangleMesh& mesh) {
    const std::uint32_t values = mesh.vertices + (mesh.primitive_restart ? 1 : 0); // restart takes the largest
    const IndexType needed = values <= 256 ? IndexType::u8 : values <= 65536 ? IndexType::u16 : IndexType::u32;
    return std::max(mesh.index_type == IndexType::none ? IndexType::u16 : mesh.index_type, needed);
}

std::uint32_t add_buffer(Resources& resources, std::string name, std::vector<std::byte> bytes) {
    resources.buffers.push_back({std::move(name), std::move(bytes), 0});
    return static_cast<std::uint32_t>(resources.buffers.size() - 1);
}

constexpr std::uint32_t aligned(std::uint32_t size, std::uint32_t align) { return (size + align - 1) / align * align; }

} // namespace

TriangleMesh take_mesh(const Resources& resources, const Geometry& geometry, TopologyWanted wanted) {
    const bool as_it_is = wanted == TopologyWanted::as_it_is;
    TriangleMesh mesh;
    mesh.name = geometry.name;
    mesh.topology = as_it_is ? geometry.topology : Topology::triangles;
    mesh.index_type = geometry.index_type;
    mesh.attributes = geometry.attributes;
    mesh.primitive_restart = as_it_is && geometry.primitive_restart;
    mesh.indices = as_it_is ? indices_as_they_are(resources, geometry) : list_of(resources, geometry);
    const std::vector<std::uint32_t> kept = compact(mesh.indices);
    mesh.vertices = static_cast<std::uint32_t>(kept.size());
    take_streams(mesh, resources, kept);
    return mesh;
}

std::uint32_t write_mesh(Resources& resources, const TriangleMesh& mesh) {
    Geometry geometry;
    geometry.name = mesh.name;
    geometry.topology = mesh.topology;
    geometry.attributes = mesh.attributes;
    geometry.primitive_restart = mesh.primitive_restart;
    geometry.vertex_count = mesh.vertices;
    geometry.index_count = static_cast<std::uint32_t>(mesh.indices.size());
    const auto first = static_cast<std::uint32_t>(resources.buffers.size());
    for (const TriangleMesh::Stream& stream : mesh.streams) add_buffer(resources, stream.name, stream.records);
    for (VertexAttribute& attribute : geometry.attributes) attribute.buffer += first;
    if (mesh.index_type != IndexType::none || mesh.primitive_restart || !counts_up(mesh.indices)) {
        geometry.index_type = index_type_of(mesh);
        geometry.index_buffer =
            add_buffer(resources, mesh.name + " indices", index_bytes(mesh.indices, geometry.index_type));
    }
    resources.geometries.push_back(std::move(geometry));
    return static_cast<std::uint32_t>(resources.geometries.size() - 1);
}

void renumber_vertices(TriangleMesh& mesh, const std::vector<std::uint32_t>& new_number, std::uint32_t count) {
    CHECK(new_number.size() == mesh.vertices);
    for (TriangleMesh::Stream& stream : mesh.streams) {
        std::vector<std::byte> records(std::size_t{count} * stream.stride);
        for (std::size_t i = 0; i < new_number.size(); ++i)
            if (new_number[i] != no_vertex)
                std::memcpy(records.data() + std::size_t{new_number[i]} * stream.stride,
                            stream.records.data() + i * stream.stride, stream.stride);
        stream.records = std::move(records);
    }
    for (std::uint32_t& vertex : mesh.indices) {
        if (vertex == no_vertex) continue;
        vertex = new_number[vertex];
        CHECK(vertex < count);
    }
    mesh.vertices = count;
}

TriangleMesh cut_mesh(const TriangleMesh& mesh, std::size_t first_triangle, std::size_t triangles) {
    CHECK(mesh.topology == Topology::triangles && (first_triangle + triangles) * 3 <= mesh.indices.size());
    const auto begin = mesh.indices.begin() + static_cast<std::ptrdiff_t>(first_triangle * 3);
    TriangleMesh part;
    part.name = mesh.name;
    part.index_type = mesh.index_type;
    part.attributes = mesh.attributes;
    part.indices.assign(begin, begin + static_cast<std::ptrdiff_t>(triangles * 3));
    const std::vector<std::uint32_t> kept = compact(part.indices);
    part.vertices = static_cast<std::uint32_t>(kept.size());
    for (const TriangleMesh::Stream& stream : mesh.streams) {
        TriangleMesh::Stream piece{stream.name, stream.stride, {}};
        piece.records.reserve(kept.size() * stream.stride);
        for (const std::uint32_t vertex : kept) {
            const std::byte* record = stream.records.data() + std::size_t{vertex} * stream.stride;
            piece.records.insert(piece.records.end(), record, record + stream.stride);
        }
        part.streams.push_back(std::move(piece));
    }
    return part;
}

Columns columns_of(const TriangleMesh& mesh) {
    Columns columns;
    for (const VertexAttribute& attribute : mesh.attributes) {
        const std::uint32_t size = attribute.bytes();
        Column column{attribute, std::vector<std::byte>(std::size_t{mesh.vertices} * size)};
        const TriangleMesh::Stream& stream = mesh.streams[attribute.buffer];
        for (std::size_t i = 0; i < mesh.vertices; ++i)
            std::memcpy(column.elements.data() + i * size, stream.records.data() + i * stream.stride + attribute.offset,
                        size);
        columns.push_back(std::move(column));
    }
    return columns;
}

Grouping grouping_of(const TriangleMesh& mesh) {
    Grouping groups(mesh.streams.size());
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) groups[mesh.attributes[i].buffer].push_back(i);
    for (std::vector<std::size_t>& group : groups)
        std::stable_sort(group.begin(), group.end(), [&](std::size_t a, std::size_t b) {
            return mesh.attributes[a].offset < mesh.attributes[b].offset;
        });
    return groups;
}

void lay_out(TriangleMesh& mesh, const Columns& columns, const Grouping& groups, std::uint32_t align) {
    mesh.attributes.resize(columns.size());
    mesh.streams.clear();
    for (const std::vector<std::size_t>& group : groups) {
        std::uint32_t stride = 0;
        for (const std::size_t i : group) {
            mesh.attributes[i] = columns[i].format;
            mesh.attributes[i].buffer = static_cast<std::uint32_t>(mesh.streams.size());
            mesh.attributes[i].offset = stride;
            stride += aligned(columns[i].format.bytes(), align);
        }
        TriangleMesh::Stream stream{mesh.name + " vertices", stride,
                                    std::vector<std::byte>(std::size_t{mesh.vertices} * stride)};
        for (const std::size_t i : group) {
            mesh.attributes[i].stride = stride;
            const std::uint32_t size = columns[i].format.bytes();
            CHECK(columns[i].elements.size() == std::size_t{mesh.vertices} * size);
            for (std::size_t v = 0; v < mesh.vertices; ++v)
                std::memcpy(stream.records.data() + v * stride + mesh.attributes[i].offset,
                            columns[i].elements.data() + v * size, size);
        }
        mesh.streams.push_back(std::move(stream));
    }
}

} // namespace traces
