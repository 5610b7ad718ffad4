// How a series of a study is run, for each kind of study.
#pragma once

#include "reports/study.hpp"

namespace reports {

/// {name} replaced by the point's variable. Throws sim::InputError for a variable that the point does not have.
std::string filled(const std::string& text, const StudyPoint& point, const Study& study);
std::vector<std::string> filled(const std::vector<std::string>& texts, const StudyPoint& point, const Study& study);

std::vector<StudyValue> run_geometry_series(const Study& study, const StudySeries& series, const StudyPoint& point,
                                            const std::vector<std::string>& gpus, const GeometryRunOptions& options);

/// Runs a design once per seed.
std::vector<StudyValue> run_design_series(const Study& study, const StudySeries& series, const StudyPoint& point,
                                          const std::vector<std::string>& gpus, const GeometryRunOptions& options);

} // namespace reports
