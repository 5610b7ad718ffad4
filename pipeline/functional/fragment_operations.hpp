// The fixed operations of the raster-operation units: stencil and depth test, blending, write masks.
//
// Source: OpenGL 4.5 core, sections 17.3.5 (stencil), 17.3.6 (depth), 17.3.8 (blending) and 17.4.2 (masks).
#pragma once

#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/raster_state.hpp"

#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>

namespace pipeline {

/// Blending in float arithmetic.
glm::vec4 blended(const BlendState& blend, const glm::vec4& source, const glm::vec4& target);

/// Blending of 8-bit codes: each product of two codes is round(a * b / 255) as t = a * b + 128; (t + (t >> 8)) >> 8,
/// and sums and differences saturate.
glm::tvec4<std::uint8_t> blended(const BlendState& blend, const glm::tvec4<std::uint8_t>& source,
                                 const glm::tvec4<std::uint8_t>& target);

/// What a colour surface holds after a fragment of colour `source` came to a pixel that held `stored`, which is a
/// colour read from it. Channels whose bit of `write_mask` is 0 (bit 0 is red) stay.
///
/// r8, rg8 and rgba8 are blended in 8-bit codes: source and constant are converted first, as the fixed-function units
/// do. srgb8a8 is blended in linear light and rgb10a2, whose channels have codes of different widths, in floats, after
/// source and constant were clamped to [0,1]; both are rounded once. So are float formats.
///
/// Adds to `overflowed`, unless null, the written channels of 16-bit floats that IEEE 754 makes infinite.
glm::vec4 write_colour(SurfaceFormat format, const BlendState& blend, std::uint8_t write_mask, const glm::vec4& source,
                       const glm::vec4& stored, Fp16Overflow overflow = Fp16Overflow::saturate,
                       std::uint64_t* overflowed = nullptr);

/// Whether the blended colour depends on the stored one.
bool reads_target(const BlendState& blend);

/// The value that a stencil operation leaves; bits outside the face's write mask stay.
std::uint8_t stencil_after(const StencilFace& face, StencilOperation operation, std::uint8_t stored);

/// What the tests said of a fragment.
struct FragmentTest {
    bool stencil_failed = false, depth_failed = false;
    bool written = false; ///< depth or stencil were stored

    bool passed() const { return !stencil_failed && !depth_failed; }
};

/// Stencil and depth test of a fragment, and what they store. `depth` and `stencil` are what its pixel holds, null
/// where the surface has none: that test then passes.
FragmentTest test_fragment(const RasterState& state, bool front, DepthCode incoming, DepthCode* depth,
                           std::uint8_t* stencil);

/// What the fragments of a draw do to the surfaces behind the shader, for those who move the bytes.
struct SurfaceUse {
    bool depth = false;        ///< the depth surface, with its stencil, is touched
    bool reads_depth = false;  ///< a test reads it
    bool keeps_depth = false;  ///< its old content is needed: for a test, or as only a part of a texel is written
    bool colour = false;       ///< a colour surface is written
    bool keeps_colour = false; ///< its old content is needed: blended with, or some channels are masked
};

/// `targets`: formats of the colour targets that are written, nothing for those that are not.
SurfaceUse use_of(const RasterState& state, SurfaceFormat depth_format,
                  std::span<const std::optional<SurfaceFormat>> targets);

} // namespace pipeline
