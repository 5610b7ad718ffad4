#include "reports/peeling/stand_in.hpp"

#include "reports/comparison.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace reports {

namespace {

constexpr std::uint32_t picture_size = 512; // specification 004, section 4.8
// Larger meshes were drawn in calls of so many triangles, below the limit of the driver (specification 004,
// section 4.5).
constexpr double triangles_per_call = 1e6;

// The size of buffers and index ranges counts by what it is compared with, so that shrinks as the mesh does.
std::vector<std::string> shrunk_limits(const PublishedPeeling& published, double triangles, double of_triangles) {
    const pipeline::HostParams host = configured_gpu(published.gpu, {}).host;
    const double of_mesh = triangles / of_triangles;
    const double of_call = triangles / std::min(of_triangles, triangles_per_call);
    return {fmt::format("host.vram_mb={:.9g}", host.vram_mb * of_mesh),
            fmt::format("host.span_saturation={}", std::lround(std::ceil(host.span_saturation * of_call))),
            fmt::format("host.range_limit_vertices={}", std::lround(std::ceil(host.range_limit_vertices * of_call)))};
}

ComparisonRequest request_of(const PublishedPeeling& published, const PeelingMeasurement& row, std::uint64_t triangles,
                             const std::vector<std::string>& gpu_settings) {
    const PeelingDataset& dataset = published.dataset(row.dataset);
    ComparisonRequest request;
    request.scene = dataset.scene_of(triangles);
    request.camera = dataset.camera_of(triangles);
    request.width = request.height = picture_size;
    request.workload_settings = {fmt::format("k={}", row.k), "entry=" + row.entry};
    request.gpu = published.gpu;
    request.gpu_settings =
        shrunk_limits(published, static_cast<double>(triangles), static_cast<double>(dataset.triangles));
    request.gpu_settings.insert(request.gpu_settings.end(), gpu_settings.begin(), gpu_settings.end());
    for (std::size_t i = 0; i < peeling_columns; ++i)
        request.designs.push_back(design_of(static_cast<PeelingColumn>(i)));
    request.threads = 1;
    return request;
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

StandInRun run_stand_in(const PublishedPeeling& published, const PeelingMeasurement& row, std::uint64_t triangles,
                        const std::vector<std::string>& gpu_settings, const std::atomic<bool>* stop) {
    const Supervision supervision{stop, nullptr, nullptr};
    const Comparison comparison =
        compare(prepare(request_of(published, row, triangles, gpu_settings), supervision), supervision);
    StandInRun result;
    result.triangles = comparison.scene.triangles_drawn;
    for (std::size_t i = 0; i < peeling_columns; ++i) {
        const pipeline::RunResult& run = comparison.runs[i];
        result.milliseconds[i] = static_cast<double>(run.cycles) / (run.core_mhz * 1e3) + run.sort_milliseconds;
    }
    result.host_seconds = comparison.host.seconds;
    return result;
}

LineValue line_value(const std::vector<double>& x, const std::vector<double>& y, double at) {
    CHECK(!x.empty() && x.size() == y.size());
    if (x.size() == 1) return {y.front(), 0};
    const double mean_x = mean(x), mean_y = mean(y);
    double products = 0, squares = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        products += (x[i] - mean_x) * (y[i] - mean_y);
        squares += (x[i] - mean_x) * (x[i] - mean_x);
    }
    CHECK(squares > 0);
    const double slope = products / squares;
    LineValue result{mean_y + slope * (at - mean_x), 0};
    for (std::size_t i = 0; i < x.size(); ++i)
        result.residual = std::max(result.residual, std::abs(y[i] - mean_y - slope * (x[i] - mean_x)));
    const auto [least, most] = std::minmax_element(y.begin(), y.end());
    result.residual /= *most > *least ? *most - *least : 1;
    return result;
}

} // namespace reports
