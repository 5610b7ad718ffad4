// The picture of a k-buffer as the shader of a pass over the screen, for programs whose pixels become colours one by
// one.
#pragma once

#include "pipeline/output/kbuffer.hpp"
#include "pipeline/shader.hpp"

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>

namespace models {

/// Of which k-buffer, and over what.
struct PictureSetup {
    std::shared_ptr<const pipeline::ModifyProgram> program;
    pipeline::View view;        ///< of the k-buffer; its samples are the picture's
    glm::vec3 background{1.0F}; ///< behind everything
    bool over_surface = false;  ///< the background is a colour surface, sample by sample, and not `background`
};

/// A sample of a pixel.
struct PicturePlace {
    std::uint32_t x = 0, y = 0, sample = 0;
};

/// What one sample of a pixel shows: of its program's floats, drained, and of what lies behind.
using PixelColour = std::function<glm::vec3(const PicturePlace&, const float* pixel, const glm::vec3& behind)>;

/// The mean of each pixel's samples; alpha is 1. Reads the k-buffer and, over a surface, that. Issues `instructions`
/// for a sample of a quad, and what the drain takes.
std::shared_ptr<const pipeline::Shader> picture_shader(PictureSetup setup, std::uint32_t instructions,
                                                       PixelColour colour);

/// A pixel as the program leaves it after its last fragment; `pixel` itself, or a copy that lasts until this thread
/// asks for the next.
const float* drained(const pipeline::ModifyProgram& program, const float* pixel);
std::uint32_t instructions_to_drain(const pipeline::ModifyProgram& program);

/// How a program's pixels become a picture.
using MakePicture = std::function<std::shared_ptr<const pipeline::Shader>(const PictureSetup&)>;

} // namespace models
