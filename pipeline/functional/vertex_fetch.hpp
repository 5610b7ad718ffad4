// Reading vertices and indices out of buffers: every component type, normalised or not, any stride and alignment.
//
// The readers trust Resources::validate(): they check nothing.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/functional/number_formats.hpp"
#include "pipeline/raster_state.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/vec4.hpp>
#include <span>

namespace pipeline {

/// Reads elements of one vertex attribute as four floats.
///
/// Missing components are 0, the fourth 1 (OpenGL 4.5, section 10.2). Normalised signed integers map to
/// max(c / (2^(b-1) - 1), -1), unsigned ones to c / (2^b - 1) (section 2.3.5); others to their value. Packed types have
/// components of b = 10, 10, 10 and 2 bits.
class AttributeReader {
  public:
    /// `instance` counts where the attribute has a divisor: all elements are then the one of this instance.
    AttributeReader(const Resources& resources, const VertexAttribute& attribute, std::uint32_t instance = 0)
        : AttributeReader(resources.buffers[attribute.buffer].bytes.data(), attribute, instance) {}
    /// From the buffer that starts at `buffer`, whatever number the attribute gives.
    AttributeReader(const std::byte* buffer, const VertexAttribute& attribute, std::uint32_t instance = 0)
        : first_(buffer + attribute.offset +
                 (attribute.divisor == 0 ? 0 : std::uint64_t{attribute.stride} * (instance / attribute.divisor))),
          stride_(attribute.divisor == 0 ? attribute.stride : 0),
          type_(attribute.type),
          components_(attribute.components),
          normalized_(attribute.normalized) {}

    glm::vec4 operator()(std::uint32_t element) const {
        const std::byte* source = first_ + element * stride_;
        if (type_ == ComponentType::f32) return floats(source);
        return converted(source);
    }

  private:
    glm::vec4 floats(const std::byte* source) const {
        glm::vec4 result(0.0F, 0.0F, 0.0F, 1.0F);
        if (components_ == 3) { // by far the most frequent case: a copy of known size
            std::memcpy(&result, source, 12);
        } else {
            std::memcpy(&result, source, std::size_t{components_} * 4);
        }
        return result;
    }
    glm::vec4 converted(const std::byte* source) const;

    const std::byte* first_;
    std::uint64_t stride_;
    ComponentType type_;
    std::uint8_t components_;
    bool normalized_;
};

/// Whether the buffer of an attribute that advances by instances has elements for so many of them; true of others.
bool has_elements_for(const Resources& resources, const VertexAttribute& attribute, std::uint64_t instances);

/// Reads the i-th vertex number of a geometry, from the `first`-th on; the number is first + i where there is no index
/// buffer.
class IndexReader {
  public:
    IndexReader(const Resources& resources, const Geometry& geometry, std::uint32_t first = 0)
        : first_(geometry.index_type == IndexType::none
                     ? nullptr
                     : resources.buffers[geometry.index_buffer].bytes.data() + geometry.index_offset +
                           std::uint64_t{first} * bytes_of(geometry.index_type)),
          without_buffer_(first),
          type_(geometry.index_type) {}

    std::uint32_t operator()(std::uint32_t i) const {
        switch (type_) {
        case IndexType::u32:
            return read<std::uint32_t>(i);
        case IndexType::u16:
            return read<std::uint16_t>(i);
        case IndexType::u8:
            return read<std::uint8_t>(i);
        case IndexType::none:
            break;
        }
        return without_buffer_ + i;
    }

  private:
    template <class Index>
    std::uint32_t read(std::uint32_t i) const {
        Index value;
        std::memcpy(&value, first_ + std::size_t{i} * sizeof(Index), sizeof(Index));
        return value;
    }

    const std::byte* first_;
    std::uint32_t without_buffer_;
    IndexType type_;
};

/// Assembles the primitives of a geometry in its topology, which must outlive the reader; of a list of triangles from
/// `first_triangle` on.
class PrimitiveReader {
  public:
    PrimitiveReader(const Resources& resources, const Geometry& geometry, std::uint32_t first_triangle = 0)
        : index_(resources, geometry, 3 * first_triangle),
          topology_(geometry.topology),
          primitives_(geometry.primitive_count()),
          runs_(geometry.runs) {}

    /// The run of indices that a primitive is made of; all of them where primitive restart is off.
    IndexRun run_of(std::uint32_t primitive) const { return runs_.empty() ? IndexRun{} : *(behind(primitive) - 1); }

    /// The vertices of a primitive; every second triangle of a strip is turned round so that all wind alike (glTF 2.0,
    /// section 3.7.2.1). Points and lines repeat their last vertex.
    std::array<std::uint32_t, 3> operator()(std::uint32_t primitive) const {
        const IndexRun run = run_of(primitive);
        const std::uint32_t number = primitive - run.first_primitive;
        const std::uint32_t first = run.first_index + number;
        switch (topology_) {
        case Topology::triangles:
            return {index_(first + 2 * number), index_(first + 2 * number + 1), index_(first + 2 * number + 2)};
        case Topology::triangle_strip: {
            const std::uint32_t odd = number & 1U;
            return {index_(first), index_(first + 1 + odd), index_(first + 2 - odd)};
        }
        case Topology::triangle_fan:
            return {index_(first + 1), index_(first + 2), index_(run.first_index)};
        case Topology::points:
            return line(first, first);
        case Topology::lines:
            return line(first + number, first + number + 1);
        case Topology::line_strip:
            return line(first, first + 1);
        case Topology::line_loop:
            break;
        }
        return line(first, closes_loop(primitive) ? run.first_index : first + 1);
    }

    /// Which of the vertices is the provoking one (OpenGL 4.5, table 13.2).
    std::size_t provoking(std::uint32_t primitive, ProvokingVertex which) const {
        if (which == ProvokingVertex::first || topology_ == Topology::points) return 0;
        if (topology_ == Topology::triangles) return 2;
        if (topology_ != Topology::triangle_strip) return 1; // a fan's triangle ends with the centre
        return ((primitive - run_of(primitive).first_primitive) & 1U) == 0 ? 2 : 1;
    }

    /// Indices up to the last one that a primitive reads, from the first one of the geometry on.
    std::uint32_t indices_needed(std::uint32_t primitive) const {
        const IndexRun run = run_of(primitive);
        const std::uint32_t number = primitive - run.first_primitive;
        const std::uint32_t corners = corners_of(topology_);
        if (is_list(topology_)) return run.first_index + corners * (number + 1);
        return run.first_index + number + corners - (closes_loop(primitive) ? 1 : 0);
    }
    /// How many of them no primitive before it reads.
    std::uint32_t new_indices(std::uint32_t primitive) const {
        if (is_list(topology_) || primitive == run_of(primitive).first_primitive) return corners_of(topology_);
        return closes_loop(primitive) ? 0 : 1;
    }
    /// The first index that the primitives behind this one read, as long as they belong to its run; the centre of a fan
    /// and the begin of a loop are kept.
    std::uint32_t first_index_after(std::uint32_t primitive) const {
        if (is_list(topology_)) return indices_needed(primitive);
        return indices_needed(primitive) - (topology_ == Topology::triangle_strip ? 2 : 1);
    }

  private:
    std::array<std::uint32_t, 3> line(std::uint32_t from, std::uint32_t to) const {
        const std::uint32_t last = index_(to);
        return {index_(from), last, last};
    }
    /// The first run behind that of a primitive.
    std::span<const IndexRun>::iterator behind(std::uint32_t primitive) const {
        return std::upper_bound(runs_.begin(), runs_.end(), primitive,
                                [](std::uint32_t p, const IndexRun& run) { return p < run.first_primitive; });
    }
    bool closes_loop(std::uint32_t primitive) const {
        if (topology_ != Topology::line_loop) return false;
        return primitive + 1 == (runs_.empty() ? primitives_ : behind(primitive)->first_primitive);
    }

    IndexReader index_;
    Topology topology_;
    std::uint32_t primitives_;
    std::span<const IndexRun> runs_;
};

/// A triangle of fewer than three vertices, as stitches of strips are: it has no area from wherever it is seen.
constexpr bool names_a_vertex_twice(const std::array<std::uint32_t, 3>& corners) {
    return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
}

/// A primitive of which nothing is drawn, wherever its vertices lie.
constexpr bool is_degenerate(Topology topology, const std::array<std::uint32_t, 3>& vertices) {
    if (corners_of(topology) == 3) return names_a_vertex_twice(vertices);
    return topology != Topology::points && vertices[0] == vertices[1];
}

/// What Geometry::runs has to hold where primitive restart is on; the index buffer has to be in range.
std::vector<IndexRun> index_runs(const Resources& resources, const Geometry& geometry);

/// The vertices [first, end) that the indices of a geometry lie in, restarts aside; {0, 0} when there are none.
struct VertexRange {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
};
VertexRange used_vertices(const Resources& resources, const Geometry& geometry);
/// The same of `count` indices from the `first`-th on.
VertexRange used_vertices(const Resources& resources, const Geometry& geometry, std::uint32_t first,
                          std::uint32_t count);

} // namespace pipeline
