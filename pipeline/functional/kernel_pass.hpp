// Kernels, run without time.
#pragma once

#include "pipeline/frame.hpp"

namespace pipeline {

/// Makes the targets of the pass anew: what no group of pass.kernel stores is cleared. `surfaces` holds what the kernel
/// reads, none of its targets. The result is the same for any number of threads (0 = all cores).
void run_kernel(const Pass& pass, SurfaceStore& surfaces, unsigned threads = 0);

} // namespace pipeline
