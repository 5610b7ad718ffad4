// Operations on values that are known before the program runs.
#pragma once

#include "models/programs/language/syntax.hpp"

#include <array>

namespace models::language {

/// The result of an operation on constants, as the interpreter would give it. Operands that it has not are ignored.
float fold(Operation operation, Type type, const std::array<float, 3>& operands);

} // namespace models::language
