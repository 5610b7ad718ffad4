#include "reports/accuracy/averaged_frames.hpp"

#include "sim/check.hpp"
#include "traces/camera.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reports {

namespace {

double cycles_of(const pipeline::RunResult& run, const std::vector<std::string>& passes) {
    double cycles = 0;
    for (const pipeline::PassResult& pass : run.passes)
        if (std::find(passes.begin(), passes.end(), pass.name) != passes.end())
            cycles += static_cast<double>(pass.cycles);
    return cycles;
}

AveragedFrames average(ComparisonRequest request, const std::vector<std::vector<std::string>>& settings,
                       const std::vector<std::string>& drawn_once, const Supervision& supervision) {
    AveragedFrames result;
    std::vector<double> sum;
    for (const std::vector<std::string>& own : settings) {
        request.workload_settings = own;
        Comparison comparison = compare(prepare(request, supervision), supervision);
        const pipeline::RunResult& run = comparison.runs.front();
        const double shared = result.frames == 0 ? 0.0 : cycles_of(run, drawn_once);
        result.sim_ms += (static_cast<double>(run.cycles) - shared) / (run.core_mhz * 1000.0);
        result.host_s += run.host_seconds + comparison.host.front_end_seconds;
        result.pixels = std::move(comparison.pixels.front());
        result.frame = comparison.frame;
        ++result.frames;
        const std::vector<float>& picture = result.pixels.composite;
        sum.resize(picture.size());
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += static_cast<double>(picture[i]) / static_cast<double>(settings.size());
    }
    std::transform(sum.begin(), sum.end(), result.pixels.composite.begin(),
                   [](double value) { return static_cast<float>(value); });
    return result;
}

const traces::Averaging& averaging_of(const traces::Workload& workload) {
    if (workload.averaging) return *workload.averaging;
    std::vector<std::string> known;
    for (const traces::Workload& one : traces::workloads())
        if (one.averaging) known.push_back(one.id);
    throw sim::InputError(
        fmt::format("--averaged: expected a workload of {}, got {}", fmt::join(known, ", "), workload.id));
}

} // namespace

std::vector<AveragedFrames> average_frames(const AccuracyRequest& request, const Supervision& supervision) {
    const ComparisonRequest& base = request.comparison;
    const traces::Averaging& averaging = averaging_of(base.workload.get());
    const auto options = traces::WorkloadOptions::of(base.workload_settings);
    const traces::Scene scene = traces::load_scene(base.scene);
    const pipeline::View view = traces::make_view(scene, base.camera, base.width, base.height);
    const pipeline::Frame frame = traces::build_frame(scene, view, base.workload, options);
    std::vector<AveragedFrames> result;
    for (std::uint32_t count = 4; count <= request.averaged; count *= 4)
        result.push_back(
            average(base, averaging.settings(scene, frame, options, count), averaging.drawn_once, supervision));
    return result;
}

} // namespace reports
