// Raster states and small scenes drawn by chance, for those who compare what two programs make of them.
#pragma once

#include "pipeline/raster_state.hpp"
#include "sim/random.hpp"

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace tests {

/// Blending, masks, depth and stencil; constants are multiples of 1/255. Often enough a test passes that something is
/// seen.
pipeline::RasterState random_state(sim::Random& random);

/// A triangle of constant depth and colour, corners in pixels (y down).
struct LevelTriangle {
    std::array<glm::vec2, 3> corners;
    float depth = 0;
    glm::vec4 colour{0.0F}; ///< multiples of 1/255
};

/// Of about `size` pixels, facing either way, at one of `levels` depths between 0 and 1; some coincide.
std::vector<LevelTriangle> level_triangles(std::uint32_t count, std::uint32_t width, std::uint32_t height, double size,
                                           std::uint32_t levels, sim::Random& random);

} // namespace tests
