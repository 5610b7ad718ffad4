// The fragment streams of a frame: what each of its draw passes sends into the fragment stage.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/functional/front_end.hpp"

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace pipeline {

/// How much the streams of a frame may take.
struct StreamLimit {
    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
    std::string_view whose = "the limit is"; ///< before the number, where it is told
};

/// One stream for each pass that rasterizes, in pass order. What to shade and which faces to keep follows from the
/// frame; of `options`, threads, stop and progress count. Shaders that read surfaces have not run yet: see
/// shade_pass.hpp. Throws the sim::InputError that names the pass whose fragments go beyond `limit`, before it has room
/// made for them.
std::vector<FragmentStream> rasterize_frame(const Frame& frame, const FrontEndOptions& options = {},
                                            const StreamLimit& limit = {});

} // namespace pipeline
