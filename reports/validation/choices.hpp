// Constants and stand-ins that were chosen with published rows in view, from reports/published/choices.toml: such a row
// says nothing of how good the model is.
#pragma once

#include "reports/validation/validation_row.hpp"

#include <string>
#include <vector>

namespace reports {

/// What was chosen, and with which rows in view.
struct Choice {
    std::string target; ///< of `ropsim validate`: "geometry", "peeling"
    std::string what;   ///< "geometry.vertex_reuse.entries = 20", "camera of the Powerplant stand-in"
    /// Of a constant: its parameter and the value that was chosen; "" of a stand-in.
    std::string parameter;
    double value = 0;
    std::vector<std::string> gpus, rows;
    bool penalty = false; ///< the size of a driver artefact
    std::string reason;   ///< how the rows were used

    bool concerns(const ValidationRow& row) const;
};

/// Those of a target. Throws sim::InputError naming file and place when the file is not as expected.
std::vector<Choice> load_choices(const std::string& target);

/// Of a predicted row: calibrated, or a penalty, where something was chosen with it in view. Of any row that has none
/// yet, the parameter.
void apply_choices(ValidationRow& row, const std::vector<Choice>& choices);

} // namespace reports
