// Draws without shaders by Mesa's llvmpipe, and the same draws with shaders that are said to do the same.
#pragma once

#include "tests/support/fixed_function_scene.hpp"

#include <glm/gtc/type_precision.hpp>
#include <memory>
#include <string>
#include <vector>

namespace tests {

class MesaFixedFunction {
  public:
    static constexpr std::uint32_t size = 96; ///< pixels along each side of the picture

    /// Null when there is no such OpenGL here; then `reason` says what is missing.
    static std::unique_ptr<MesaFixedFunction> create(std::string& reason);
    virtual ~MesaFixedFunction() = default;

    /// Textures are random texels, the same for both, with linear filters. Row 0 is the bottom row.
    virtual std::vector<glm::u8vec4> draw(const traces::FixedFunctionState& state, const FixedFunctionMesh& mesh) = 0;
    /// Throws std::runtime_error when the program does not link or lacks the value of a uniform.
    virtual std::vector<glm::u8vec4> draw(const traces::FixedFunctionState& state,
                                          const traces::FixedFunctionProgram& program,
                                          const FixedFunctionMesh& mesh) = 0;
};

} // namespace tests
