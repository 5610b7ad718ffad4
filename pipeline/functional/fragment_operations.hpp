// The fixed operations of the raster-operation units: depth test and blending.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/functional/surface_texel.hpp"

#include <cstdint>
#include <glm/vec4.hpp>

namespace pipeline {

/// The fixed-function depth test. Strict: the first of equal depths stays.
constexpr bool depth_less(DepthCode incoming, DepthCode stored) { return incoming < stored; }

/// Blending in a float format.
glm::vec4 blend(BlendMode mode, const glm::vec4& source, const glm::vec4& target);

/// Blending in RGBA8: each product of two codes is round(a * b / 255) as t = a * b + 128; (t + (t >> 8)) >> 8, and sums
/// saturate. `source` is converted to 8 bits first, as the fixed-function units do.
glm::tvec4<std::uint8_t> blend(BlendMode mode, const glm::tvec4<std::uint8_t>& source,
                               const glm::tvec4<std::uint8_t>& target);

/// What a colour surface holds after a fragment with colour `source` was written over, or blended with, `stored`, which
/// is a colour read from it.
glm::vec4 write_through(SurfaceFormat format, BlendMode mode, const glm::vec4& source, const glm::vec4& stored);

} // namespace pipeline
