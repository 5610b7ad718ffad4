// The subcommands. They throw sim::InputError, sim::Interrupted, or what else goes wrong.
#pragma once

#include "cli/options.hpp"

namespace cli {

inline constexpr int status_good = 0, status_bad = 1, status_no = 4; ///< exit statuses

void compare(const CompareCommand& command);
void run(const RunCommand& command);
/// status_no where --check finds the frame in submission order wrong, or nothing to compare.
int truth(const TruthCommand& command);
void accuracy(const AccuracyCommand& command);
void geometry(const GeometryCommand& command);
void validate(const ValidateCommand& command);
void calibrate(const CalibrateCommand& command);
void study(const StudyCommand& command);
void sensitivity(const SensitivityCommand& command);
void stability(const StabilityCommand& command);
void capture(const CaptureCommand& command);
void record(const RecordCommand& command);
void import_frames(const ImportCommand& command);
void replay(const ReplayCommand& command);
/// status_bad where the trace is faulty, or two differ.
int trace(const TraceCommand& command);
void describe(const DescribeCommand& command);

} // namespace cli
