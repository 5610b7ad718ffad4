// Formats of surfaces: bytes, channels and what a channel is. What a format does to a value is in
// functional/surface_texel.hpp.
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
    s8
};

/// What the channels of a format hold.
enum class ChannelKind : std::uint8_t { unorm, srgb, floating, integer, depth, stencil };

struct SurfaceFormatInfo {
    std::string_view name;
    std::uint8_t bytes = 0; ///< of one texel
    std::uint8_t channels = 0;
    ChannelKind kind = ChannelKind::unorm; ///< depth also of a format that has both depth and stencil
    bool stencil = false;
};

inline constexpr std::array<SurfaceFormatInfo, 19> surface_formats{{
    {"r8", 1, 1, ChannelKind::unorm},          {"rg8", 2, 2, ChannelKind::unorm},
    {"rgba8", 4, 4, ChannelKind::unorm},       {"srgb8a8", 4, 4, ChannelKind::srgb},
    {"rgb10a2", 4, 4, ChannelKind::unorm},     {"r11g11b10f", 4, 3, ChannelKind::floating},
    {"r16f", 2, 1, ChannelKind::floating},     {"rg16f", 4, 2, ChannelKind::floating},
    {"rgba16f", 8, 4, ChannelKind::floating},  {"r32f", 4, 1, ChannelKind::floating},
    {"rg32f", 8, 2, ChannelKind::floating},    {"rgba32f", 16, 4, ChannelKind::floating},
    {"r32u", 4, 1, ChannelKind::integer},      {"rg32u", 8, 2, ChannelKind::integer},
    {"d16", 2, 1, ChannelKind::depth},         {"d24", 4, 1, ChannelKind::depth},
    {"d24s8", 4, 2, ChannelKind::depth, true}, {"d32f", 4, 1, ChannelKind::depth},
    {"s8", 1, 1, ChannelKind::stencil, true},
}};

constexpr const SurfaceFormatInfo& info_of(SurfaceFormat format) {
    return surface_formats[static_cast<std::size_t>(format)];
}
constexpr std::uint32_t bytes_of(SurfaceFormat format) { return info_of(format).bytes; }
constexpr bool has_depth(SurfaceFormat format) { return info_of(format).kind == ChannelKind::depth; }
constexpr bool has_stencil(SurfaceFormat format) { return info_of(format).stencil; }
constexpr bool is_colour(SurfaceFormat format) { return !has_depth(format) && !has_stencil(format); }

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
