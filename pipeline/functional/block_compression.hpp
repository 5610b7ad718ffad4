// Block-compressed textures: 4x4 texels out of 8 or 16 bytes.
//
// Modelled: S3TC, known as DXT1, DXT3, DXT5 and BC1, BC2, BC3. Of DXT1 the kind with one bit of alpha; whoever wants it
// opaque swizzles alpha to 1. Source: EXT_texture_compression_s3tc. It computes in real numbers: what lies between two
// colours or alphas is the nearest code here, where decoders in hardware and software approximate it.
#pragma once

#include "pipeline/surface_format.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace pipeline {

/// By row, then by column; red, green, blue, alpha. The sRGB formats' are still encoded.
using DecodedBlock = std::array<std::array<std::array<std::uint8_t, 4>, 4>, 4>;

/// `block`: the 8 or 16 bytes of a compressed format.
DecodedBlock decode_block(SurfaceFormat format, const std::byte* block);

} // namespace pipeline
