// GLSL to SPIR-V by glslang, as desktop OpenGL and without the rules that SPIR-V adds: names, plain uniforms and old
// versions stay what they are. For oracles only; where glslang was not found, compile() says so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tests {

struct CompiledSpirv {
    std::vector<std::uint32_t> plain, optimised; ///< the latter by spirv-opt -O
    std::string problem;                         ///< of the compiler; "" when there is none
};

/// False where this was built without glslang.
bool have_spirv_compiler();

CompiledSpirv compile_fragment_shader(const std::string& source);

} // namespace tests
