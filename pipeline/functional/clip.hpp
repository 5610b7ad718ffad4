// Clipping of triangles: exactly against the near and far planes, in x and y only against the guard band.
//
// Two triangles that share an edge get the same new vertices on it, bit for bit: an edge is always cut from its inner
// end, the planes always come in the same order. So no crack opens between them.
#pragma once

#include "pipeline/functional/vertex_transform.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace pipeline {

/// A corner of a clipped triangle.
struct ClippedCorner {
    glm::dvec4 clip{};    ///< clip coordinates
    glm::dvec3 weights{}; ///< its barycentric coordinates in the unclipped triangle
};

/// A convex polygon: a triangle cut by up to six planes.
struct ClippedPolygon {
    std::array<ClippedCorner, 9> corners;
    std::uint32_t count = 0; ///< 0: nothing is left
};

/// Clips against those planes that some corner is outside of. All coordinates must be finite.
ClippedPolygon clip_triangle(const Viewport& viewport, const std::array<const ScreenVertex*, 3>& triangle);

/// The corner as a vertex; never outside of the guard band, whatever the rounding of the cut.
ScreenVertex screen_vertex(const Viewport& viewport, const ClippedCorner& corner);

} // namespace pipeline
