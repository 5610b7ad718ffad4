// Colour surfaces and the fixed blending operations of the raster-operation units.
#pragma once

#include "pipeline/frame.hpp"

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>

namespace pipeline {

constexpr std::uint32_t colour_bytes(ColourFormat format) {
    return format == ColourFormat::rgba8 ? 4 : format == ColourFormat::rgba16f ? 8 : 16;
}

/// Writes colour_bytes(format) bytes. Float formats saturate at their largest finite value and store 0 for NaN, so that
/// nothing infinite is ever read back.
void pack_colour(ColourFormat format, const glm::vec4& colour, std::byte* target);

/// Reads what pack_colour wrote.
glm::vec4 unpack_colour(ColourFormat format, const std::byte* source);

/// The colour that is read back after storing `colour`.
glm::vec4 through_format(ColourFormat format, const glm::vec4& colour);

/// Blending in a float format.
glm::vec4 blend(BlendMode mode, const glm::vec4& source, const glm::vec4& target);

/// Blending in RGBA8: each product of two codes is round(a * b / 255) as t = a * b + 128; (t + (t >> 8)) >> 8, and sums
/// saturate. `source` is converted to 8 bits first, as the fixed-function units do.
glm::tvec4<std::uint8_t> blend(BlendMode mode, const glm::tvec4<std::uint8_t>& source,
                               const glm::tvec4<std::uint8_t>& target);

/// What a colour surface holds after a fragment with colour `source` was written over, or blended with, `stored`, which
/// is a colour read from it.
glm::vec4 write_through(ColourFormat format, BlendMode mode, const glm::vec4& source, const glm::vec4& stored);

} // namespace pipeline
