// A floor below a scene, for its shadows to fall on.
#pragma once

#include "traces/scene.hpp"

namespace traces {

/// Appends a light grey square at the lowest point of the scene, level in y, whose edge is three times the scene's
/// radius, as a draw of its own; name and hash say so. Throws sim::InputError for a scene that lies on the screen.
void add_ground(Scene& scene);

} // namespace traces
