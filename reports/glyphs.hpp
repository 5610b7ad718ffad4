// The letters of the legends in pictures: 5 x 7 dots each.
#pragma once

#include <array>
#include <cstdint>

namespace reports {

inline constexpr std::uint32_t glyph_width = 5;
inline constexpr std::uint32_t glyph_height = 7;

/// Row by row from the top; bit 4 of a row is its left dot.
using Glyph = std::array<std::uint8_t, glyph_height>;

/// The glyph of a printable ASCII character; that of '?' for anything else.
const Glyph& glyph_of(char character);

} // namespace reports
