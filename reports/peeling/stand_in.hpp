// What depth peeling takes on the model: runs of stand-ins, and the line through them.
#pragma once

#include "reports/peeling/published.hpp"

#include <array>
#include <atomic>
#include <vector>

namespace reports {

/// One run of each column.
struct StandInRun {
    std::uint64_t triangles = 0;
    std::array<double, peeling_columns> milliseconds{}; ///< 0: not run
    double host_seconds = 0;
};

/// Which columns are run.
using PeelingColumns = std::vector<PeelingColumn>;

/// Runs columns on a stand-in of `triangles` triangles, in full detail. What a mesh is compared with is as much
/// smaller as the stand-in is: video memory, the driver's limits of index ranges, and for surfaces the cache of
/// vertices, whose lines are met again in the next row of the mesh. `gpu_settings` are "section.key=value".
StandInRun run_stand_in(const PublishedPeeling& published, const PeelingMeasurement& row, std::uint64_t triangles,
                        const std::vector<std::string>& gpu_settings = {}, const std::atomic<bool>* stop = nullptr,
                        const PeelingColumns& columns = {PeelingColumn::mp, PeelingColumn::sp, PeelingColumn::spwh});

/// A value read off a straight line behind its last point.
struct LineValue {
    double value = 0;
    double error = 0; ///< share by which it may miss if the slope goes on to change as it did between the points
};

/// Least squares through three points or more, in growing order of x; with one point, its value. The error adds up what
/// the line misses of the last two points' own, what comes of the largest change of the slope per doubling of x, and a
/// thousandth for what the points vary by.
LineValue line_value(const std::vector<double>& x, const std::vector<double>& y, double at);

} // namespace reports
