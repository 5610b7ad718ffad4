#include "traces/recording/import/geometry.hpp"

#include "traces/record_module/element_types.hpp"
#include "traces/record_module/writer.hpp"
#include "traces/recording/import/vertex_elements.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace traces::recorded {

using pipeline::IndexType;
using pipeline::Topology;

/// What the vertices of primitives are, one after the other; `restart` between some of them.
struct GeometryImport::Indices {
    std::vector<std::uint32_t> values;
    bool has_restart = false;
    bool rewritten = false; ///< else they are those in the buffer
    std::uint32_t vertices = 0;
};

namespace {

constexpr std::uint32_t restart = 0xFFFFFFFF;

std::optional<Topology> topology_of(std::uint32_t mode) {
    switch (mode) {
    case GL_POINTS:
        return Topology::points;
    case GL_LINES:
        return Topology::lines;
    case GL_LINE_STRIP:
        return Topology::line_strip;
    case GL_LINE_LOOP:
        return Topology::line_loop;
    case GL_TRIANGLES:
    case GL_QUADS:
        return Topology::triangles;
    case GL_TRIANGLE_STRIP:
    case GL_QUAD_STRIP:
        return Topology::triangle_strip;
    case GL_TRIANGLE_FAN:
    case GL_POLYGON:
        return Topology::triangle_fan;
    default:
        return std::nullopt;
    }
}

/// Triangles of what is none of the pipeline's topologies, each with its primitive's flat vertex last (OpenGL 2.1,
/// section 2.19).
std::vector<std::uint32_t> triangles_of(std::uint32_t mode, const std::vector<std::uint32_t>& vertices) {
    std::vector<std::uint32_t> result;
    const auto add = [&](std::initializer_list<std::size_t> corners) {
        for (const std::size_t corner : corners) result.push_back(vertices[corner]);
    };
    if (mode == GL_QUADS)
        for (std::size_t i = 0; i + 4 <= vertices.size(); i += 4) add({i, i + 1, i + 3, i + 1, i + 2, i + 3});
    if (mode == GL_QUAD_STRIP)
        for (std::size_t i = 0; i + 4 <= vertices.size(); i += 2) add({i, i + 1, i + 3, i + 2, i, i + 3});
    if (mode == GL_POLYGON)
        for (std::size_t i = 1; i + 2 <= vertices.size(); ++i) add({i, i + 1, 0});
    return result;
}

} // namespace

std::uint32_t semantic_of(std::uint32_t slot, std::uint32_t fog) {
    using pipeline::Semantic;
    const auto number = [](Semantic semantic) { return static_cast<std::uint32_t>(semantic); };
    if (slot >= record_stream::slot_generic) return number(Semantic::generic) + slot - record_stream::slot_generic;
    if (slot >= record_stream::slot_texcoord) return number(Semantic::texcoord0) + slot - record_stream::slot_texcoord;
    switch (slot) {
    case record_stream::slot_vertex:
        return number(Semantic::position);
    case record_stream::slot_normal:
        return number(Semantic::normal);
    case record_stream::slot_colour:
        return number(Semantic::colour);
    case record_stream::slot_secondary:
        return number(Semantic::secondary_colour);
    default:
        return fog;
    }
}

std::optional<std::uint32_t> GeometryImport::number_of(const record_stream::Geometry& geometry,
                                                       const GeometryRequest& request) {
    record_stream::Geometry shape = geometry;
    for (record_stream::Array& array : shape.arrays) array.current = {};
    const auto [place, is_new] =
        known_.try_emplace(record_stream::Writer::key(shape, request.flat, request.numbers, request.fog));
    if (is_new) place->second = make(geometry, request);
    return place->second;
}

std::optional<std::uint32_t> GeometryImport::make(const record_stream::Geometry& geometry,
                                                  const GeometryRequest& request) {
    const auto topology = topology_of(geometry.mode);
    if (!topology) {
        count_(fmt::format("primitives of mode 0x{:x}", geometry.mode));
        return std::nullopt;
    }
    pipeline::Geometry result;
    result.name = fmt::format("geometry {}", resources_.geometries.size());
    result.topology = *topology;
    const bool turned =
        geometry.mode == GL_QUADS || (request.flat && (geometry.mode == GL_QUAD_STRIP || geometry.mode == GL_POLYGON));
    const bool listed = geometry.index_type != 0 || turned || (request.numbers && geometry.first != 0);
    if (listed) {
        Indices indices = read_indices(geometry);
        if (turned) {
            result.topology = Topology::triangles;
            indices.values = triangles_of(geometry.mode, indices.values);
            indices.rewritten = true;
        }
        result.vertex_count = indices.vertices;
        set_indices(result, geometry, indices);
    } else {
        result.vertex_count = result.index_count = geometry.count;
    }
    for (const record_stream::Array& array : geometry.arrays) {
        if (array.blob < 0) continue;
        record_stream::Array from_first = array;
        if (!listed && array.divisor == 0) from_first.offset += std::uint64_t{geometry.first} * array.stride;
        if (array.divisor != 0) from_first.offset += std::uint64_t{geometry.base_instance} * array.stride;
        if (!add_array(result, geometry, from_first, request)) return std::nullopt;
    }
    resources_.geometries.push_back(std::move(result));
    return static_cast<std::uint32_t>(resources_.geometries.size() - 1);
}

GeometryImport::Indices GeometryImport::read_indices(const record_stream::Geometry& geometry) const {
    Indices indices;
    if (geometry.index_type == 0) {
        for (std::uint32_t i = 0; i < geometry.count; ++i) indices.values.push_back(geometry.first + i);
        indices.vertices = geometry.first + geometry.count;
        indices.rewritten = true;
        return indices;
    }
    const std::vector<std::byte>& bytes = blobs_.at(static_cast<std::size_t>(geometry.index_blob));
    const std::uint32_t size = record_stream::index_bytes(geometry.index_type);
    // Reading beyond a buffer gives 0 (OpenGL 4.5, section 6.4, of robust access).
    for (std::uint64_t i = 0; i < geometry.count; ++i) {
        const std::uint64_t at = geometry.index_offset + i * size;
        std::uint32_t value = 0;
        if (at + size <= bytes.size())
            std::memcpy(&value, &bytes[at], size);
        else
            indices.rewritten = true;
        if (geometry.restart && value == geometry.restart_index) {
            indices.values.push_back(restart);
            indices.has_restart = true;
        } else {
            const std::int64_t vertex = std::max<std::int64_t>(std::int64_t{value} + geometry.base_vertex, 0);
            indices.values.push_back(static_cast<std::uint32_t>(vertex));
            indices.vertices = std::max(indices.vertices, static_cast<std::uint32_t>(vertex) + 1);
        }
    }
    const std::uint32_t largest = 0xFFFFFFFFU >> (32 - 8 * size);
    indices.rewritten =
        indices.rewritten || geometry.base_vertex != 0 || (indices.has_restart && geometry.restart_index != largest);
    return indices;
}

void GeometryImport::set_indices(pipeline::Geometry& result, const record_stream::Geometry& geometry,
                                 const Indices& indices) {
    result.index_count = static_cast<std::uint32_t>(indices.values.size());
    result.primitive_restart = indices.has_restart;
    if (!indices.rewritten) {
        const std::uint32_t bytes = record_stream::index_bytes(geometry.index_type);
        result.index_type = bytes == 1 ? IndexType::u8 : bytes == 2 ? IndexType::u16 : IndexType::u32;
        result.index_buffer = buffer_of(geometry.index_blob);
        result.index_offset = geometry.index_offset;
        return;
    }
    result.index_type = indices.vertices <= 0xFFFF ? IndexType::u16 : IndexType::u32;
    const std::uint32_t size = pipeline::bytes_of(result.index_type);
    std::vector<std::byte> bytes(indices.values.size() * size);
    for (std::size_t i = 0; i < indices.values.size(); ++i) std::memcpy(&bytes[i * size], &indices.values[i], size);
    result.index_buffer = add_buffer(std::move(bytes));
}

bool GeometryImport::add_array(pipeline::Geometry& result, const record_stream::Geometry& geometry,
                               const record_stream::Array& array, const GeometryRequest& request) {
    const std::vector<std::byte>& bytes = blobs_.at(static_cast<std::size_t>(array.blob));
    const std::uint64_t elements =
        array.divisor == 0 ? result.vertex_count : (geometry.instances - 1) / array.divisor + 1;
    const std::uint32_t size = record_stream::element_bytes(array);
    if (size == 0) {
        count_(fmt::format("vertex attributes of type 0x{:x}", array.type));
        return false;
    }
    const bool fits =
        elements == 0 || (array.offset + size <= bytes.size() &&
                          (array.stride == 0 || (bytes.size() - array.offset - size) / array.stride >= elements - 1));
    if (!fits) {
        count_("draws that read vertices beyond a buffer");
        return false;
    }
    pipeline::VertexAttribute attribute;
    attribute.semantic = static_cast<pipeline::Semantic>(semantic_of(array.slot, request.fog));
    attribute.divisor = array.divisor;
    const auto type = component_type_of(array);
    if (type && array.stride >= size) {
        attribute.type = *type;
        attribute.components = static_cast<std::uint8_t>(array.components);
        attribute.normalized = array.normalized;
        attribute.buffer = buffer_of(array.blob);
        attribute.offset = array.offset;
        attribute.stride = array.stride;
    } else {
        if (array.integer || array.type == GL_HALF_FLOAT) {
            count_("vertex attributes of whole numbers in a type that there is not");
            return false;
        }
        count_("vertex attributes in a type that there is not (kept as floats)");
        attribute.components = static_cast<std::uint8_t>(record_stream::components_of(array));
        attribute.stride = attribute.components * 4U;
        attribute.buffer = add_buffer(as_floats(array, bytes, elements));
    }
    result.attributes.push_back(attribute);
    return true;
}

std::uint32_t GeometryImport::buffer_of(std::int32_t blob) {
    const auto [place, is_new] = buffers_.try_emplace(blob, 0);
    if (is_new) place->second = add_buffer(blobs_.at(static_cast<std::size_t>(blob)));
    return place->second;
}

std::uint32_t GeometryImport::add_buffer(std::vector<std::byte> bytes) {
    resources_.buffers.push_back({fmt::format("buffer {}", resources_.buffers.size()), std::move(bytes)});
    return static_cast<std::uint32_t>(resources_.buffers.size() - 1);
}

} // namespace traces::recorded
