// The shaders before the kernel.
#include "pipeline/functional/fragment_operations.hpp"
#include "traces/shader_names.hpp"
#include "traces/shadows/shadow_shaders.hpp"
#include "traces/view_rays.hpp"

#include <algorithm>

namespace traces {

namespace {

class ShadowEyeShader final : public pipeline::Shader {
  public:
    explicit ShadowEyeShader(const pipeline::View& eye) : rays_(eye), to_world_(glm::inverse(glm::dmat4(eye.view))) {}

    ShaderShape shape() const override { return {.outputs = 2, .colour = pipeline::FragmentColour::lit}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        // Multiply-add and reciprocal to the distance, multiply-adds along the ray, three dots to the world, alpha.
        surfaces.issue(2 + 2 + 3 + 1, input.pixels);
        for (std::uint32_t i = 0; i < 4; ++i) {
            if ((input.pixels >> i & 1U) == 0) continue;
            const float depth = pipeline::depth_value(pipeline::SurfaceFormat::d32f,
                                                      depth_code(pipeline::SurfaceFormat::d32f, input.depth[i]));
            const glm::dvec3 eye = rays_.place(input.x + i % 2, input.y + i / 2, rays_.distance(depth));
            output.colours[0][i] = glm::vec4(glm::vec3(input.colour[i]), 1.0F);
            output.colours[1][i] = glm::vec4(to_world_ * glm::dvec4(eye, 1.0));
        }
    }

  private:
    ViewRays rays_;
    glm::dmat4 to_world_;
};

/// From depths of the k-buffer, four in a target, to distances in the map's format.
class ShadowPackShader final : public pipeline::Shader {
  public:
    explicit ShadowPackShader(const ShadowSetup& setup) : layers_(setup.light, setup.map) {}

    ShaderShape shape() const override { return {.outputs = packs(), .reads = 1, .discards = false}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const QuadPlaces at(input);
        surfaces.issue(1 + packs() * 3, input.pixels); // address; multiply-add, reciprocal of four, bound
        const auto depths = surfaces.pixels(0, at.x, at.y, input.pixels, 0, packs());
        for (std::size_t i = 0; i < 4; ++i)
            for (std::uint32_t layer = 0; depths[i] != nullptr && layer < layers_.options().captured; ++layer)
                output.colours[layer / 4][i][static_cast<int>(layer % 4)] =
                    layers_.stored(layers_.distance(depths[i][layer]));
    }

  private:
    std::uint32_t packs() const { return packs_of(layers_.options().captured); }

    ShadowLayers layers_;
};

class ShadowSlopeShader final : public pipeline::Shader {
  public:
    explicit ShadowSlopeShader(const ShadowSetup& setup) : layers_(setup.light, setup.map) {}

    ShaderShape shape() const override { return {.outputs = packs(), .reads = 1, .registers = 6, .discards = false}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const QuadPlaces at(input);
        const auto last = static_cast<std::int32_t>(layers_.options().resolution) - 1;
        LaneIndices right{}, below{};
        for (std::size_t i = 0; i < 4; ++i) {
            right[i] = std::min(at.x[i] + 1, last);
            below[i] = std::min(at.y[i] + 1, last);
        }
        // Addresses; three distances of two each, then differences, maxima, scale, bound.
        surfaces.issue(2 + packs() * (3 * 2 + 6), input.pixels);
        const auto here = surfaces.pixels(0, at.x, at.y, input.pixels, 0, packs()),
                   beside = surfaces.pixels(0, right, at.y, input.pixels, 0, packs()),
                   under = surfaces.pixels(0, at.x, below, input.pixels, 0, packs());
        for (std::size_t i = 0; i < 4; ++i)
            for (std::uint32_t layer = 0; here[i] != nullptr && layer < layers_.options().layers; ++layer)
                output.colours[layer / 4][i][static_cast<int>(layer % 4)] =
                    layers_.slope(layers_.distance(here[i][layer]), layers_.distance(beside[i][layer]),
                                  layers_.distance(under[i][layer]));
    }

  private:
    std::uint32_t packs() const { return packs_of(layers_.options().layers); }

    ShadowLayers layers_;
};

class LeastDepthShader final : public pipeline::Shader {
  public:
    ShaderShape shape() const override { return {.reads = 1, .discards = false}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(1 + 3, input.pixels); // address, three minima
        std::array<QuadTexels, 4> finer;
        for (std::int32_t tap = 0; tap < 4; ++tap) {
            QuadPlaces at(input);
            for (std::size_t i = 0; i < 4; ++i) {
                at.x[i] = at.x[i] * 2 + tap % 2;
                at.y[i] = at.y[i] * 2 + tap / 2;
            }
            finer[static_cast<std::size_t>(tap)] = surfaces.fetch(0, at.x, at.y, input.pixels);
        }
        for (std::size_t i = 0; i < 4; ++i)
            output.colours[0][i].r = least_of({finer[0][i].r, finer[1][i].r, finer[2][i].r, finer[3][i].r});
    }
};

} // namespace

std::shared_ptr<const pipeline::Shader> shadow_eye_shader(const pipeline::View& eye) {
    return std::make_shared<const ShadowEyeShader>(eye);
}

std::shared_ptr<const pipeline::Shader> shadow_pack_shader(const ShadowSetup& setup) {
    return std::make_shared<const ShadowPackShader>(setup);
}

std::shared_ptr<const pipeline::Shader> shadow_slope_shader(const ShadowSetup& setup) {
    return std::make_shared<const ShadowSlopeShader>(setup);
}

std::shared_ptr<const pipeline::Shader> least_depth_shader() { return std::make_shared<const LeastDepthShader>(); }

} // namespace traces
