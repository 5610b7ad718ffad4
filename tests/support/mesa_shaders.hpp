// Fragment shaders run by Mesa's llvmpipe over a picture, with inputs that are linear over it.
#pragma once

#include "traces/recording/recording.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tests {

/// Component i is base + x * right + y * up at (x, y), which run from -1 to 1 over the picture.
struct LinearInput {
    std::string qualifier, declaration; ///< as the vertex shader writes them; none of what another one declares
    std::string type, name;             ///< "vec3", "normals[1]"
    std::uint32_t components = 1;
    std::array<float, 4> base{}, right{}, up{};
};

/// An active uniform as OpenGL reports it. Its values are the driver's to choose.
struct ActiveUniform {
    std::string name; ///< without a final [0]
    std::uint32_t components = 1, columns = 1, elements = 1;
    bool real = true, sampler = false;
};

struct ActiveBlock {
    std::string name;
    std::uint32_t bytes = 0;
};

struct ShaderPicture {
    std::vector<std::array<float, 4>> colour; ///< row 0 is the bottom row
};

/// A texture of a recording, with its sampler.
struct MesaTexture {
    traces::RecordedSurface surface;
    traces::RecordedSampler sampler;
    traces::TextureBinding binding; ///< swizzle and levels
};

class MesaShaders {
  public:
    static constexpr std::uint32_t size = 32;  ///< pixels along each side of the picture
    static constexpr float untouched = -77.0F; ///< where fragments were discarded

    /// Null when there is no such OpenGL here; then `reason` says what is missing.
    static std::unique_ptr<MesaShaders> create(std::string& reason);
    virtual ~MesaShaders() = default;

    /// `value`: of scalar i of a uniform. `block`: of word i of a block. `unit`: the texture unit of a sampler. Throws
    /// std::runtime_error when the shaders do not link.
    virtual ShaderPicture draw(const std::string& fragment_source, const std::string& version,
                               const std::vector<LinearInput>& inputs,
                               const std::function<float(const ActiveUniform&, std::uint32_t)>& value,
                               const std::function<float(const ActiveBlock&, std::uint32_t)>& block,
                               const std::function<std::uint32_t(const ActiveUniform&)>& unit) = 0;

    /// What all samplers read from now on in place of numbers that follow from their place; null: those again.
    virtual void set_texture(const MesaTexture* texture) = 0;
    /// Level 0 of a texture as OpenGL hands it back, four bytes a texel.
    virtual std::vector<std::array<std::uint8_t, 4>> decoded(const MesaTexture& texture) = 0;
};

} // namespace tests
