// How much room a scene takes.
#pragma once

#include "traces/scene.hpp"

namespace traces {

struct Bounds {
    glm::vec3 lo{0.0F}, hi{0.0F};
    float radius = 0.0F; ///< largest distance of a drawn position from the middle of the box
};

/// Over the positions of all instances of all draws, in world space. Throws sim::InputError naming scene.name when a
/// position or its place in the world is not finite.
Bounds measure_bounds(const Scene& scene);

} // namespace traces
