// GLSL of any version from 1.10 on to SPIR-V, as desktop OpenGL and without the rules that SPIR-V adds: names, plain
// uniforms, built-in variables of old versions stay what they are.
#include "traces/glsl_module/glsl_module.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <spirv-tools/optimizer.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <list>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int oldest_version = 110;           // of a source that names none
constexpr std::uint32_t spirv_1_0 = 0x10000U; // glslang writes 0 where it was not asked for a version
constexpr std::array<EShLanguage, ROPSIM_GLSL_STAGES> languages{EShLangVertex, EShLangFragment};
constexpr std::array<const char*, ROPSIM_GLSL_STAGES> stage_names{"vertex shader", "fragment shader"};

// glslang 12 crashes on the function.
constexpr const char* preamble = "#define ftransform() (gl_ModelViewProjectionMatrix * gl_Vertex)\n";

/// The first error of a log, "ERROR: 0:12: 'x' : undeclared identifier", as "line 12: 'x' : undeclared identifier".
std::string first_error(const std::string& log) {
    const std::string mark = "ERROR: ";
    const std::size_t begin = log.find(mark);
    if (begin == std::string::npos) return log.substr(0, log.find('\n'));
    std::string line = log.substr(begin + mark.size());
    line = line.substr(0, line.find('\n'));
    const std::size_t number = line.find(':');
    const std::size_t text = number == std::string::npos ? number : line.find(": ", number + 1);
    const auto digits = [&](std::size_t from, std::size_t to) {
        return to > from && std::all_of(line.begin() + static_cast<std::ptrdiff_t>(from),
                                        line.begin() + static_cast<std::ptrdiff_t>(to),
                                        [](char letter) { return letter >= '0' && letter <= '9'; });
    };
    if (text == std::string::npos || !digits(0, number) || !digits(number + 1, text)) return line;
    return "line " + line.substr(number + 1);
}

std::vector<std::uint32_t> optimised(const std::vector<std::uint32_t>& words) {
    std::vector<std::uint32_t> result;
    spvtools::Optimizer optimizer(SPV_ENV_OPENGL_4_5);
    std::string problem;
    optimizer.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* message) {
        if (problem.empty()) problem = message;
    });
    optimizer.RegisterPerformancePasses();
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // which knows no truths as plain uniforms
    if (!optimizer.Run(words.data(), words.size(), &result, options))
        throw std::runtime_error("spirv-opt refuses the module: " + problem);
    return result;
}

std::array<std::vector<std::uint32_t>, ROPSIM_GLSL_STAGES> modules_of(const RopsimGlslShader* shaders,
                                                                      std::size_t count, bool optimise) {
    static const bool started = glslang::InitializeProcess();
    if (!started) throw std::runtime_error("glslang does not start");
    std::list<glslang::TShader> kept; // a program is to be destroyed before its shaders
    glslang::TProgram program;
    std::array<bool, ROPSIM_GLSL_STAGES> there{};
    for (std::size_t i = 0; i < count; ++i) {
        const auto stage = static_cast<std::size_t>(shaders[i].stage);
        glslang::TShader& shader = kept.emplace_back(languages.at(stage));
        shader.setStrings(&shaders[i].source, 1);
        shader.setPreamble(preamble);
        shader.setAutoMapLocations(true);
        shader.setAutoMapBindings(true);
        if (!shader.parse(GetDefaultResources(), oldest_version, false, EShMsgDefault))
            throw std::runtime_error(std::string(stage_names.at(stage)) + ", " + first_error(shader.getInfoLog()));
        program.addShader(&shader);
        there.at(stage) = true;
    }
    if (!program.link(EShMsgDefault) || !program.mapIO())
        throw std::runtime_error("linking, " + first_error(program.getInfoLog()));
    std::array<std::vector<std::uint32_t>, ROPSIM_GLSL_STAGES> result;
    for (std::size_t stage = 0; stage < result.size(); ++stage) {
        if (!there.at(stage)) continue;
        glslang::GlslangToSpv(*program.getIntermediate(languages.at(stage)), result.at(stage));
        result.at(stage).at(1) = spirv_1_0;
        if (optimise) result.at(stage) = optimised(result.at(stage));
    }
    return result;
}

int compile(const RopsimGlslShader* shaders, std::size_t count, int optimise, std::uint32_t* words, std::size_t room,
            std::size_t* sizes, char* error, std::size_t error_size) {
    try {
        const auto modules = modules_of(shaders, count, optimise != 0);
        for (std::size_t stage = 0; stage < modules.size(); ++stage) {
            if (modules.at(stage).size() > room) throw std::runtime_error("a module of more words than expected");
            words = std::copy(modules.at(stage).begin(), modules.at(stage).end(), words);
            room -= modules.at(stage).size();
            sizes[stage] = modules.at(stage).size();
        }
        return 0;
    } catch (const std::exception& problem) {
        std::snprintf(error, error_size, "%s", problem.what());
        return 1;
    }
}

constexpr RopsimGlslModule module{ROPSIM_GLSL_MODULE_VERSION, compile};

} // namespace

extern "C" __attribute__((visibility("default"))) const RopsimGlslModule* ropsim_glsl_module() { return &module; }
