// Fits numbers of the GPU of depth peeling to the published numbers that reports/published/peeling.toml names.
#pragma once

#include "reports/geometry/calibration.hpp"
#include "reports/peeling/validation.hpp"

#include <functional>
#include <map>
#include <string>

namespace reports {

/// Solves each number from its row, in turn, until all of them hold: a row is run on the stand-ins of its mesh, one
/// design only. Throws sim::InputError when a row cannot be met between the bounds of its number, naming both.
GpuCalibration calibrate_peeling(const PublishedPeeling& published, const PeelingOptions& options);

/// Milliseconds of a number of the table with values of parameters that differ from the GPU's file: read off the line
/// through its stand-ins, or of the smallest of them alone.
double peeling_milliseconds(const PublishedPeeling& published, const PeelingStep& step,
                            const std::map<std::string, double>& values, const PeelingOptions& options,
                            bool smallest = false);

/// Time as a function of one number, monotone and close to a power of it.
using TimeOfNumber = std::function<double(double number)>;

struct SolvedNumber {
    double value = 0;
    double time = 0; ///< that it takes
    bool met = false;
};

/// The number between two bounds above 0 at which the time is `wanted`, to within half a thousandth; secants of
/// logarithms, from `start`. Not met: what came nearest.
SolvedNumber solve_power(const TimeOfNumber& time, double wanted, double start, double low, double high);

} // namespace reports
