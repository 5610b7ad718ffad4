#include "reports/peeling/stand_in.hpp"

#include "reports/comparison.hpp"
#include "reports/geometry/laboratory.hpp"
#include "sim/check.hpp"
#include "traces/loads.hpp"

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
constexpr double seed_share = 1e-3; // runs of one stand-in differ by so much from seed to seed

// The size of buffers and index ranges counts by what it is compared with, so that shrinks as the mesh does. Between
// two uses of a vertex lies a row of a surface's triangles, which grows with the root of their number, so the cache
// that the row has to fit into shrinks with that.
std::vector<std::string> shrunk_limits(const PublishedPeeling& published, const PeelingDataset& dataset,
                                       double triangles) {
    const pipeline::GpuParams gpu = configured_gpu(published.gpu, {});
    const auto whole = static_cast<double>(dataset.triangles);
    const double of_mesh = triangles / whole, of_call = triangles / std::min(whole, triangles_per_call);
    std::vector<std::string> limits{
        fmt::format("host.vram_mb={:.9g}", gpu.host.vram_mb * of_mesh),
        fmt::format("host.span_saturation={}", std::lround(std::ceil(gpu.host.span_saturation * of_call))),
        fmt::format("host.range_limit_vertices={}", std::lround(std::ceil(gpu.host.range_limit_vertices * of_call)))};
    if (dataset.grows == MeshGrowth::surface) {
        const pipeline::CacheParams& cache = gpu.geometry.vertex_fetch.cache;
        const std::uint32_t set = cache.line * cache.ways;
        const long sets = std::max(1L, std::lround(cache.bytes * std::sqrt(of_mesh) / set));
        limits.push_back(fmt::format("geometry.vertex_fetch.cache.bytes={}", sets * set));
    }
    return limits;
}

ComparisonRequest request_of(const PublishedPeeling& published, const PeelingMeasurement& row, std::uint64_t triangles,
                             const std::vector<std::string>& gpu_settings, const PeelingColumns& columns) {
    const PeelingDataset& dataset = published.dataset(row.dataset);
    ComparisonRequest request;
    request.scene = dataset.scene_of(triangles);
    request.camera = dataset.camera_of(triangles);
    request.width = request.height = picture_size;
    const traces::Load load = traces::layers_load(row.k, row.entry);
    request.workload = load.workload;
    request.workload_settings = load.settings;
    request.gpu = published.gpu;
    request.gpu_settings = shrunk_limits(published, dataset, static_cast<double>(triangles));
    request.gpu_settings.insert(request.gpu_settings.end(), gpu_settings.begin(), gpu_settings.end());
    for (const PeelingColumn column : columns) request.designs.push_back(design_of(column));
    request.threads = 1;
    return request;
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Between two neighbouring points. Its slope is taken for that at the geometric middle, the smaller of the two: then
/// more doublings lie behind it, and no fewer between two secants.
struct Secant {
    double middle = 0, slope = 0;
};

std::vector<Secant> secants_of(const std::vector<double>& x, const std::vector<double>& y) {
    std::vector<Secant> secants;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        CHECK(x[i] > 0 && x[i + 1] > x[i]);
        secants.push_back({std::sqrt(x[i] * x[i + 1]), (y[i + 1] - y[i]) / (x[i + 1] - x[i])});
    }
    return secants;
}

} // namespace

StandInRun run_stand_in(const PublishedPeeling& published, const PeelingMeasurement& row, std::uint64_t triangles,
                        const std::vector<std::string>& gpu_settings, const std::atomic<bool>* stop,
                        const PeelingColumns& columns) {
    const Supervision supervision{stop, nullptr, nullptr};
    const Comparison comparison =
        compare(prepare(request_of(published, row, triangles, gpu_settings, columns), supervision), supervision);
    StandInRun result;
    result.triangles = comparison.scene.triangles_drawn;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const pipeline::RunResult& run = comparison.runs[i];
        result.milliseconds[static_cast<std::size_t>(columns[i])] =
            static_cast<double>(run.cycles) / (run.core_mhz * 1e3) + run.sort_milliseconds;
    }
    result.host_seconds = comparison.host.seconds;
    return result;
}

LineValue line_value(const std::vector<double>& x, const std::vector<double>& y, double at) {
    CHECK(x.size() == y.size() && (x.size() == 1 || x.size() >= 3));
    if (x.size() == 1) return {y.front(), 0};
    const double mean_x = mean(x), mean_y = mean(y);
    double products = 0, squares = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        products += (x[i] - mean_x) * (y[i] - mean_y);
        squares += (x[i] - mean_x) * (x[i] - mean_x);
    }
    CHECK(squares > 0);
    const double value = mean_y + products / squares * (at - mean_x);
    const std::vector<Secant> secants = secants_of(x, y);
    double change = 0; // of the slope, per doubling of x
    for (std::size_t i = 0; i + 1 < secants.size(); ++i)
        change = std::max(change, std::abs(secants[i + 1].slope - secants[i].slope) /
                                      std::log2(secants[i + 1].middle / secants[i].middle));
    const Secant& last = secants.back();
    const double beyond = at - x.back();
    const double doublings = std::log2((x.back() + at) / 2 / last.middle);
    const double error = std::abs(value - y.back() - last.slope * beyond) + change * doublings * beyond;
    return {value, error / value + seed_share};
}

} // namespace reports
