// Textures of numbers that follow from their place: OpenGL gets the same as the interpreter's shaders.
#pragma once

#include "traces/spirv/textures.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tests {

/// Along each side, of every texture; layers, too.
inline constexpr std::uint32_t oracle_texture_size = 8;

/// A number in [0,1) that follows from a name.
float random_of(const std::string& name, std::uint32_t i);

/// In [0,1).
float oracle_texel(std::uint32_t unit, std::uint32_t x, std::uint32_t y, std::uint32_t layer, std::uint32_t component);

/// Nearest texels of one level; repeated, but of cubes and rectangles.
class OracleTextures : public traces::spirv::ShaderTextures {
  public:
    /// The unit of each texture of a program.
    explicit OracleTextures(std::vector<std::uint32_t> units) : units_(std::move(units)) {}

    traces::spirv::Texels sample(const traces::spirv::TextureSample& call) override;
    traces::spirv::Texels fetch(const traces::spirv::TextureFetch& call) override;
    traces::spirv::TextureSize size(std::uint32_t texture, std::uint32_t element, std::int32_t level) override;
    std::int32_t levels(std::uint32_t, std::uint32_t) override { return 1; }
    std::int32_t samples(std::uint32_t, std::uint32_t) override { return 1; }
    traces::spirv::Texels level(const traces::spirv::TextureSample&) override { return {}; }

  private:
    float texel(std::uint32_t texture, const std::array<std::int32_t, 3>& place, std::uint32_t component) const;

    std::vector<std::uint32_t> units_;
};

} // namespace tests
