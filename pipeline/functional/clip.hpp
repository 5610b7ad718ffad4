// Clipping of triangles and lines: exactly against the near and far planes and those of the user, in x and y only
// against the guard band.
//
// Two triangles that share an edge get the same new vertices on it, bit for bit: an edge is always cut from its inner
// end, the planes always come in the same order. So no crack opens between them.
#pragma once

#include "pipeline/functional/vertex_transform.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace pipeline {

/// Signed distances of a vertex from the user's planes (RasterState::clip_plane); of those that do not cut, 0.
using ClipDistances = std::array<float, most_clip_distances>;

/// The planes of a state, for positions in model space.
class UserPlanes {
  public:
    UserPlanes(const RasterState& state, const glm::dmat4& model_to_eye);

    /// Distances of a position (of which w is 1), and which of them are negative, in `vertex`.
    ClipDistances measure(const glm::vec4& position, ScreenVertex& vertex) const;

  private:
    std::uint32_t cutting_;
    std::array<glm::dvec4, most_clip_distances> planes_{};
};

/// The vertices of a primitive; `distances` are null where no plane of the user cuts.
struct PrimitiveCorners {
    std::array<const ScreenVertex*, 3> vertices{};
    std::array<const ClipDistances*, 3> distances{};
    float point_size = 1.0F; ///< pixels; of a point
};

/// A corner of a clipped triangle.
struct ClippedCorner {
    glm::dvec4 clip{};    ///< clip coordinates
    glm::dvec3 weights{}; ///< its barycentric coordinates in the unclipped triangle
};

inline constexpr std::uint32_t most_clip_planes = 6 + most_clip_distances;
inline constexpr std::uint32_t most_clipped_corners = 3 + most_clip_planes;

/// A convex polygon: a triangle, or line, cut by planes.
struct ClippedPolygon {
    std::array<ClippedCorner, most_clipped_corners> corners;
    std::uint32_t count = 0; ///< 0: nothing is left
};

/// Clips against those planes that some corner is outside of. All coordinates must be finite.
ClippedPolygon clip_triangle(const Viewport& viewport, const PrimitiveCorners& triangle);
/// The same of the line between corners 0 and 1: two corners, or none.
ClippedPolygon clip_line(const Viewport& viewport, const PrimitiveCorners& line);

/// The corner as a vertex; never outside of the guard band, whatever the rounding of the cut.
ScreenVertex screen_vertex(const Viewport& viewport, const ClippedCorner& corner);

} // namespace pipeline
