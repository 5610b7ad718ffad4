// The parts of report.html.
#pragma once

#include "reports/comparison_result.hpp"
#include "reports/picture_files.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace reports {

std::string summary_section(const Comparison& comparison);
/// Classes by kinds of each design; they add up to its hazards.
std::string hazards_section(const Comparison& comparison);
/// On-chip bytes of each design.
std::string area_section(const Comparison& comparison);
std::string pictures_section(const Comparison& comparison, const std::vector<PictureFile>& pictures);
std::string passes_section(const Comparison& comparison);
/// What passes wrote to, and the memory of it.
std::string surfaces_section(const Comparison& comparison);
std::string needs_section(const Comparison& comparison);
std::string counters_section(const Comparison& comparison);
std::string parameters_section(const Comparison& comparison);

/// What page.js draws: see there.
nlohmann::ordered_json chart_data(const Comparison& comparison);

} // namespace reports
