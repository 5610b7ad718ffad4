// From the text of a program to its tree. The grammar is in models/programs/README.md.
#pragma once

#include "models/programs/language/syntax.hpp"

namespace models::language {

/// Throws sim::InputError for the first thing that does not fit.
Program parse(Source source);

} // namespace models::language
