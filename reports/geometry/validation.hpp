// The model of geometry feed beside what was published, row by row.
#pragma once

#include "reports/geometry/laboratory.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace reports {

enum class RowStatus : std::uint8_t {
    calibrated, ///< a number of the GPU was fitted to this row
    predicted,  ///< nothing was
    penalty,    ///< a driver artefact whose size this row states
    not_modelled
};

struct ValidationRow {
    std::string table, row, gpu;
    std::string unit = "frames/s";
    double low = 0, high = 0; ///< between which the published number lies; equal where it is one number
    double model = 0;
    RowStatus status = RowStatus::predicted;
    PublishedOrigin origin = PublishedOrigin::measured;
    std::string source;      ///< of a number that was not measured
    std::string parameter;   ///< that the row decides, or that decides it
    std::string limit;       ///< what limits the model
    std::string explanation; ///< of a large miss, by mechanism; "" when there is none
    double acmr = 0;
    double host_seconds = 0;

    std::string key() const { return table + " " + row; }
    /// What is nearest to the model of that which was published.
    double published() const { return std::clamp(model, low, high); }
    double ratio() const { return model / published(); }
    double error() const; ///< |ratio - 1|
};

/// Errors of some rows; 0 without rows.
struct ErrorSpread {
    std::size_t rows = 0;
    double median = 0, worst = 0; ///< of ValidationRow::error()
    std::string worst_row;
};

struct ErrorSummary {
    std::string gpu;       ///< "all" for all of them
    ErrorSpread predicted; ///< all predicted rows
    ErrorSpread measured;  ///< of these, the ones whose number was measured: neither stated in words nor derived
};

struct GeometryValidation {
    std::vector<ValidationRow> rows; ///< in the order of the tables and figures, then of the GPUs
    std::vector<ErrorSummary> summary;
    Fidelity fidelity = Fidelity::detailed;
};

struct GeometryRunOptions {
    Fidelity fidelity = Fidelity::detailed;
    unsigned threads = 1;
    const std::atomic<bool>* stop = nullptr;
    std::function<void(double)> progress; ///< share done, 0 to 1; never called by two threads at once
};

/// A miss above this asks for an explanation.
constexpr double large_miss = 0.25;

/// @param gpus empty: all that were measured
/// Throws sim::InputError for a GPU without measurements.
GeometryValidation validate_geometry(const std::vector<std::string>& gpus, const GeometryRunOptions& options);

/// Sets parameter and status.
void apply_plan(ValidationRow& row, const CalibrationPlan& plan);

/// Median and worst error of the predicted rows, per GPU and of all.
std::vector<ErrorSummary> summarise(const std::vector<ValidationRow>& rows);

} // namespace reports

template <>
struct sim::EnumNames<reports::RowStatus> {
    static constexpr std::array<std::string_view, 4> names{"calibrated", "predicted", "penalty", "not-modelled"};
};
