#include "pipeline/functional/number_formats.hpp"

#include <algorithm>
#include <cmath>

namespace pipeline {

namespace {

double srgb_to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::array<float, 256> make_srgb_table() {
    std::array<float, 256> table{};
    for (std::size_t code = 0; code < 256; ++code)
        table[code] = static_cast<float>(srgb_to_linear(static_cast<double>(code) / 255.0));
    return table;
}

std::array<float, 256> make_unorm8_table() {
    std::array<float, 256> table{};
    for (std::size_t code = 0; code < 256; ++code) table[code] = unorm8_to_float(static_cast<std::uint8_t>(code));
    return table;
}

// Entry c lies halfway (in the encoded domain) between the codes c and c + 1.
std::array<float, 255> make_srgb_boundaries() {
    std::array<float, 255> table{};
    for (std::size_t code = 0; code < 255; ++code)
        table[code] = static_cast<float>(srgb_to_linear((static_cast<double>(code) + 0.5) / 255.0));
    return table;
}

} // namespace

std::uint16_t float_to_half(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = (bits >> 16U) & 0x8000U;
    std::uint32_t size = bits & 0x7FFFFFFFU;
    if (size > 0x7F800000U) return static_cast<std::uint16_t>(sign | 0x7E00U);  // NaN
    if (size >= 0x477FF000U) return static_cast<std::uint16_t>(sign | 0x7C00U); // 65520: halfway to what would be 2^16
    if (size < 0x38800000U) {                                                   // below 2^-14: a multiple of 2^-24
        const double steps = round_even(static_cast<double>(std::bit_cast<float>(size)) * 0x1p24);
        return static_cast<std::uint16_t>(sign | static_cast<std::uint32_t>(steps));
    }
    size += 0xFFFU + ((size >> 13U) & 1U); // nearest even; a carry runs into the exponent, which is right
    return static_cast<std::uint16_t>(sign | ((size - 0x38000000U) >> 13U));
}

float srgb_decode(float encoded) { return static_cast<float>(srgb_to_linear(static_cast<double>(encoded))); }

const std::array<float, 256>& srgb_decode_table() {
    static const std::array<float, 256> table = make_srgb_table();
    return table;
}

const std::array<float, 256>& unorm8_decode_table() {
    static const std::array<float, 256> table = make_unorm8_table();
    return table;
}

std::uint8_t srgb_encode(float linear) {
    static const std::array<float, 255> boundaries = make_srgb_boundaries();
    if (!(linear > 0.0F)) return 0;
    const auto place = std::upper_bound(boundaries.begin(), boundaries.end(), linear);
    return static_cast<std::uint8_t>(place - boundaries.begin());
}

} // namespace pipeline
