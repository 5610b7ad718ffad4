// Modify programs that users write in GLSL: compiled to SPIR-V, run by its interpreter, priced by its instructions.
//
// The price is the largest number of instructions that a fragment of some streams (fixed, random) needed, without those
// that read and write the pixel, which designs price as memory traffic. A vector instruction counts as one.
// Not modelled: textures, discard; draws do not choose among several programs.
#pragma once

#include "models/programs/program_choice.hpp"
#include "traces/shader_programs/task_text.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace traces {

/// A fragment shader to SPIR-V. Throws sim::InputError that begins with `name`.
using CompileShader = std::function<std::vector<std::uint32_t>(const std::string& source, const std::string& name)>;

/// SPIR-V instructions that one fragment may take.
inline constexpr std::uint64_t modify_budget = 1ULL << 16;

namespace shader_programs {

/// The shaders of a program in SPIR-V, by Task; none of `drain` where it does not.
using TaskModules = std::array<std::vector<std::uint32_t>, 5>;

/// For k entries and one opacity. @param k entries; 0: as many as the text says. Throws sim::InputError, one line.
TaskModules compile_tasks(const Declaration& declaration, std::uint32_t k, float opacity, const CompileShader& compile);

/// The program of such modules, which may be anything: what does not fit the declaration is refused.
/// @param k as for compile_tasks(). Throws sim::InputError, one line.
models::ProgramChoice program_of(const Declaration& declaration, std::uint32_t k, const TaskModules& modules);

} // namespace shader_programs

/// The program of a text. `name` stands for it in messages.
/// @param k entries; 0: as many as the text says. Throws sim::InputError, one line.
models::ProgramChoice shader_program(std::string name, std::string text, std::uint32_t k, float opacity,
                                     const CompileShader& compile);

} // namespace traces
