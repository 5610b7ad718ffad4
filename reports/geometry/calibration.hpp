// Fits the numbers of GPU files to published rows, by the plan in reports/published/calibration.toml.
#pragma once

#include "reports/geometry/validation.hpp"

#include <map>
#include <string>
#include <vector>

namespace reports {

struct CalibratedNumber {
    CalibrationStep step;
    double in_file = 0;              ///< what the GPU file has
    double value = 0;                ///< what was found
    double published = 0, model = 0; ///< milliseconds of the row (or rows), with all numbers as found
};

struct ScaledNumber {
    ScaledParameter rule;
    double in_file = 0, value = 0;
};

struct GpuCalibration {
    std::string gpu;
    std::vector<CalibratedNumber> numbers;
    std::vector<ScaledNumber> scaled;
    unsigned rounds = 0;                               ///< of the plan's steps until nothing moved
    std::string command = "ropsim calibrate geometry"; ///< named beside numbers in GPU files

    std::map<std::string, double> values() const; ///< by parameter
};

/// GPUs whose numbers others are scaled from come first. Throws sim::InputError when a row cannot be met between the
/// bounds of its step, naming both.
std::vector<GpuCalibration> calibrate_geometry(const std::vector<std::string>& gpus, const GeometryRunOptions& options);

/// What becomes of the predictions when another row determines a number.
struct LeftOneOut {
    std::string gpu, parameter;
    std::string row, instead_of;
    double value = 0, usual_value = 0;
    ErrorSpread with_row; ///< of the GPU, the replaced row being predicted and this one not
    bool found = true;    ///< the row can be met at all
};
/// With estimates, whatever the options say: every alternative of the plan is a calibration of its own.
std::vector<LeftOneOut> leave_one_out(const std::vector<std::string>& gpus, const GeometryRunOptions& options);

/// Writes found numbers into the files of `directory` (models/gpus), with four digits, keeping everything else; names
/// the files written. Throws sim::InputError when a file cannot be read or written.
std::vector<std::string> write_calibration(const std::vector<GpuCalibration>& calibrations,
                                           const std::string& directory);

} // namespace reports
