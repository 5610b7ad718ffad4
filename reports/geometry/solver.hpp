// One number of a GPU against one published row.
#pragma once

#include "reports/geometry/validation.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace reports {

/// Values of parameters that differ from the GPU's file.
using Values = std::map<std::string, double>;

/// A parameter of a GPU by its path, as a number.
double value_of(const pipeline::GpuParams& params, const std::string& path);

/// Frames of published rows, each made once.
class RowFrames {
  public:
    RowFrames(const std::vector<PublishedRow>& rows, const pipeline::GpuParams& measure_with)
        : rows_(&rows), measure_with_(measure_with) {}

    const pipeline::Frame& of(const std::string& row);

  private:
    const std::vector<PublishedRow>* rows_;
    pipeline::GpuParams measure_with_;
    std::map<std::string, std::shared_ptr<const pipeline::Frame>> frames_;
    std::mutex mutex_;
};

/// Time is a monotone function of every number that a step may name.
class Solver {
  public:
    Solver(std::string gpu, const std::vector<PublishedRow>& rows, RowFrames& frames, const GeometryRunOptions& options)
        : gpu_(std::move(gpu)), rows_(&rows), frames_(&frames), options_(&options) {}

    /// Of a row, or the difference of two (see CalibrationStep::row).
    double milliseconds(const std::string& rows, const Values& values) const;
    /// What was measured of that.
    double wanted(const std::string& rows) const;

    /// Sets values[step.parameter] so that the step's row takes as long as it should. False when no number between the
    /// step's bounds does; it is then the bound that comes nearer.
    bool solve(const CalibrationStep& step, Values& values) const;

  private:
    double miss(const CalibrationStep& step, double value, Values& values) const;

    std::string gpu_;
    const std::vector<PublishedRow>* rows_;
    RowFrames* frames_;
    const GeometryRunOptions* options_;
};

} // namespace reports
