// Geometry feed as comma-separated tables.
#pragma once

#include "reports/csv.hpp"
#include "reports/geometry/advice.hpp"
#include "reports/geometry/calibration.hpp"

#include <vector>

namespace reports {

/// cases.csv: one row per case; demand.csv: one per case and part of the vertex path; draws.csv: one per case and draw.
std::vector<Table> advice_tables(const GeometryAdvice& advice);
/// validation.csv: one row per published row, of a table or a figure, and GPU; summary.csv; leave_one_out.csv when
/// there are entries.
std::vector<Table> validation_tables(const GeometryValidation& validation, const std::vector<LeftOneOut>& entries);

/// numbers.csv: one row per number that was fitted or scaled.
Table calibration_table(const std::vector<GpuCalibration>& calibrations);

} // namespace reports
