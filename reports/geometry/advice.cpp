#include "reports/geometry/advice.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace reports {

namespace {

struct Candidate {
    std::string name;
    std::vector<std::string> prepare;
};

std::vector<Candidate> candidates(const GeometryExperiment& experiment) {
    if (!experiment.prepare.empty())
        return {{"as it is", {}}, {fmt::format("{}", fmt::join(experiment.prepare, " + ")), experiment.prepare}};
    return {{"as it is", {}},
            {"batch", {"batch"}},
            {"reorder", {"reorder"}},
            {"interleave", {"interleave"}},
            {"quantise", {"quantise"}},
            {"strips", {"strips"}},
            {"recommended", {"recommended"}},
            {"recommended + quantise", {"recommended", "quantise"}}};
}

} // namespace

std::size_t GeometryAdvice::best() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < cases.size(); ++i)
        if (cases[i].result.milliseconds < cases[best].result.milliseconds) best = i;
    return best;
}

std::string GeometryAdvice::recommendation() const {
    const GeometryCase& now = cases.front();
    const GeometryCase& then = cases[best()];
    std::string text = fmt::format("The limit is: {}.", now.result.limit());
    constexpr double worthwhile = 1.02;
    const double gain = now.result.milliseconds / then.result.milliseconds;
    if (gain < worthwhile) return text + " No preparation wins more than 2%: draw the scene as it is.";
    text += fmt::format(" {} wins {:.0f}%: {:.1f} instead of {:.1f} frames/s", then.name, (gain - 1) * 100,
                        then.result.frames_per_second(), now.result.frames_per_second());
    if (then.result.limit() != now.result.limit()) text += fmt::format(", then limited by {}", then.result.limit());
    return text + ".";
}

GeometryAdvice advise(const GeometryRequest& request, const GeometryRunOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    const pipeline::GpuParams gpu = configured_gpu(request.gpu, request.gpu_settings);
    GeometryAdvice advice;
    advice.gpu = request.gpu;
    advice.submission = request.experiment.submission;
    advice.fidelity = options.fidelity;
    advice.seed = request.seed;
    advice.core_mhz = gpu.clock.core_mhz;
    const std::vector<Candidate> list = candidates(request.experiment);
    for (const Candidate& candidate : list) {
        GeometryExperiment experiment = request.experiment;
        experiment.prepare = candidate.prepare;
        PreparedFrame prepared = prepare_frame(experiment, gpu);
        if (advice.cases.empty()) {
            advice.scene = prepared.scene;
            advice.hash = prepared.hash;
            advice.triangles = prepared.triangles;
            advice.notes = prepared.notes;
            advice.left_out = prepared.frame->left_out;
        }
        advice.cases.push_back({candidate.name, candidate.prepare, std::move(prepared.steps), prepared.measure,
                                run_geometry(gpu, *prepared.frame, options.fidelity, options.stop, request.seed)});
        if (options.progress)
            options.progress(static_cast<double>(advice.cases.size()) / static_cast<double>(list.size()));
    }
    advice.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return advice;
}

} // namespace reports
