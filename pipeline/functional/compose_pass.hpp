// Passes over the screen that take no time.
#pragma once

#include "pipeline/frame.hpp"

namespace pipeline {

/// Runs pass.shader on every pixel of the targets, which are all of one size, and stores what it makes: nothing is
/// blended, masked or discarded. `surfaces` holds what the shader reads. The result is the same for any number of
/// threads (0 = all cores).
void compose(const Pass& pass, SurfaceStore& surfaces, unsigned threads = 0);

} // namespace pipeline
