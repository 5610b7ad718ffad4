// What every geometry stage may read about the pass that is running. It changes only between runs of the event core.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/fragment_stream.hpp"
#include "sim/check.hpp"

#include <array>
#include <span>

namespace pipeline {

struct GeometryPass {
    std::uint32_t             number    = 0; ///< passes started so far; 0: none
    const FragmentStream*     stream    = nullptr;
    const Resources*          resources = nullptr;
    std::span<const Draw>     draws; ///< what DrawRange::draw counts
    std::span<const DrawRange> ranges; ///< those to walk; a message's `range` is an index into it

    const DrawRange& range(std::uint32_t index) const { return ranges[index]; }
    const Draw&      draw(std::uint32_t range) const { return draws[ranges[range].draw]; }
    const Geometry&  geometry(std::uint32_t range) const { return resources->geometries[draw(range).geometry]; }
};

/// Places of the three corners of triangle `n` in the draw's list of indices (or of vertices when not indexed), in an
/// order that keeps the facing of a strip's odd triangles.
constexpr std::array<std::uint32_t, 3> corners_of(Topology topology, std::uint32_t n) {
    switch (topology) {
    case Topology::triangles: return {3 * n, 3 * n + 1, 3 * n + 2};
    case Topology::triangle_strip:
        return n % 2 == 0 ? std::array{n, n + 1, n + 2} : std::array{n + 1, n, n + 2};
    case Topology::triangle_fan: return {0, n + 1, n + 2};
    }
    return {};
}

/// The vertex numbers of a geometry, read from its index buffer if it has one.
class IndexReader {
  public:
    IndexReader() = default;
    /// `geometry` must have been validated.
    IndexReader(const Resources& resources, const Geometry& geometry)
        : type_(geometry.index_type),
          data_(type_ == IndexType::none
                    ? nullptr
                    : resources.buffers[geometry.index_buffer].bytes.data() + geometry.index_offset) {}

    std::uint32_t operator()(std::uint32_t place) const {
        if (type_ == IndexType::none) return place;
        const std::uint32_t size  = bytes_of(type_);
        std::uint32_t       index = 0;
        for (std::uint32_t i = 0; i < size; ++i)
            index |= std::to_integer<std::uint32_t>(data_[std::size_t{place} * size + i]) << (8 * i);
        return index;
    }

  private:
    IndexType        type_ = IndexType::none;
    const std::byte* data_ = nullptr;
};

} // namespace pipeline
