// Runs code over the floats of a pixel.
#pragma once

#include "models/programs/language/code.hpp"

namespace models::language {

/// `locals` has code.locals floats, all set. Returns whether a float of the pixel changed at any time.
bool run(const Code& code, float* pixel, float* locals);

} // namespace models::language
