// Texture sampling: level of detail, wrap modes, nearest and bilinear filters, mip levels, sRGB decoding.
//
// Not modelled: anisotropic filtering, borders, texel offsets, per-pixel level of detail (a quad has one).
// Source: OpenGL 4.5, sections 8.14 and 8.15.
#pragma once

#include "pipeline/draw.hpp"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace pipeline {

class TextureSampler {
  public:
    /// `texture` has at least one level and outlives the sampler.
    explicit TextureSampler(const Texture& texture);

    /// log2 of the longer of the quad's two footprints in texels of level 0; from the coordinates at its four pixels
    /// (finite; pixels that are not covered count). 0 where the texture is magnified, at most the last level.
    float level_of_detail(const std::array<glm::vec2, 4>& coordinates) const;

    /// The filtered colour: linear light, alpha as stored.
    glm::vec4 sample(const glm::vec2& coordinates, float level_of_detail) const;

    /// Number of the 64-byte line (a tile of 4x4 texels) that holds the texel at `coordinates` in the finest level that
    /// sample() reads: its address in GPU memory / 64.
    std::uint32_t line(const glm::vec2& coordinates, float level_of_detail) const;

  private:
    struct Footprint {
        std::size_t level = 0; ///< the finest level read
        float blend = 0;       ///< share of the next level; 0 when only one is read
        bool linear = false;
    };
    Footprint footprint(float level_of_detail) const;
    glm::vec4 texel(const Texture::Level& level, std::int32_t x, std::int32_t y) const;
    glm::vec4 nearest(const Texture::Level& level, const glm::vec2& wrapped) const;
    glm::vec4 bilinear(const Texture::Level& level, const glm::vec2& wrapped) const;
    glm::vec4 filtered(std::size_t level, bool linear, const glm::vec2& wrapped) const;

    const Texture& texture_;
    const std::array<float, 256>& decode_; ///< of colour channels
    const std::array<float, 256>& alpha_;
};

} // namespace pipeline
