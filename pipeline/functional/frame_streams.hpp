// The fragment streams of a frame: what each of its draw passes sends into the fragment stage.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/functional/front_end.hpp"

#include <vector>

namespace pipeline {

/// One stream for each pass that rasterizes, in pass order. What to shade and which faces to keep follows from the
/// frame; of `options`, threads, stop and progress count. Shaders that read surfaces have not run yet: see
/// shade_pass.hpp.
std::vector<FragmentStream> rasterize_frame(const Frame& frame, const FrontEndOptions& options = {});

} // namespace pipeline
