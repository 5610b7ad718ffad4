// The language's arithmetic, for constants and for the interpreter. Every result is finite.
#pragma once

#include "models/programs/finite.hpp"

#include <algorithm>
#include <cmath>

namespace models::language {

/// Whole numbers are floats up to 2^24 in size, which hold each of them; larger results are cut to that.
inline constexpr float largest_whole = 16777216.0F;

inline float truncated(float value) { return std::clamp(std::trunc(value), -largest_whole, largest_whole); }

/// A division by zero gives the zero whose sign is that of the quotient.
inline float quotient(float a, float b) {
    if (b == 0.0F) return std::signbit(a) != std::signbit(b) ? -0.0F : 0.0F;
    return finite(a / b);
}

/// The same for whole numbers, in doubles: a float's rounding could reach the next whole number.
inline float whole_quotient(float a, float b) {
    if (b == 0.0F) return quotient(a, b);
    return static_cast<float>(std::trunc(static_cast<double>(a) / static_cast<double>(b)));
}

} // namespace models::language
