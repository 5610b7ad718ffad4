// Formulas that cancel: how many digits the program's own functions keep, over the whole range of what they are given.
#pragma once

#include "reports/stability/report.hpp"

#include <vector>

namespace reports::stability {

/// One curve per formula, with the printed form of the formula beside it where the program computes another one.
std::vector<Curve> conditioning_curves();

// Where they come from: formulas of distances and pixels, and those of media and shadows.
std::vector<Curve> distance_curves();
std::vector<Curve> medium_curves();

} // namespace reports::stability
