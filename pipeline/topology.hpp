// How indices become primitives.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pipeline {

enum class Topology : std::uint8_t { triangles, triangle_strip, triangle_fan, points, lines, line_strip, line_loop };
inline constexpr Topology last_topology = Topology::line_loop;
/// Vertices of a primitive.
constexpr std::uint32_t corners_of(Topology topology) {
    if (topology <= Topology::triangle_fan) return 3;
    return topology == Topology::points ? 1 : 2;
}
/// Whether primitives share no vertices but by their indices.
constexpr bool is_list(Topology topology) {
    return topology == Topology::triangles || topology == Topology::points || topology == Topology::lines;
}
enum class IndexType : std::uint8_t { none, u8, u16, u32 };
constexpr std::uint32_t bytes_of(IndexType type) {
    constexpr std::array<std::uint32_t, 4> sizes{0, 1, 2, 4};
    return sizes[static_cast<std::size_t>(type)];
}

/// The value that ends a primitive where restart is on: the largest one of the type (OpenGL 4.5, section 10.3.6).
constexpr std::uint32_t restart_index(IndexType type) {
    constexpr std::array<std::uint32_t, 4> values{0, 0xFF, 0xFFFF, 0xFFFFFFFF};
    return values[static_cast<std::size_t>(type)];
}

/// Indices between two restarts that make at least one primitive.
struct IndexRun {
    std::uint32_t first_index = 0;
    std::uint32_t first_primitive = 0; ///< primitives of the runs before

    bool operator==(const IndexRun&) const = default;
};

/// Primitives of `count` indices without a restart. A loop has a line more than a strip: back to its first vertex.
constexpr std::uint32_t primitives_of(Topology topology, std::uint32_t count) {
    const std::uint32_t corners = corners_of(topology);
    if (is_list(topology)) return count / corners;
    if (count < corners) return 0;
    return topology == Topology::line_loop ? count : count - corners + 1;
}

} // namespace pipeline
