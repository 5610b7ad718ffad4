// Number formats of buffers and surfaces: IEEE half, unsigned normalised 8 bits, sRGB; all bit-exact.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace pipeline {

/// Nearest integer, ties to even, |value| < 2^51; whatever the rounding mode functions of the C library cost.
constexpr double round_even(double value) {
    // Adding 1.5 * 2^52 leaves no bits for a fraction; the FPU rounds them off to nearest even.
    constexpr double magic = 0x1.8p52;
    return (value + magic) - magic;
}

/// binary16 -> binary32, exact. Infinities and NaNs stay what they are.
constexpr float half_to_float(std::uint16_t half) {
    const std::uint32_t sign = (half & 0x8000U) << 16U, size = (half & 0x7FFFU) << 13U;
    constexpr std::uint32_t infinite = 0x1FU << 23U, all_ones = 0xFFU << 23U;
    if (size >= infinite) return std::bit_cast<float>(sign | all_ones | size);
    // The exponent's bias grows from 15 to 127; the product is exact, also of what is subnormal before it.
    return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(std::bit_cast<float>(size) * 0x1p112F));
}

/// Halfway between 65504, the largest finite binary16, and what would be the next: from here on numbers are infinite.
inline constexpr float infinite_half = 65520.0F;

/// binary32 -> binary16, to nearest even; from infinite_half on infinity.
std::uint16_t float_to_half(float value);

/// [0,1] -> 0..255 to nearest even. Below 0 and NaN give 0, above 1 gives 255.
constexpr std::uint8_t float_to_unorm8(float value) {
    if (!(value > 0.0F)) return 0;
    if (value >= 1.0F) return 255;
    return static_cast<std::uint8_t>(round_even(static_cast<double>(value) * 255.0)); // the product is exact
}
constexpr float unorm8_to_float(std::uint8_t code) { return static_cast<float>(code) / 255.0F; }

/// The linear value of an sRGB-encoded one (IEC 61966-2-1).
float srgb_decode(float encoded);
/// ... of every code.
const std::array<float, 256>& srgb_decode_table();

/// code / 255 of every code: the same for images that are not sRGB-encoded, and for alpha.
const std::array<float, 256>& unorm8_decode_table();

/// The nearest sRGB code of a linear value; clamps like float_to_unorm8.
std::uint8_t srgb_encode(float linear);

} // namespace pipeline
