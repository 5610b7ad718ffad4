// What the fragments of a draw with a vertex program are given: its varyings, interpolated over a primitive.
#pragma once

#include "pipeline/functional/interpolation.hpp"
#include "pipeline/shader.hpp"
#include "pipeline/vertex_program.hpp"

#include <array>
#include <span>
#include <vector>

namespace pipeline {

class VaryingPlanes {
  public:
    /// Takes the varyings of a primitive's vertices, and their w of clip space. `weights`: see PrimitivePart; null when
    /// not clipped.
    void begin(const VertexProgramShape& shape, const std::array<std::span<const glm::vec4>, 3>& vertices,
               const glm::vec3& w_of_vertices, const std::array<ScreenVertex, 3>& corners,
               const std::array<glm::vec3, 3>* weights, std::size_t provoking);

    /// Those of the pixels of a quad, behind what ShaderInput::varyings begins with.
    /// @param point the weights run over the square of a point
    void interpolate(const CornerWeights& weights, bool point, std::span<QuadTexels> varyings) const;

  private:
    VertexProgramShape shape_;
    std::array<float, 3> w_{};
    std::array<std::vector<glm::vec4>, 3> corners_;
};

} // namespace pipeline
