// What the names of a program mean, and whether its types fit.
#pragma once

#include "models/programs/language/syntax.hpp"

namespace models::language {

/// Fills in what the tree leaves to the checker. Throws sim::InputError for the first thing that does not fit.
void check(Program& program);

} // namespace models::language
