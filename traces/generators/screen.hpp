// Shapes placed on the screen, in pixels from the top left corner, with their window depth.
#pragma once

#include "traces/generators/mesh.hpp"

#include <cstdint>

namespace traces {

/// A triangle that covers exactly the four pixel centres of the 2x2 block whose top left corner is (x, y), so that it
/// makes one quad and no helper quads. It reaches one pixel beyond the block on the right, or on the left if `to_left`.
void add_one_quad_triangle(Mesh& mesh, float x, float y, float depth, Colour colour, bool to_left);

/// Two triangles that cover a rectangle. Needs indices.
void add_rectangle(Mesh& mesh, const glm::vec2& corner, const glm::vec2& size, float depth, Colour colour);

/// A scene of one draw of `mesh`, placed on the screen; vertices interleaved.
Scene screen_scene(const Mesh& mesh);

} // namespace traces
