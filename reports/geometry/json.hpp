// Geometry feed for programs.
#pragma once

#include "reports/geometry/advice.hpp"
#include "reports/geometry/calibration.hpp"

#include <nlohmann/json_fwd.hpp>

namespace reports {

nlohmann::ordered_json advice_json(const GeometryAdvice& advice);
/// `rows` and `summary`; `leave_one_out` when there are entries.
nlohmann::ordered_json validation_json(const GeometryValidation& validation, const std::vector<LeftOneOut>& entries);
nlohmann::ordered_json calibration_json(const std::vector<GpuCalibration>& calibrations);

} // namespace reports
