// Numbers for the four pixels of a quad, which are computed together.
#pragma once

#include <array>
#include <cstdint>

namespace pipeline {

/// One number for each pixel of a quad; pixel i is (x + i % 2, y + i / 2). Loops over the four compile to vector code.
using Lanes = std::array<float, 4>;

/// Pixels in a coverage mask. (The processor's own instruction is not in the baseline that programs are built for.)
constexpr std::uint32_t pixels_in(unsigned mask) {
    constexpr std::array<std::uint8_t, 16> counts{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
    return counts[mask & 15U];
}

} // namespace pipeline
