// Runs of the model for the table of predictions; equal ones are made once in a process.
#pragma once

#include "reports/comparison.hpp"
#include "reports/run_values.hpp"
#include "tests/physics/prediction_table.hpp"

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace physics {

/// What can be asked of a run.
struct RunNumbers {
    explicit RunNumbers(const reports::Comparison& comparison);

    /// A value of reports::RunValues, "gpu.PARAMETER" (numbers only), or "pass_cycles.NAME", the cycles of the passes
    /// of that name with _ for spaces: "pass_cycles.geometry_sort". Throws sim::InputError when there is none.
    double at(std::string_view name) const;

    reports::RunValues values;
    std::map<std::string, double> others; ///< gpu.* and pass_cycles.*
    nlohmann::ordered_json json;          ///< the design's part of result.json
};

/// One thread. Throws sim::InputError for whatever the run's words get wrong: an unknown key, design or scene.
std::shared_ptr<const RunNumbers> numbers_of(const PredictionRun& run);

/// A limit that the hardware declares, and what a run made of it.
struct Bound {
    std::string name;
    double used = 0, capacity = 0;
};

/// Every declared limit of a unit that the run has: bytes or items per cycle times the cycles of the run. `used`
/// exceeds no `capacity` in any run, whatever its parameters.
std::vector<Bound> declared_bounds(const RunNumbers& run);

/// The bounds that are exceeded, one a line; empty by law.
std::string exceeded_bounds(const RunNumbers& run);

} // namespace physics
