// Studies: a data file asks one question, the model answers with a table and plots.
//
// What a file (reports/studies/NAME.toml) can hold is in reports/studies/README.md. A series either feeds geometry or,
// where it names a design, runs k-buffer designs on whole frames; all series of a study do the same.
#pragma once

#include "reports/csv.hpp"
#include "reports/geometry/validation.hpp"
#include "reports/terminal_table.hpp"
#include "traces/workloads.hpp"

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace reports {

/// A point of a study: "x" and the other variables that its series name.
using StudyPoint = std::map<std::string, std::string>;

/// {name} in the texts stands for a variable of the point.
struct StudySeries {
    std::string name;
    std::string scene;
    std::vector<std::string> settings; ///< "section.key=value" of the GPU and of designs, "workload.key=value"

    std::string design; ///< empty: geometry feed

    // Geometry feed only.
    std::vector<std::string> prepare;
    std::string submission = "buffers";
    bool reads_all = true;
};

/// A number that a study reads off its runs, and plots.
struct StudyMeasure {
    std::string value; ///< a measure of study_measures(); of designs: a value as in run_values.hpp, or "VALUE / VALUE"
    std::string title; ///< of the axis
    std::string over;  ///< a series whose number it is divided by; empty: none
    bool optional = false; ///< runs may lack it, as they lack the unit that it counts
};

struct Study {
    std::string name, title, question, answer, source;
    std::vector<std::string> gpus;
    std::string x;
    bool logarithmic = false;
    std::vector<StudyMeasure> measures; ///< at least one
    std::vector<StudySeries> series;
    std::vector<StudyPoint> points;

    // Designs only.
    std::string size = "256x256"; ///< may name variables
    std::string samples = "1";    ///< of a pixel; may name variables
    std::string workload = traces::usual_workload();
    std::uint32_t seeds = 1; ///< runs of each design, with the seeds 1, 2, ...; {seed} names them

    bool of_designs() const { return !series.empty() && !series.front().design.empty(); }
};

/// A number over the seeds.
struct StudyNumber {
    std::string value;                  ///< StudyMeasure::value
    double mean = 0, low = 0, high = 0; ///< NaN where the run lacks it
};

struct StudyValue {
    std::string gpu, series, x;
    std::vector<StudyNumber> numbers; ///< of geometry feed: all of study_measures(); of designs: those of the study
    std::string limit;                ///< what limits geometry feed
    bool drew = true;                 ///< a fragment of some run, where designs ran
    double measure = 0;               ///< the first one that the study plots
};

struct StudyResult {
    Study study;
    std::vector<StudyValue> values; ///< by point, then series, then GPU
    Fidelity fidelity = Fidelity::detailed;
    std::size_t found = 0; ///< series at points that an earlier run, or another process, had finished
};

class StudyPoints;

/// What a study of geometry feed may measure.
const std::vector<std::string>& study_measures();
double measure_of(const StudyValue& value, const std::string& measure);

/// The studies on hand, sorted.
std::vector<std::string> study_names();

/// By name, or a .toml file. Throws sim::InputError for an unknown name (naming what is near) and for a file that is
/// none.
Study load_study(const std::string& name_or_path);

/// One series at one point on each of the GPUs.
std::vector<StudyValue> run_series(const Study& study, const StudySeries& series, const StudyPoint& point,
                                   const std::vector<std::string>& gpus, const GeometryRunOptions& options);

/// Throws sim::InputError for a file that asks for what there is not.
/// @param gpus empty: those that the study names
/// @param points where finished ones are kept and found; null: nowhere
StudyResult run_study(const Study& study, const std::vector<std::string>& gpus, const GeometryRunOptions& options,
                      StudyPoints* points = nullptr);

/// Which points drew nothing; empty where all did.
std::string nothing_drawn(const StudyResult& result);

std::string studies_text(const std::vector<std::string>& names, TerminalStyle style);
std::string study_text(const StudyResult& result, TerminalStyle style);
nlohmann::ordered_json study_json(const StudyResult& result);
Table study_table(const StudyResult& result);
std::string study_page(const StudyResult& result);

} // namespace reports
