// Floats at the edges of what formats can tell apart.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace reports::stability {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float largest_float = std::numeric_limits<float>::max();
inline constexpr float smallest_float = std::numeric_limits<float>::denorm_min();

inline float next_up(float value) { return std::nextafter(value, infinity); }
inline float next_down(float value) { return std::nextafter(value, -infinity); }

/// Floats from `want` to `got`; infinite when `got` is not a number.
inline double ulps(float got, float want) {
    if (std::isnan(got)) return std::numeric_limits<double>::infinity();
    const auto place = [](float value) {
        const auto bits = std::bit_cast<std::int32_t>(value);
        return static_cast<double>(bits < 0 ? std::int32_t{-0x7FFFFFFF - 1} - bits : bits);
    };
    return place(got) - place(want);
}

} // namespace reports::stability
