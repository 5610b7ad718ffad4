// Modify programs that users write: text in the k-buffer language (README.md of models/programs), run by an
// interpreter.
#pragma once

#include "models/programs/language/generator.hpp"
#include "models/programs/program_choice.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace models {

/// The program of a text. `name` stands for it in messages.
/// @param k entries; 0: as many as the text says. Throws sim::InputError "name:line:column: expected ..., got ...".
ProgramChoice user_program(std::string name, std::string text, std::uint32_t k,
                           const language::Overrides& overrides = {});

/// Whether a name stands for a user's program in this language: that of a file *.kb, or a line with one and the
/// program's text behind it.
bool is_user_program(std::string_view program);

/// The program in a file, or in the text behind its name, as program_text() finds it.
ProgramChoice load_user_program(std::string_view program, std::uint32_t k, const language::Overrides& overrides = {});

/// Those in the data folder, as load_user_program() finds them: "nearest_k.kb" and so on.
std::vector<std::string> shipped_user_programs();

} // namespace models
