// The model of geometry feed beside what was published, row by row.
#pragma once

#include "reports/geometry/laboratory.hpp"

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
    double published = 0, model = 0; ///< frames per second
    RowStatus status = RowStatus::predicted;
    std::string parameter;   ///< that the row calibrates
    std::string limit;       ///< what limits the model
    std::string explanation; ///< of a large miss, by mechanism; "" when there is none
    double acmr = 0;
    double host_seconds = 0;

    double ratio() const { return model / published; }
    double error() const; ///< |ratio - 1|
};

struct ErrorSummary {
    std::string gpu; ///< "all" for all of them
    std::size_t predicted = 0;
    double median = 0, worst = 0; ///< of error(); 0 without predicted rows
    std::string worst_row;
};

struct GeometryValidation {
    std::vector<ValidationRow> rows; ///< in the order of the tables, then of the GPUs
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

/// Median and worst error of the predicted rows, per GPU and of all.
std::vector<ErrorSummary> summarise(const std::vector<ValidationRow>& rows);

} // namespace reports

template <>
struct sim::EnumNames<reports::RowStatus> {
    static constexpr std::array<std::string_view, 4> names{"calibrated", "predicted", "penalty", "not-modelled"};
};
