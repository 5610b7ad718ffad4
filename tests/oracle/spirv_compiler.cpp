#include "tests/support/spirv_compiler.hpp"

#if ROPSIM_HAVE_GLSLANG

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <spirv-tools/optimizer.hpp>

namespace tests {

bool have_spirv_compiler() { return true; }

CompiledSpirv compile_fragment_shader(const std::string& source) {
    static const bool started = glslang::InitializeProcess();
    CompiledSpirv result;
    if (!started) {
        result.problem = "glslang does not start";
        return result;
    }
    constexpr int oldest = 110;
    glslang::TShader shader(EShLangFragment);
    const char* text = source.c_str();
    shader.setStrings(&text, 1);
    shader.setAutoMapLocations(true);
    shader.setAutoMapBindings(true);
    if (!shader.parse(GetDefaultResources(), oldest, false, EShMsgDefault)) {
        result.problem = shader.getInfoLog();
        return result;
    }
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(EShMsgDefault) || !program.mapIO()) {
        result.problem = program.getInfoLog();
        return result;
    }
    glslang::GlslangToSpv(*program.getIntermediate(EShLangFragment), result.plain);
    std::vector<std::uint32_t> versioned = result.plain;
    versioned.at(1) = 0x10000; // glslang writes 0, which the optimizer refuses
    spvtools::Optimizer optimizer(SPV_ENV_OPENGL_4_5);
    optimizer.RegisterPerformancePasses();
    if (!optimizer.Run(versioned.data(), versioned.size(), &result.optimised))
        result.problem = "spirv-opt refuses the module";
    return result;
}

} // namespace tests

#else

namespace tests {

bool have_spirv_compiler() { return false; }

CompiledSpirv compile_fragment_shader(const std::string& /*source*/) {
    return {{}, {}, "built without glslang (packages glslang-dev and spirv-tools)"};
}

} // namespace tests

#endif
