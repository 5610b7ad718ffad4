// Shaders of passes that tests put together: a G-buffer, what lights it, and one that discards.
#pragma once

#include "pipeline/shader.hpp"

#include <atomic>
#include <cstdint>

namespace tests {

/// Output 0: the colour of the material without light; output 1: the normal, each axis from [-1,1] to [0,1].
class GBufferShader final : public pipeline::Shader {
  public:
    pipeline::ShaderShape shape() const override {
        return {.outputs = 2, .registers = 6, .colour = pipeline::FragmentColour::unlit, .normal = true};
    }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput& output) const override {
        surfaces.issue(3, input.pixels);
        output.colours[0] = input.colour;
        for (std::size_t i = 0; i < 4; ++i) output.colours[1][i] = input.normal[i] * 0.5F + glm::vec4(0.5F);
    }
};

/// Reads such a G-buffer, colours as 0 and normals as 1, at its own pixel, and lights it from the eye.
class LightingShader final : public pipeline::Shader {
  public:
    pipeline::ShaderShape shape() const override { return {.reads = 2, .discards = false}; }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput& output) const override {
        const pipeline::QuadPlaces at(input);
        const pipeline::QuadTexels colours = surfaces.fetch(0, at.x, at.y, input.pixels);
        const pipeline::QuadTexels normals = surfaces.fetch(1, at.x, at.y, input.pixels);
        surfaces.issue(5, input.pixels);
        for (std::size_t i = 0; i < 4; ++i)
            output.colours[0][i] = glm::vec4(glm::vec3(colours[i]) * (normals[i].z * 2.0F - 1.0F), 1.0F);
    }
};

/// White, but for the pixels of odd columns, which it discards; counts its calls.
class SieveShader final : public pipeline::Shader {
  public:
    mutable std::atomic<std::uint64_t> calls{0};

    pipeline::ShaderShape shape() const override { return {}; }
    void shade(const pipeline::ShaderInput&, pipeline::SurfaceAccess&, pipeline::ShaderOutput& output) const override {
        ++calls;
        output.alive &= 0b0101U;
        output.colours[0].fill(glm::vec4(1.0F));
    }
};

} // namespace tests
