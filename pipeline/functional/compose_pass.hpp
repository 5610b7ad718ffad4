// Passes that take no time.
#pragma once

#include "pipeline/frame.hpp"

namespace pipeline {

/// Runs pass.kernel, or pass.shader on every pixel of the targets, which are all of one size, and stores what it makes:
/// nothing is blended, masked or discarded. `surfaces` holds what it reads. The result is the same for any number of
/// threads (0 = all cores).
void compose(const Pass& pass, SurfaceStore& surfaces, unsigned threads = 0);

} // namespace pipeline
