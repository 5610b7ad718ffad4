// How the samples of a picture's pixels lie in a surface: as planes of pixels, one below the other. Sample s of pixel
// (x, y) is the *place* (x, y + s * plane rows); with one sample, places are pixels.
//
// Planes begin at multiples of the largest tile of any unit (16 rows), so that no tile holds two samples. The rows
// between the end of the picture and the next plane hold nothing.
#pragma once

#include <cstdint>

namespace pipeline {

inline constexpr std::uint32_t most_samples = 8;

/// Rows from one plane to the next. `height` in pixels.
constexpr std::uint32_t plane_rows(std::uint32_t height, std::uint32_t samples) {
    return samples == 1 ? height : (height + 15) / 16 * 16;
}

} // namespace pipeline
