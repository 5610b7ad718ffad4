// The model of geometry feed beside what was published, row by row.
#pragma once

#include "reports/geometry/laboratory.hpp"
#include "reports/validation/validation_row.hpp"

#include <functional>
#include <string>
#include <vector>

namespace reports {

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

/// @param gpus empty: all that were measured
/// Throws sim::InputError for a GPU without measurements.
GeometryValidation validate_geometry(const std::vector<std::string>& gpus, const GeometryRunOptions& options);

/// Throws sim::InputError for a GPU of --gpus that is not among those that were measured.
void check_measured(const std::vector<std::string>& gpus, const std::vector<std::string>& measured);

/// A row of a table as it was published on one of its GPUs, without the model.
ValidationRow published_row(const PublishedRow& published, const std::string& gpu);

/// Sets parameter and status.
void apply_plan(ValidationRow& row, const CalibrationPlan& plan);

} // namespace reports
