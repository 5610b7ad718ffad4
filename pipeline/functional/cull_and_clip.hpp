// From a primitive's transformed vertices to the triangles, lines and points that are rasterized: culling and clipping.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/functional/clip.hpp"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

namespace pipeline {

/// Which side of a triangle is culled.
enum class Culling : std::uint8_t {
    none,              ///< double-sided materials
    clockwise,         ///< the back of a mesh whose front faces wind counter-clockwise, as glTF's do
    counter_clockwise, ///< the same mesh under a mirroring model matrix (glTF 2.0, section 3.7.4)
    both,
};

/// Culling of a mesh under a model matrix.
Culling culling_of(bool double_sided, const glm::mat4& model);
/// Culling of a state that does not leave it to the material.
Culling culling_of(const RasterState& state);

/// One rasterized part of a primitive.
struct PrimitivePart {
    std::array<ScreenVertex, 3> corners;
    std::array<glm::vec3, 3> weights; ///< barycentric coordinates of the corners; set only where clipped
};

struct PrimitiveParts {
    PrimitiveFate fate = PrimitiveFate::drawn;
    bool clipped = false;
    std::uint32_t count = 0;
    std::array<PrimitivePart, most_clipped_corners - 2>
        parts; ///< the first `count`, each of non-zero area and touching the viewport
};

/// Decides the fate of a triangle, in this order: a vertex that is not finite, or no area on the sub-pixel grid, makes
/// it degenerate; all vertices beyond one plane of the view volume or of the user, or no part on the screen, put it
/// outside; then facing. `parts` is overwritten; it is a parameter so that a loop over primitives need not clear it.
void cull_and_clip(const Viewport& viewport, Culling culling, const PrimitiveCorners& triangle, PrimitiveParts& parts);
/// The same of a point: the first corner. Its one part is the square around it, see PointSquare::corners. It is drawn
/// where its centre lies inside, and then as a whole.
void cull_point(const Viewport& viewport, const PrimitiveCorners& point, PrimitiveParts& parts);
/// The same of a line: the first two corners, which its one part repeats with the second one twice. One of no length on
/// the sub-pixel grid is degenerate.
void cull_and_clip_line(const Viewport& viewport, const RasterState& state, const PrimitiveCorners& line,
                        PrimitiveParts& parts);

} // namespace pipeline
