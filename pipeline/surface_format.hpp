// Formats of surfaces: bytes, channels and what a channel is. What a format does to a value is in
// functional/surface_texel.hpp. Block-compressed ones are read only: stores hold their texels decoded, to rgba8 or
// srgb8a8, and give them the addresses of the blocks.
#pragma once

#include "sim/field.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace pipeline {

enum class SurfaceFormat : std::uint8_t {
    r8,
    rg8,
    rgba8,
    srgb8a8, ///< blended in linear light, stored sRGB-encoded; alpha as in rgba8
    rgb10a2, ///< red in the low bits
    r11g11b10f,
    r16f,
    rg16f,
    rgba16f,
    r32f,
    rg32f,
    rgba32f,
    r32u,
    rg32u,
    d16,
    d24, ///< in the low bits of 4 bytes
    d24s8,
    d32f,
    s8,
    r16, ///< unsigned, normalised
    rg16,
    rgba16,
    r8s, ///< signed, normalised
    rg8s,
    rgba8s,
    r8u, ///< whole numbers without sign,
    rg8u,
    rgba8u,
    r16u,
    rg16u,
    rgba16u,
    rgba32u,
    r8i, ///< and with sign
    rg8i,
    rgba8i,
    r16i,
    rg16i,
    rgba16i,
    r32i,
    rg32i,
    rgba32i,
    bc1, ///< S3TC (DXT1), with its one bit of alpha
    bc2, ///< DXT3
    bc3, ///< DXT5
    srgb_bc1,
    srgb_bc2,
    srgb_bc3
};

/// What the channels of a format hold.
enum class ChannelKind : std::uint8_t { unorm, srgb, snorm, floating, integer, signed_integer, depth, stencil };

struct SurfaceFormatInfo {
    std::string_view name;
    std::uint8_t bytes = 0; ///< of one texel
    std::uint8_t channels = 0;
    ChannelKind kind = ChannelKind::unorm; ///< depth also of a format that has both depth and stencil
    bool stencil = false;
    std::uint8_t block_bytes = 0; ///< in memory, of the 4x4 texels of a compressed block; 0: not compressed
};

inline constexpr std::array<SurfaceFormatInfo, 47> surface_formats{{
    {"r8", 1, 1, ChannelKind::unorm},
    {"rg8", 2, 2, ChannelKind::unorm},
    {"rgba8", 4, 4, ChannelKind::unorm},
    {"srgb8a8", 4, 4, ChannelKind::srgb},
    {"rgb10a2", 4, 4, ChannelKind::unorm},
    {"r11g11b10f", 4, 3, ChannelKind::floating},
    {"r16f", 2, 1, ChannelKind::floating},
    {"rg16f", 4, 2, ChannelKind::floating},
    {"rgba16f", 8, 4, ChannelKind::floating},
    {"r32f", 4, 1, ChannelKind::floating},
    {"rg32f", 8, 2, ChannelKind::floating},
    {"rgba32f", 16, 4, ChannelKind::floating},
    {"r32u", 4, 1, ChannelKind::integer},
    {"rg32u", 8, 2, ChannelKind::integer},
    {"d16", 2, 1, ChannelKind::depth},
    {"d24", 4, 1, ChannelKind::depth},
    {"d24s8", 4, 2, ChannelKind::depth, true},
    {"d32f", 4, 1, ChannelKind::depth},
    {"s8", 1, 1, ChannelKind::stencil, true},
    {"r16", 2, 1, ChannelKind::unorm},
    {"rg16", 4, 2, ChannelKind::unorm},
    {"rgba16", 8, 4, ChannelKind::unorm},
    {"r8s", 1, 1, ChannelKind::snorm},
    {"rg8s", 2, 2, ChannelKind::snorm},
    {"rgba8s", 4, 4, ChannelKind::snorm},
    {"r8u", 1, 1, ChannelKind::integer},
    {"rg8u", 2, 2, ChannelKind::integer},
    {"rgba8u", 4, 4, ChannelKind::integer},
    {"r16u", 2, 1, ChannelKind::integer},
    {"rg16u", 4, 2, ChannelKind::integer},
    {"rgba16u", 8, 4, ChannelKind::integer},
    {"rgba32u", 16, 4, ChannelKind::integer},
    {"r8i", 1, 1, ChannelKind::signed_integer},
    {"rg8i", 2, 2, ChannelKind::signed_integer},
    {"rgba8i", 4, 4, ChannelKind::signed_integer},
    {"r16i", 2, 1, ChannelKind::signed_integer},
    {"rg16i", 4, 2, ChannelKind::signed_integer},
    {"rgba16i", 8, 4, ChannelKind::signed_integer},
    {"r32i", 4, 1, ChannelKind::signed_integer},
    {"rg32i", 8, 2, ChannelKind::signed_integer},
    {"rgba32i", 16, 4, ChannelKind::signed_integer},
    {"bc1", 4, 4, ChannelKind::unorm, false, 8},
    {"bc2", 4, 4, ChannelKind::unorm, false, 16},
    {"bc3", 4, 4, ChannelKind::unorm, false, 16},
    {"srgb_bc1", 4, 4, ChannelKind::srgb, false, 8},
    {"srgb_bc2", 4, 4, ChannelKind::srgb, false, 16},
    {"srgb_bc3", 4, 4, ChannelKind::srgb, false, 16},
}};

constexpr const SurfaceFormatInfo& info_of(SurfaceFormat format) {
    return surface_formats[static_cast<std::size_t>(format)];
}
constexpr std::uint32_t bytes_of(SurfaceFormat format) { return info_of(format).bytes; }
constexpr bool has_depth(SurfaceFormat format) { return info_of(format).kind == ChannelKind::depth; }
constexpr bool has_stencil(SurfaceFormat format) { return info_of(format).stencil; }
/// Bytes of a compressed block of 4x4 texels; 0: not compressed.
constexpr std::uint32_t block_bytes_of(SurfaceFormat format) { return info_of(format).block_bytes; }
constexpr bool is_compressed(SurfaceFormat format) { return block_bytes_of(format) != 0; }
constexpr bool is_integer(SurfaceFormat format) {
    return info_of(format).kind == ChannelKind::integer || info_of(format).kind == ChannelKind::signed_integer;
}
constexpr bool is_colour(SurfaceFormat format) { return !has_depth(format) && !has_stencil(format); }
/// Steps between an alpha of 0 and one of 1 that alpha tests tell apart: those that the format stores, or where it has
/// no alpha, those of its other channels. 0: it stores floats or whole numbers, and tests compare floats.
/// Source: OpenGL 2.1, section 4.1.4. llvmpipe does so for channels of 8 bits alone.
constexpr std::uint32_t alpha_steps(SurfaceFormat format) {
    if (format == SurfaceFormat::rgb10a2) return 3;
    const SurfaceFormatInfo& info = info_of(format);
    if (info.kind != ChannelKind::unorm && info.kind != ChannelKind::srgb) return 0;
    return (1U << info.bytes * 8U / info.channels) - 1U;
}

/// The smallest step of a depth format, by which a constant depth bias counts; 0: that of a 32-bit float at the depth.
constexpr double depth_step(SurfaceFormat format) {
    return format == SurfaceFormat::d32f ? 0.0 : format == SurfaceFormat::d16 ? 0x1p-16 : 0x1p-24;
}

inline constexpr std::uint32_t largest_texel = 16; ///< bytes

/// What a 16-bit float channel becomes of a number whose nearest multiple of its step lies beyond 65504.
enum class Fp16Overflow : std::uint8_t {
    saturate, ///< 65504 with its sign; NaN becomes 0
    infinity  ///< as IEEE 754 rounds it; NaN stays
};

} // namespace pipeline

template <>
struct sim::EnumNames<pipeline::Fp16Overflow> {
    static constexpr std::array<std::string_view, 2> names{"saturate", "infinity"};
};
template <>
struct sim::EnumNames<pipeline::SurfaceFormat> {
    static constexpr auto names = [] {
        std::array<std::string_view, pipeline::surface_formats.size()> list;
        for (std::size_t i = 0; i < list.size(); ++i) list[i] = pipeline::surface_formats[i].name;
        return list;
    }();
};
