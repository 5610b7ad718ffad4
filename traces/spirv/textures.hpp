// What a shader asks of textures. The interpreter knows neither texels nor filters: whoever draws implements this.
#pragma once

#include "pipeline/texture_lookup.hpp"
#include "traces/spirv/types.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace traces::spirv {

using LaneWords = std::array<std::uint32_t, 4>;

/// Red, green, blue, alpha of four lanes. Textures of whole numbers give their bits (std::bit_cast).
using Texels = std::array<pipeline::Lanes, 4>;

/// A texture, sampler or both, as the module declares it.
struct TextureVariable {
    std::string name;
    Decorations decorations; ///< set and binding
    Kind kind{};             ///< image, sampler, sampled_image
    ImageType image;
    std::uint32_t elements = 1; ///< of an array
};

using pipeline::LevelOfDetail;

/// Places and references are divided already where the call is projective.
struct TextureSample : pipeline::TextureLookup {
    std::uint32_t texture = 0, element = 0;         ///< index into Program::textures, and into its array
    std::uint32_t sampler = 0, sampler_element = 0; ///< the same pair for combined ones
    const ImageType* image = nullptr;
};

struct TextureFetch : pipeline::TexelLookup {
    std::uint32_t texture = 0, element = 0;
    const ImageType* image = nullptr;
};

/// Width, height, depth and layers, as far as the texture has them, in this order without gaps.
using TextureSize = std::array<std::int32_t, 4>;

class ShaderTextures {
  public:
    virtual ~ShaderTextures() = default;
    virtual Texels sample(const TextureSample& call) = 0;
    virtual Texels fetch(const TextureFetch& call) = 0;
    virtual TextureSize size(std::uint32_t texture, std::uint32_t element, std::int32_t level) = 0;
    virtual std::int32_t levels(std::uint32_t texture, std::uint32_t element) = 0;
    virtual std::int32_t samples(std::uint32_t texture, std::uint32_t element) = 0;
    /// Level that sample() would read, and the one before it is clamped: red and green.
    virtual Texels level(const TextureSample& call) = 0;
};

} // namespace traces::spirv
