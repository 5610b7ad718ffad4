// What depth peeling takes on the model: runs of stand-ins, and the line through them.
#pragma once

#include "reports/peeling/published.hpp"

#include <array>
#include <vector>

namespace reports {

/// One run of each column.
struct StandInRun {
    std::uint64_t triangles = 0;
    std::array<double, peeling_columns> milliseconds{};
    double host_seconds = 0;
};

/// Runs the columns on a stand-in of `triangles` triangles, in full detail. Video memory and the driver's
/// limits of index ranges are as much smaller as the stand-in is than its mesh. `gpu_settings` are "section.key=value".
StandInRun run_stand_in(const PublishedPeeling& published, const PeelingMeasurement& row, std::uint64_t triangles,
                        const std::vector<std::string>& gpu_settings = {}, const std::atomic<bool>* stop = nullptr);

/// A value read off a straight line.
struct LineValue {
    double value = 0;
    double residual = 0; ///< largest distance of a point from the line, over the range of the points; 0: one point
};

/// Least squares through the points; with one point, its value.
LineValue line_value(const std::vector<double>& x, const std::vector<double>& y, double at);

} // namespace reports
