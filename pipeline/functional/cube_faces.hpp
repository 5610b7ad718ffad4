// Cube maps: which face a direction meets, where, and what lies beyond a face's edges.
//
// Source: OpenGL 4.5 core, section 8.13, table 8.19. Faces are numbered +x, -x, +y, -y, +z, -z. Of equal components
// it lets anyone choose; here z comes before y, and y before x, as in Vulkan ("Cube Map Face Selection").
#pragma once

#include <array>
#include <cstdint>

namespace pipeline {

struct CubePlace {
    std::uint32_t face = 0;
    float s = 0.0F, t = 0.0F; ///< in [0,1] over the face; not a number for the direction 0
};

/// The place that a direction of any length meets.
CubePlace cube_place(const std::array<float, 3>& direction);

/// How far the place on this face moves, in widths of the face, when the direction, which meets the face, changes by
/// `change`: the derivative.
std::array<double, 2> cube_derivative(std::uint32_t face, const std::array<float, 3>& direction,
                                      const std::array<float, 3>& change);

struct CubeTexel {
    std::uint32_t face = 0;
    std::int32_t column = 0, row = 0;
};

/// The texel of another face that touches the edge where `column` or `row` is -1 or `size`; not both.
CubeTexel beyond_edge(const CubeTexel& texel, std::int32_t size);

} // namespace pipeline
