// Colours of the pictures: linear light to what a display shows, and the ramps that turn numbers into colours.
#pragma once

#include "reports/images.hpp"

namespace reports {

/// sRGB encoding (IEC 61966-2-1) of linear light; values outside [0, 1] and NaN are clamped.
std::uint8_t encode_srgb(float linear);
Colour encode_srgb(float red, float green, float blue);

/// Counts and errors, `position` in [0, 1]: nearly black, violet, red, orange, pale yellow; rising in brightness, so
/// that it reads the same in grey.
Colour heat(double position);

/// Depths, `position` in [0, 1] from near to far: from white over orange to dark red.
Colour depth_shade(double position);

/// What stands for "nothing was stored here": a slate chequered pattern.
Colour empty_colour(std::uint32_t x, std::uint32_t y);

} // namespace reports
