// The stream of a full-screen pass.
#pragma once

#include "pipeline/fragment_stream.hpp"

namespace pipeline {

/// One triangle of draw `draw` that covers every pixel of a surface, in the order in which the rasterizer visits 8x8
/// tiles: row by row. Depths are 0, and there are no colours.
FragmentStream screen_stream(std::uint32_t width, std::uint32_t height, std::uint32_t draw);

} // namespace pipeline
