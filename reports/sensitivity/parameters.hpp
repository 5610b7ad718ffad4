// Which parameters a sensitivity analysis varies, and to which values.
#pragma once

#include "reports/sensitivity/sensitivity.hpp"
#include "sim/described.hpp"

namespace reports {

/// Values to try in place of `value`: a number over and times `factor`, a truth value's and a choice's others, for a
/// zero what zero_step() says; within the field's range, without `value` itself.
std::vector<SensitivityStep> steps_of(const sim::FieldInfo& field, const std::string& value, double factor);

/// A zero mostly says that something is off or free. It becomes a first noticeable amount of its unit: 1 cycle,
/// nanosecond or vertex, 10 microseconds, 64 bytes per cycle, 1 of anything else.
double zero_step(const std::string& unit);

struct ParameterChoice {
    std::vector<SensitivityParameter> chosen;
    std::vector<std::pair<std::string, std::string>> skipped;
};

/// The parameters of a request with their steps, in the order in which the units are described. `built` names the units
/// that any of the base runs had.
ParameterChoice choose_parameters(const SensitivityRequest& request, const ComparisonInput& input,
                                  const std::vector<std::string>& built);

} // namespace reports
