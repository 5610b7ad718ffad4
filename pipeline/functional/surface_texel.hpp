// Texels: what each surface format stores of a colour, a depth or a stencil value, bit for bit.
//
// Source: OpenGL 4.5 core, sections 2.3.4 (small floats), 2.3.5 (normalised integers) and 8.23 (sRGB). Float formats
// saturate at their largest finite value and store 0 for NaN, so that nothing infinite is ever read back; but those of
// 16-bit floats become infinite where a GPU is asked to store what IEEE 754 says.
#pragma once

#include "pipeline/surface_format.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>

namespace pipeline {

/// A stored depth. Codes of one format order as their depths do, so a depth test is an integer comparison.
using DepthCode = std::uint32_t;

/// Writes bytes_of(format) bytes. Of linear colour; not for formats of integers and compressed ones.
void pack_colour(SurfaceFormat format, const glm::vec4& colour, std::byte* target,
                 Fp16Overflow overflow = Fp16Overflow::saturate);

/// What a texture read of the texel gives: linear colour, or the depth, or integers as numbers. Missing channels read
/// 0, 0, 0, 1.
glm::vec4 unpack_texel(SurfaceFormat format, const std::byte* source);

/// The same of the texels of a quad; of null: 0 in all channels.
std::array<glm::vec4, 4> unpack_texels(SurfaceFormat format, const std::array<const std::byte*, 4>& sources);

/// The colour that is read back after storing `colour`.
glm::vec4 through_format(SurfaceFormat format, const glm::vec4& colour, Fp16Overflow overflow = Fp16Overflow::saturate);

/// Of formats of integers. Numbers with sign are their 32 bits of two's complement; as many bits as the format has are
/// stored. Missing channels read 0, 0, 0, 1.
void pack_integers(SurfaceFormat format, const glm::uvec4& values, std::byte* target);
glm::uvec4 unpack_integers(SurfaceFormat format, const std::byte* source);

/// What the surface stores for window depth `depth`: round(depth * (2^bits - 1)) to nearest even, or the float's own
/// bits. Depths outside [0,1] are clamped; NaN counts as 0.
DepthCode depth_code(SurfaceFormat format, float depth);

/// The depth that a code stands for, in [0,1].
float depth_value(SurfaceFormat format, DepthCode code);

/// The code of depth 1, to which a depth surface is cleared.
DepthCode farthest_depth(SurfaceFormat format);

struct DepthStencil {
    DepthCode depth = 0; ///< 0 where the format has none
    std::uint8_t stencil = 0;

    bool operator==(const DepthStencil&) const = default;
};

/// Of d24s8 the stencil lies in the upper 8 bits.
void pack_depth_stencil(SurfaceFormat format, const DepthStencil& texel, std::byte* target);
DepthStencil unpack_depth_stencil(SurfaceFormat format, const std::byte* source);

} // namespace pipeline
