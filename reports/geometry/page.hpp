// The validation of geometry feed as a page.
#pragma once

#include "reports/geometry/calibration.hpp"

#include <string>
#include <vector>

namespace reports {

std::string validation_page(const GeometryValidation& validation, const std::vector<LeftOneOut>& entries);

} // namespace reports
