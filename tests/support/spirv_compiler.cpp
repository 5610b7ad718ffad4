#include "tests/support/spirv_compiler.hpp"

#include "sim/check.hpp"
#include "traces/glsl.hpp"

namespace tests {

CompiledSpirv compile_fragment_shader(const std::string& source) {
    const traces::GlslProgram program{"shader", {}, {source}, {}};
    try {
        return {traces::compile_glsl(program, traces::GlslOptimisation::none).fragment,
                traces::compile_glsl(program).fragment, ""};
    } catch (const sim::InputError& error) {
        return {{}, {}, error.what()};
    }
}

} // namespace tests
