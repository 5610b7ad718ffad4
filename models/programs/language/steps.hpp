// The functions that execute single instructions.
#pragma once

#include "models/programs/language/interpreter.hpp"

namespace models::language {

/// For an instruction of finished code whose operands a to d lie in the pixel, or else among the run's own floats, as
/// bits 0 to 3 of `in_pixel` say.
Step::Function function_of(const Instruction& instruction, std::uint32_t in_pixel);

} // namespace models::language
