// Geometry feed on the terminal.
#pragma once

#include "reports/geometry/advice.hpp"
#include "reports/geometry/calibration.hpp"
#include "reports/terminal_table.hpp"

#include <string>

namespace reports {

/// What was published: a number, an interval, or a bound. "4.44", "500 to 1000", "at least 1.00"
std::string published_text(const ValidationRow& row);

std::string advice_text(const GeometryAdvice& advice, TerminalStyle style);
std::string validation_text(const GeometryValidation& validation, TerminalStyle style);
std::string leave_one_out_text(const std::vector<LeftOneOut>& entries, TerminalStyle style);
std::string calibration_text(const std::vector<GpuCalibration>& calibrations, TerminalStyle style);

} // namespace reports
