// GLSL to SPIR-V, by the module ropsim_glsl.so, which is loaded when it is needed and works in a child process.
#pragma once

#include "sim/check.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace traces {

/// The shaders of a program; several of a stage are linked to one.
struct GlslProgram {
    std::string name; ///< for messages
    std::vector<std::string> vertex, fragment;
    /// Locations that the application gave outputs of the fragment shader; others are those that the source says.
    std::map<std::string, std::uint32_t> outputs;
};

struct CompiledProgram {
    std::vector<std::uint32_t> vertex, fragment; ///< SPIR-V 1.0; empty where the stage is not there
};

enum class GlslOptimisation : std::uint8_t { none, performance };

/// What is wrong with a source.
struct GlslError : sim::InputError {
    /// @param failure what the module says: "fragment shader, line 12: 'x' : undeclared identifier"
    GlslError(const std::string& program, const std::string& failure);

    std::uint32_t line = 0; ///< of the source; 0: none is known
    std::string problem;    ///< there
};

/// Plain uniforms, old built-in variables and names stay. What the fragment shader takes from the vertex shader has the
/// same location in both. Throws GlslError: the program, the stage, the line and what is wrong there; and
/// sim::InputError that says which Debian packages are missing.
CompiledProgram compile_glsl(const GlslProgram& program, GlslOptimisation optimisation = GlslOptimisation::performance);

/// Whether the module was built.
bool can_compile_glsl();

} // namespace traces
