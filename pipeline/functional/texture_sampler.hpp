// Texture sampling: level of detail, wrap modes and borders, nearest and bilinear filters, mip levels, sRGB decoding.
//
// Not modelled: anisotropic filtering, texel offsets, per-pixel level of detail (a quad has one).
// Source: OpenGL 4.5, sections 8.14 and 8.15.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/functional/lanes.hpp"

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>

namespace pipeline {

/// Texture coordinates at the four pixels of a quad, also those that are not covered. Finite.
struct QuadTexcoords {
    Lanes u{}, v{};
};

/// Which levels of a texture a quad reads, and how.
struct TextureFootprint {
    std::uint32_t level = 0; ///< the finest one
    float blend = 0;         ///< share of the next level; 0 when only one is read
    bool linear = false;
};

class TextureSampler {
  public:
    /// `texture` has at least one level and outlives the sampler.
    explicit TextureSampler(const Texture& texture);

    /// log2 of the longer of the quad's two footprints in texels of level 0; 0 where the texture is magnified, at most
    /// the last level.
    float level_of_detail(const QuadTexcoords& coordinates) const;

    /// Magnification filter at level of detail 0, minification filter above.
    TextureFootprint footprint(float level_of_detail) const;

    /// The filtered colours, in linear light and alpha as stored, of the pixels in the mask (not 0); others are not
    /// touched.
    ///
    /// Returns the number of the 64-byte line (a tile of 4x4 texels) that holds the texel at the first pixel's
    /// coordinates in the finest level read: its address in GPU memory / 64.
    std::uint32_t sample(const QuadTexcoords& coordinates, const TextureFootprint& footprint, unsigned pixels,
                         std::array<glm::vec4, 4>& colours) const;

  private:
    std::uint32_t filter(std::uint32_t level, bool linear, const QuadTexcoords& wrapped, unsigned pixels,
                         std::array<Lanes, 4>& colours) const;
    Lanes texel(const std::uint8_t* codes) const {
        return {colour_[codes[0]], colour_[codes[1]], colour_[codes[2]], alpha_[codes[3]]};
    }

    const Texture& texture_;
    const float* colour_; ///< 256 decoded values of a colour channel
    const float* alpha_;  ///< and of alpha
    bool bordered_;
};

} // namespace pipeline
