// Which texels a filter reads along one axis of an image, for the four pixels of a quad.
//
// Source: OpenGL 4.5 core, sections 8.14.2 (wrap modes) and 8.14.3 (filters). The functions take values, not
// references, and have no branches, so that compilers turn their loops over four pixels into vector code.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/functional/lanes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace pipeline {

using LaneTexels = std::array<std::int32_t, 4>; ///< indices along one axis; -1 or the size where the border is read

/// What a filter reads along one axis: two texels and the share of the second, or one texel and its right neighbour.
struct AxisReads {
    LaneTexels low, high;
    Lanes share;
};

namespace detail {

constexpr std::int32_t is_negative(float value) {
    return static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(value) >> 31U);
}

/// value - floor(value), in [0,1]; 1 only for -0 and for negative values that round up to it.
inline float fraction(float value) {
    // Floats from 2^23 on have no fraction bits, and conversion to an integer might overflow: they count as 0.
    const auto bits = std::bit_cast<std::int32_t>(value);
    const std::int32_t is_small = ((bits & 0x7FFFFFFF) - 0x4B000000) >> 31;
    const auto small = std::bit_cast<float>(bits & is_small);
    const float rest = small - static_cast<float>(static_cast<std::int32_t>(small));
    return rest + static_cast<float>(is_negative(rest));
}

/// `before` and `after` replace the indices -1 and size.
constexpr std::int32_t inside(std::int32_t index, std::int32_t size, std::int32_t before, std::int32_t after) {
    const std::int32_t is_before = index >> 31, is_after = (size - 1 - index) >> 31;
    return (index & ~(is_before | is_after)) | (before & is_before) | (after & is_after);
}

} // namespace detail

/// Maps texture coordinates to [0,1]; with a border, to a range that reaches one image beyond on either side.
inline Lanes wrapped(Wrap wrap, Lanes values) {
    Lanes result;
    if (wrap == Wrap::repeat) {
        for (std::size_t i = 0; i < 4; ++i) result[i] = detail::fraction(values[i]);
    } else if (wrap == Wrap::clamp) {
        for (std::size_t i = 0; i < 4; ++i) result[i] = std::clamp(values[i], 0.0F, 1.0F);
    } else if (wrap == Wrap::border) {
        for (std::size_t i = 0; i < 4; ++i) result[i] = std::clamp(values[i], -1.0F, 2.0F);
    } else {
        // Twice the distance to the nearest even number.
        for (std::size_t i = 0; i < 4; ++i)
            result[i] = 1.0F - std::fabs(2.0F * detail::fraction(values[i] * 0.5F) - 1.0F);
    }
    return result;
}

/// `places`: in texels from the beginning of the first one, from -2 to two beyond the last; where filtered linearly,
/// less half a texel.
inline AxisReads reads_at(Wrap wrap, Lanes places, std::uint32_t texels) {
    const auto size = static_cast<std::int32_t>(texels);
    // A mirror repeats its last texel; a border lies at -1 and size.
    const std::int32_t before = wrap == Wrap::repeat ? size - 1 : wrap == Wrap::border ? -1 : 0;
    const std::int32_t after = wrap == Wrap::repeat ? 0 : wrap == Wrap::border ? size : size - 1;
    AxisReads reads;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto truncated = static_cast<std::int32_t>(places[i]);
        const float rest = places[i] - static_cast<float>(truncated);
        const std::int32_t floor = truncated - detail::is_negative(rest);
        reads.low[i] = detail::inside(floor, size, before, after);
        reads.high[i] = detail::inside(floor + 1, size, before, after);
        reads.share[i] = rest + static_cast<float>(detail::is_negative(rest));
    }
    return reads;
}

/// `wrapped`: of wrapped(), for an axis of `texels` texels.
inline AxisReads reads_along(Wrap wrap, bool linear, Lanes wrapped, std::uint32_t texels) {
    const float offset = linear ? 0.5F : 0.0F;
    for (std::size_t i = 0; i < 4; ++i) wrapped[i] = wrapped[i] * static_cast<float>(texels) - offset;
    return reads_at(wrap, wrapped, texels);
}

} // namespace pipeline
