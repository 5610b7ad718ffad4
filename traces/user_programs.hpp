// Modify programs by what a parameter says: the name of one of ours, that of a user's file (*.kb in the k-buffer
// language,
// *.glsl in GLSL), or a line with the latter and the program itself behind it, which is how draw traces have it.
//
// A trace keeps GLSL as text, which says what an entry is, and as SPIR-V, which is run: replaying it takes no glslang,
// which crashes on some texts, and costs the same whatever glslang made of it.
#pragma once

#include "models/programs/library.hpp"
#include "traces/shader_programs/declaration.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

/// Whether it stands for a user's program.
bool is_user_program(std::string_view program);
/// Whether it is the name of a file.
bool is_program_file(std::string_view program);

/// The program, with options as models::choose_program() takes them; k = 0: as many entries as a user's program says.
/// Throws sim::InputError: "mine.glsl:12: ..." for what a line of a text says, and which Debian packages GLSL needs.
models::ProgramChoice chosen_program(std::string_view program, const models::ProgramOptions& options);

/// Entries that a user's program has where nobody says how many. Compiles no GLSL.
std::uint32_t usual_entries(std::string_view program);

/// A program that needs its file no more; of GLSL for so many entries and this opacity only. Others stay as they are.
std::string self_contained(const std::string& program, std::uint32_t k, float opacity);

/// What a program in GLSL says about itself.
shader_programs::Declaration glsl_declaration(std::string_view program);

/// Those in GLSL in the data folder models/programs: "nearest_k.glsl" and so on.
std::vector<std::string> shipped_glsl_programs();

} // namespace traces
