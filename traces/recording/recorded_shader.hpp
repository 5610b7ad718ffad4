// The shader of a pass of a recording: for each draw its fragment shader, or what a clear or a copy stores.
//
// Modelled: built-in inputs of pixels and points, discard, depth, the alpha test behind it; texels of copies and blits.
// Not modelled: early tests that a shader asks for, values at single samples.
#pragma once

#include "pipeline/functional/number_formats.hpp"
#include "pipeline/shader.hpp"
#include "traces/recording/kbuffer_choice.hpp"
#include "traces/recording/linked_program.hpp"
#include "traces/recording/textures.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace traces {

/// Texels of a rectangle of another surface for the pixels of one, each side at most limits::largest_blit. What lies
/// beyond the surface gives no fragment.
struct CopiedTexels {
    std::uint32_t slot = 0, level = 0, plane = 0;
    pipeline::PixelRectangle source, destination;
    bool mirrored_x = false, mirrored_y = false; ///< columns, or rows, run backwards
    bool linear = false;                         ///< filtered; else the nearest texel
    bool depths = false;
};

/// Interpreters of one draw that no thread is using.
class QuadPool {
  public:
    std::unique_ptr<spirv::Quad> take(const spirv::Program& program, const std::vector<std::uint32_t>& uniforms);
    void give_back(std::unique_ptr<spirv::Quad> quad);

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<spirv::Quad>> idle_;
};

/// What an alpha test compares: the nearest of the target's steps between 0 and 1, as its number; of 0 steps the alpha
/// itself.
inline float in_alpha_steps(float alpha, std::uint32_t steps) {
    if (steps == 0) return alpha;
    const float clamped = alpha > 0.0F ? std::min(alpha, 1.0F) : 0.0F;
    return static_cast<float>(pipeline::round_even(static_cast<double>(clamped) * steps));
}

/// What the fragments of a draw run.
struct FragmentUse {
    std::shared_ptr<const LinkedProgram> program; ///< null, or without a fragment shader: the colour, or the texels
    std::shared_ptr<const std::vector<std::uint32_t>> uniforms;
    std::shared_ptr<const TextureTable> textures;
    pipeline::Compare alpha_test = pipeline::Compare::always;
    std::uint32_t alpha_steps = 0; ///< of the target; 0: floats are compared
    float alpha_reference = 0.0F;  ///< as in_alpha_steps() has it
    std::uint32_t height = 0;      ///< of the targets
    bool top_row_first = true;
    bool front_is_clockwise = false; ///< as in the draw's state
    glm::vec4 colour{0.0F};
    std::optional<CopiedTexels> copied;
    std::optional<NodeBlend> node; ///< it goes into a k-buffer as a node
    std::shared_ptr<QuadPool> pool = std::make_shared<QuadPool>();
};

class RecordedShader final : public pipeline::Shader {
  public:
    /// @param uses of draws `first_draw` and those behind it
    RecordedShader(std::uint32_t outputs, std::uint32_t reads, std::uint32_t first_draw, std::vector<FragmentUse> uses);

    pipeline::ShaderShape shape() const override { return shape_; }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput& output) const override;

  private:
    void run(const FragmentUse& use, const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
             pipeline::ShaderOutput& output) const;

    pipeline::ShaderShape shape_;
    std::uint32_t first_draw_;
    std::vector<FragmentUse> uses_;
};

} // namespace traces
