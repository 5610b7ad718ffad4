// The published measurements of geometry feed and the plan of what they calibrate, as read from reports/published.
#pragma once

#include "pipeline/frame.hpp"
#include "reports/validation/choices.hpp"
#include "reports/validation/printed_number.hpp"

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace reports {

/// What is drawn: a scene as traces::load_scene() takes it, preparations in order, and how its vertices are submitted.
struct GeometryExperiment {
    std::string scene;
    std::vector<std::string> prepare;
    pipeline::Submission submission = pipeline::Submission::buffers;
    bool reads_all = true; ///< the vertex shader reads every attribute, or positions only

    friend bool operator==(const GeometryExperiment&, const GeometryExperiment&) = default;
};

/// One row of a published table.
struct PublishedRow {
    std::string table, row; ///< "T3.4", "3f normal"
    GeometryExperiment experiment;
    std::map<std::string, PrintedNumber> fps;        ///< by GPU
    std::map<std::string, std::string> explanations; ///< of a large miss, by GPU: by what mechanism

    std::string key() const { return table + " " + row; }
};

/// What a number of a GPU file stands for.
enum class CalibrationKind : std::uint8_t { calibrated, penalty };

struct CalibrationStep {
    std::string gpu, parameter;
    std::string row; ///< PublishedRow::key(), or "KEY minus KEY"
    CalibrationKind kind = CalibrationKind::calibrated;
    double low = 0, high = 0; ///< between which the number is looked for
    std::string reason;
    std::vector<std::string> alternatives; ///< rows that could determine it instead
};

/// A row, of a table or a figure, that a number decides which was found from another row.
struct SharedNumber {
    std::string gpu, row, parameter;
    CalibrationKind kind = CalibrationKind::calibrated;
    std::string reason;
};

/// How a number follows from that of a related GPU.
enum class Scaling : std::uint8_t { vertex_units, memory };

struct ScaledParameter {
    std::string gpu, from, parameter;
    Scaling by = Scaling::memory;
};

struct CalibrationPlan {
    std::vector<CalibrationStep> steps;
    std::vector<SharedNumber> shared;
    std::vector<ScaledParameter> scaled;
    std::vector<Choice> choices; ///< of no command

    /// The number that the row decided, or that decides it, for the GPU; "" when the row is predicted.
    std::string parameter_of(const std::string& gpu, const std::string& row, CalibrationKind& kind) const;
};

/// Throw sim::InputError naming file and place when a file is missing or not as expected.
std::vector<PublishedRow> load_published_geometry();
CalibrationPlan load_calibration_plan();

/// GPUs that any row was measured on, sorted.
std::vector<std::string> measured_gpus(const std::vector<PublishedRow>& rows);
/// The one row of "KEY", the two of "KEY minus KEY".
std::vector<std::string> rows_in(const std::string& expression);
const PublishedRow& find_row(const std::vector<PublishedRow>& rows, const std::string& key);

} // namespace reports
