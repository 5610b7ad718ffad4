#include "pipeline/functional/surface_texel.hpp"

#include "pipeline/functional/number_formats.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace pipeline {

namespace {

template <class T>
void store(std::byte* target, const T& value) {
    std::memcpy(target, &value, sizeof(value));
}
template <class T>
T load(const std::byte* source) {
    T value;
    std::memcpy(&value, source, sizeof(value));
    return value;
}

float saturated(float value, float largest) {
    if (std::isnan(value)) return 0.0F;
    return std::clamp(value, -largest, largest);
}

/// [0,1] -> 0..steps to nearest even; NaN gives 0.
std::uint32_t unorm_code(float value, std::uint32_t steps) {
    const float clamped = !(value > 0.0F) ? 0.0F : std::min(value, 1.0F);
    return static_cast<std::uint32_t>(round_even(static_cast<double>(clamped) * steps)); // the product is exact
}

// Floats without sign, of 5 bits of exponent: those of r11g11b10f.
std::uint32_t small_float_code(float value, unsigned fraction_bits) {
    if (!(value > 0.0F)) return 0;
    const std::uint32_t largest = (31U << fraction_bits) - 1;
    if (value < 0x1p-14F)
        return static_cast<std::uint32_t>(
            round_even(std::ldexp(static_cast<double>(value), 14 + static_cast<int>(fraction_bits))));
    const unsigned cut = 23U - fraction_bits;
    auto bits = std::bit_cast<std::uint32_t>(value);
    bits += (1U << (cut - 1U)) - 1U + ((bits >> cut) & 1U); // nearest even; a carry runs into the exponent
    return std::min((bits - (112U << 23U)) >> cut, largest);
}

float small_float_value(std::uint32_t code, unsigned fraction_bits) {
    const std::uint32_t exponent = code >> fraction_bits, fraction = code & ((1U << fraction_bits) - 1U);
    if (exponent == 0) return std::ldexp(static_cast<float>(fraction), -14 - static_cast<int>(fraction_bits));
    return std::bit_cast<float>((exponent + 112U) << 23U | fraction << (23U - fraction_bits));
}

// The sign of a NaN depends on the order of operands, which is a compiler's choice.
std::uint16_t half_code(float value, Fp16Overflow overflow) {
    if (overflow == Fp16Overflow::saturate) return float_to_half(saturated(value, 65504.0F));
    return std::isnan(value) ? std::uint16_t{0x7E00} : float_to_half(value);
}

void pack_halves(const glm::vec4& colour, int channels, std::byte* target, Fp16Overflow overflow) {
    for (int i = 0; i < channels; ++i) store(target + std::ptrdiff_t{2} * i, half_code(colour[i], overflow));
}

void pack_floats(const glm::vec4& colour, int channels, std::byte* target) {
    for (int i = 0; i < channels; ++i)
        store(target + std::ptrdiff_t{4} * i, saturated(colour[i], std::numeric_limits<float>::max()));
}

/// [-1,1] -> -127..127 to nearest even; NaN gives 0.
std::int8_t snorm8_code(float value) {
    return static_cast<std::int8_t>(round_even(static_cast<double>(saturated(value, 1.0F)) * 127.0));
}

/// Its most negative code stands for -1, too.
float snorm8_value(std::int8_t code) { return std::max(static_cast<float>(code) / 127.0F, -1.0F); }

/// An integer channel of 1, 2 or 4 bytes.
template <class Unsigned, class Signed>
std::uint32_t load_integer(const std::byte* source, bool has_sign) {
    if (has_sign) return static_cast<std::uint32_t>(static_cast<std::int32_t>(load<Signed>(source)));
    return load<Unsigned>(source);
}

constexpr double steps_of(SurfaceFormat format) { return format == SurfaceFormat::d16 ? 65535.0 : 16777215.0; }

} // namespace

void pack_colour(SurfaceFormat format, const glm::vec4& colour, std::byte* target, Fp16Overflow overflow) {
    const int channels = info_of(format).channels;
    switch (format) {
    case SurfaceFormat::r8:
    case SurfaceFormat::rg8:
    case SurfaceFormat::rgba8:
        for (int i = 0; i < channels; ++i) target[i] = static_cast<std::byte>(float_to_unorm8(colour[i]));
        break;
    case SurfaceFormat::srgb8a8:
        for (int i = 0; i < 3; ++i) target[i] = static_cast<std::byte>(srgb_encode(colour[i]));
        target[3] = static_cast<std::byte>(float_to_unorm8(colour.a));
        break;
    case SurfaceFormat::rgb10a2:
        store(target, unorm_code(colour.r, 1023) | unorm_code(colour.g, 1023) << 10U |
                          unorm_code(colour.b, 1023) << 20U | unorm_code(colour.a, 3) << 30U);
        break;
    case SurfaceFormat::r16:
    case SurfaceFormat::rg16:
    case SurfaceFormat::rgba16:
        for (int i = 0; i < channels; ++i)
            store(target + std::ptrdiff_t{2} * i, static_cast<std::uint16_t>(unorm_code(colour[i], 65535)));
        break;
    case SurfaceFormat::r8s:
    case SurfaceFormat::rg8s:
    case SurfaceFormat::rgba8s:
        for (int i = 0; i < channels; ++i) store(target + i, snorm8_code(colour[i]));
        break;
    case SurfaceFormat::r11g11b10f:
        store(target, small_float_code(colour.r, 6) | small_float_code(colour.g, 6) << 11U |
                          small_float_code(colour.b, 5) << 22U);
        break;
    case SurfaceFormat::r16f:
    case SurfaceFormat::rg16f:
    case SurfaceFormat::rgba16f:
        pack_halves(colour, channels, target, overflow);
        break;
    case SurfaceFormat::r32f:
    case SurfaceFormat::rg32f:
    case SurfaceFormat::rgba32f:
        pack_floats(colour, channels, target);
        break;
    default:
        CHECK_MSG(false, "integers, depths and compressed blocks are not packed from linear colour");
    }
}

glm::vec4 unpack_texel(SurfaceFormat format, const std::byte* source) {
    glm::vec4 colour(0.0F, 0.0F, 0.0F, 1.0F);
    const int channels = info_of(format).channels;
    switch (format) {
    case SurfaceFormat::r8:
    case SurfaceFormat::rg8:
    case SurfaceFormat::rgba8:
    case SurfaceFormat::bc1:
    case SurfaceFormat::bc2:
    case SurfaceFormat::bc3:
        for (int i = 0; i < channels; ++i) colour[i] = unorm8_to_float(static_cast<std::uint8_t>(source[i]));
        break;
    case SurfaceFormat::srgb8a8:
    case SurfaceFormat::srgb_bc1:
    case SurfaceFormat::srgb_bc2:
    case SurfaceFormat::srgb_bc3:
        for (int i = 0; i < 3; ++i) colour[i] = srgb_decode_table()[static_cast<std::uint8_t>(source[i])];
        colour.a = unorm8_to_float(static_cast<std::uint8_t>(source[3]));
        break;
    case SurfaceFormat::rgb10a2: {
        const auto bits = load<std::uint32_t>(source);
        for (int i = 0; i < 3; ++i) colour[i] = static_cast<float>(bits >> 10 * i & 1023U) / 1023.0F;
        colour.a = static_cast<float>(bits >> 30U) / 3.0F;
        break;
    }
    case SurfaceFormat::r11g11b10f: {
        const auto bits = load<std::uint32_t>(source);
        colour = {small_float_value(bits & 2047U, 6), small_float_value(bits >> 11U & 2047U, 6),
                  small_float_value(bits >> 22U, 5), 1.0F};
        break;
    }
    case SurfaceFormat::r16f:
    case SurfaceFormat::rg16f:
    case SurfaceFormat::rgba16f:
        for (int i = 0; i < channels; ++i)
            colour[i] = half_to_float(load<std::uint16_t>(source + std::ptrdiff_t{2} * i));
        break;
    case SurfaceFormat::r32f:
    case SurfaceFormat::rg32f:
    case SurfaceFormat::rgba32f:
        for (int i = 0; i < channels; ++i) colour[i] = load<float>(source + std::ptrdiff_t{4} * i);
        break;
    case SurfaceFormat::r16:
    case SurfaceFormat::rg16:
    case SurfaceFormat::rgba16:
        for (int i = 0; i < channels; ++i)
            colour[i] = static_cast<float>(load<std::uint16_t>(source + std::ptrdiff_t{2} * i)) / 65535.0F;
        break;
    case SurfaceFormat::r8s:
    case SurfaceFormat::rg8s:
    case SurfaceFormat::rgba8s:
        for (int i = 0; i < channels; ++i) colour[i] = snorm8_value(load<std::int8_t>(source + i));
        break;
    case SurfaceFormat::s8:
        colour.r = static_cast<float>(source[0]);
        break;
    case SurfaceFormat::d16:
    case SurfaceFormat::d24:
    case SurfaceFormat::d24s8:
    case SurfaceFormat::d32f:
        colour.r = depth_value(format, unpack_depth_stencil(format, source).depth);
        break;
    default: {
        const glm::uvec4 codes = unpack_integers(format, source);
        return info_of(format).kind == ChannelKind::integer ? glm::vec4(codes) : glm::vec4(glm::ivec4(codes));
    }
    }
    return colour;
}

std::array<glm::vec4, 4> unpack_texels(SurfaceFormat format, const std::array<const std::byte*, 4>& sources) {
    std::array<glm::vec4, 4> colours{};
    const bool halves = format == SurfaceFormat::rgba16f; // of most surfaces on the way to a picture
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (sources[i] == nullptr) continue;
        if (!halves) {
            colours[i] = unpack_texel(format, sources[i]);
            continue;
        }
        const auto codes = load<std::array<std::uint16_t, 4>>(sources[i]);
        colours[i] = {half_to_float(codes[0]), half_to_float(codes[1]), half_to_float(codes[2]),
                      half_to_float(codes[3])};
    }
    return colours;
}

glm::vec4 through_format(SurfaceFormat format, const glm::vec4& colour, Fp16Overflow overflow) {
    std::array<std::byte, largest_texel> bytes{};
    pack_colour(format, colour, bytes.data(), overflow);
    return unpack_texel(format, bytes.data());
}

void pack_integers(SurfaceFormat format, const glm::uvec4& values, std::byte* target) {
    CHECK(is_integer(format));
    const SurfaceFormatInfo& info = info_of(format);
    const std::size_t bytes = info.bytes / info.channels;
    for (int i = 0; i < info.channels; ++i) // the low bits come first
        std::memcpy(target + bytes * static_cast<std::size_t>(i), &values[i], bytes);
}

glm::uvec4 unpack_integers(SurfaceFormat format, const std::byte* source) {
    CHECK(is_integer(format));
    const SurfaceFormatInfo& info = info_of(format);
    const int bytes = info.bytes / info.channels;
    const bool has_sign = info.kind == ChannelKind::signed_integer;
    glm::uvec4 values(0U, 0U, 0U, 1U);
    for (int i = 0; i < info.channels; ++i) {
        const std::byte* channel = source + std::ptrdiff_t{bytes} * i;
        values[i] = bytes == 1   ? load_integer<std::uint8_t, std::int8_t>(channel, has_sign)
                    : bytes == 2 ? load_integer<std::uint16_t, std::int16_t>(channel, has_sign)
                                 : load<std::uint32_t>(channel);
    }
    return values;
}

DepthCode depth_code(SurfaceFormat format, float depth) {
    const float clamped = !(depth > 0.0F) ? 0.0F : (depth < 1.0F ? depth : 1.0F);
    // Non-negative floats order as their bits do; +0 is written for -0.
    if (format == SurfaceFormat::d32f) return std::bit_cast<std::uint32_t>(clamped);
    return static_cast<DepthCode>(round_even(static_cast<double>(clamped) * steps_of(format))); // the product is exact
}

float depth_value(SurfaceFormat format, DepthCode code) {
    if (format == SurfaceFormat::d32f) return std::bit_cast<float>(code);
    return static_cast<float>(static_cast<double>(code) / steps_of(format));
}

DepthCode farthest_depth(SurfaceFormat format) { return depth_code(format, 1.0F); }

void pack_depth_stencil(SurfaceFormat format, const DepthStencil& texel, std::byte* target) {
    if (format == SurfaceFormat::s8)
        store(target, texel.stencil);
    else if (format == SurfaceFormat::d16)
        store(target, static_cast<std::uint16_t>(texel.depth));
    else
        store(target, texel.depth | (has_stencil(format) ? std::uint32_t{texel.stencil} << 24U : 0U));
}

DepthStencil unpack_depth_stencil(SurfaceFormat format, const std::byte* source) {
    if (format == SurfaceFormat::s8) return {0, load<std::uint8_t>(source)};
    if (format == SurfaceFormat::d16) return {load<std::uint16_t>(source), 0};
    const auto bits = load<std::uint32_t>(source);
    if (!has_stencil(format)) return {bits, 0};
    return {bits & 0xFFFFFFU, static_cast<std::uint8_t>(bits >> 24U)};
}

} // namespace pipeline
