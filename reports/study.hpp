// Studies of geometry feed: a data file asks one question, the model answers with a table and a plot.
//
// A file (reports/studies/NAME.toml) has `title`, `question`, `source`, `gpus`, `x` (title of the axis), `logarithmic`,
// `measure` (what is plotted), `series` (each with a scene, preparations and so on, in which {name} stands for a
// variable of the point) and `points` (each with `x` and the variables).
#pragma once

#include "reports/csv.hpp"
#include "reports/geometry/validation.hpp"
#include "reports/terminal_table.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace reports {

struct StudySeries {
    std::string name;
    std::string scene;
    std::vector<std::string> prepare;
    std::vector<std::string> settings; ///< of the GPU
    std::string submission = "buffers";
    bool reads_all = true;
};

struct Study {
    std::string name, title, question, source;
    std::vector<std::string> gpus;
    std::string x;
    bool logarithmic = false;
    std::string measure = "fps";
    std::vector<StudySeries> series;
    std::vector<std::map<std::string, std::string>> points; ///< "x" and what else the series name
};

struct StudyValue {
    std::string gpu, series, x;
    double fps = 0, milliseconds = 0, vertices_per_second = 0, triangles_per_second = 0;
    double acmr = 0, overfetch = 0, bytes = 0;
    std::uint64_t draws = 0;
    std::string limit;
    double measure = 0; ///< the one that the study plots
};

struct StudyResult {
    Study study;
    std::vector<StudyValue> values; ///< by point, then series, then GPU
    Fidelity fidelity = Fidelity::detailed;
};

/// What a study may measure.
const std::vector<std::string>& study_measures();
double measure_of(const StudyValue& value, const std::string& measure);

/// The studies on hand, sorted.
std::vector<std::string> study_names();

/// By name, or a .toml file. Throws sim::InputError for an unknown name (naming what is near) and for a file that is
/// none.
Study load_study(const std::string& name_or_path);

/// One series at one point on each of the GPUs.
std::vector<StudyValue> run_series(const Study& study, const StudySeries& series,
                                   const std::map<std::string, std::string>& point,
                                   const std::vector<std::string>& gpus, const GeometryRunOptions& options);

/// @param gpus empty: those that the study names
StudyResult run_study(const Study& study, const std::vector<std::string>& gpus, const GeometryRunOptions& options);

std::string studies_text(const std::vector<std::string>& names, TerminalStyle style);
std::string study_text(const StudyResult& result, TerminalStyle style);
nlohmann::ordered_json study_json(const StudyResult& result);
Table study_table(const StudyResult& result);
std::string study_page(const StudyResult& result);

} // namespace reports
