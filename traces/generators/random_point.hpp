// Random points whose coordinates are drawn in a fixed order, as that of a call's arguments is left to compilers.
#pragma once

#include "sim/random.hpp"

#include <glm/glm.hpp>

namespace traces {

/// In [0,1) x [0,1); y is drawn first.
inline glm::dvec2 random_in_square(sim::Random& random) {
    const double y = random.uniform(), x = random.uniform();
    return {x, y};
}

/// In [0,1) x [0,1) x [0,1); z is drawn first, then y.
inline glm::dvec3 random_in_cube(sim::Random& random) {
    const double z = random.uniform(), y = random.uniform(), x = random.uniform();
    return {x, y, z};
}

} // namespace traces
