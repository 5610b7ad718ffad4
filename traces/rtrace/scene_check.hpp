// What has to hold between the parts of a trace, or of numbers together, before anything relies on it.
#pragma once

#include "traces/trace.hpp"

namespace traces::rtrace {

/// Draws, cameras and lights; resources are finish_scene()'s business. Throws sim::InputError, beginning with the
/// scene's name.
void check_trace(const Trace& trace);

/// Instances and the captured frame's view, once the scene is finished.
void check_finished(const Trace& trace);

} // namespace traces::rtrace
