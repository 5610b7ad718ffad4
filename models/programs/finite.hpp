// What programs store is finite: a pixel with an infinity or a NaN would spoil what reads it, for good.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace models {

/// An infinity becomes the largest float of its sign, what is not a number 0.
inline float finite(float value) {
    constexpr float largest = std::numeric_limits<float>::max();
    if (std::abs(value) <= largest) return value;
    return value > 0.0F ? largest : value < 0.0F ? -largest : 0.0F;
}

inline float finite(double value) {
    constexpr double largest = std::numeric_limits<float>::max();
    return value == value ? static_cast<float>(std::clamp(value, -largest, largest)) : 0.0F;
}

} // namespace models
