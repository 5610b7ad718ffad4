// The subcommands. They throw sim::InputError, sim::Interrupted, or what else goes wrong.
#pragma once

#include "cli/options.hpp"

namespace cli {

void compare(const CompareCommand& command);
void run(const RunCommand& command);
void truth(const TruthCommand& command);
void accuracy(const AccuracyCommand& command);
void geometry(const GeometryCommand& command);
void validate(const ValidateCommand& command);
void calibrate(const CalibrateCommand& command);
void study(const StudyCommand& command);
void sensitivity(const SensitivityCommand& command);
void stability(const StabilityCommand& command);
void describe(const DescribeCommand& command);

} // namespace cli
