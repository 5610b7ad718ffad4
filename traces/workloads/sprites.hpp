// Points as sprites of constant size on the screen.
#pragma once

#include "pipeline/frame.hpp"

#include <glm/glm.hpp>
#include <vector>

namespace traces {

struct SpritePoint {
    glm::vec3 place{0.0F}; ///< eye space
    float scalar = 0;
};

/// Every vertex of every instance of the frame's draws, in order, with the red of its colour as scalar; 0 without one.
std::vector<SpritePoint> points_of(const pipeline::Frame& frame);

enum class SpriteColour : std::uint8_t { scalar, picture };

/// Replaces what the frame draws by two triangles for each point, facing the eye, `size` pixels wide and high, and its
/// view by that of the eye: positions are in eye space. Colours are the scalar as red, or a colour for its share of the
/// range of scalars.
void draw_sprites(pipeline::Frame& frame, const std::vector<SpritePoint>& points, double size, SpriteColour colour);

} // namespace traces
