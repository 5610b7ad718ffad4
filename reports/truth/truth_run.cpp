#include "reports/truth/truth_run.hpp"

#include "pipeline/functional/frame_streams.hpp"
#include "reports/remarks.hpp"
#include "reports/stopwatch.hpp"
#include "reports/truth/silhouettes.hpp"
#include "reports/truth/truth_cache.hpp"
#include "sim/check.hpp"
#include "traces/camera.hpp"
#include "traces/workloads.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace reports {

namespace {

std::function<void(double)> share_of(const Supervision& supervision) {
    if (supervision.progress == nullptr) return {};
    return [progress = supervision.progress](double share) { progress->share = share; };
}

void check_light(const TruthPlan& plan) {
    if (!plan.light) return;
    const glm::dvec3 &u = plan.light->u, &v = plan.light->v;
    const double lengths = glm::length(u) * glm::length(v);
    if (!(lengths > 0.0) || std::fabs(glm::dot(u, v)) > 1e-6 * lengths)
        throw sim::InputError("--light: expected two half edges at right angles");
}

void trace(const Supervision& supervision, TruthRun& run) {
    enter(supervision, Progress::Phase::tracing);
    const Stopwatch watch;
    const RayScene scene(run.frame->resources, run.frame->draws);
    run.build_seconds = watch.seconds();
    run.truth =
        trace_truth(*run.frame, scene, run.method, run.plan, {run.threads, supervision.stop, share_of(supervision)});
    run.tracing_seconds = watch.seconds() - run.build_seconds;
}

void trace_or_find(const TruthRequest& request, const Supervision& supervision, TruthRun& run) {
    const auto folder = request.use_cache ? TruthCache::usual_folder() : std::nullopt;
    if (!folder) return trace(supervision, run);
    const TruthCache cache(*folder);
    const std::string key = truth_key(run.scene.hash, *run.frame, *run.method.key, run.plan);
    TruthCache::Found found = cache.find(key);
    run.cached = found.truth.has_value();
    if (!found.note.empty()) run.notes.push_back(found.note);
    if (run.cached) {
        run.truth = std::move(*found.truth);
        return;
    }
    trace(supervision, run);
    if (const std::string note = cache.keep(key, run.truth); !note.empty()) run.notes.push_back(note);
}

void check(const Supervision& supervision, TruthRun& run) {
    enter(supervision, Progress::Phase::shading);
    pipeline::FrontEndOptions options;
    options.threads = run.threads;
    options.stop = supervision.stop;
    options.progress = share_of(supervision);
    const auto streams = pipeline::rasterize_frame(*run.frame, options);
    enter(supervision, Progress::Phase::reference);
    const pipeline::ReferenceImage reference = pipeline::run_reference(*run.frame, streams, 1, run.threads);
    run.errors = errors_of_reference(run.truth, run.method, *run.frame, reference);
    std::set<std::uint32_t> wrong;
    for (const TruthError& error : run.errors) wrong.insert(error.wrong_at.begin(), error.wrong_at.end());
    if (wrong.empty()) return;
    // Few pixels are wrong, so only these are asked whether anybody could know better.
    const RayScene scene(run.frame->resources, run.frame->draws);
    mark_uncertain(run.truth, *run.frame, scene, run.method, std::vector<std::uint32_t>(wrong.begin(), wrong.end()));
    run.errors = errors_of_reference(run.truth, run.method, *run.frame, reference);
}

} // namespace

double TruthRun::rays_per_second() const {
    const auto rays = static_cast<double>(truth.counts.pixel_rays + truth.counts.light_rays);
    return tracing_seconds > 0.0 ? rays / tracing_seconds : 0.0;
}

bool TruthRun::holds() const {
    const auto compared = [](const TruthError& error) { return error.compared != 0; };
    return std::any_of(errors.begin(), errors.end(), compared) &&
           std::all_of(errors.begin(), errors.end(),
                       [](const TruthError& error) { return error.compared == 0 || error.holds(); });
}

std::vector<std::string> remarks(const TruthRun& run) {
    std::vector<std::string> list;
    const bool compared =
        std::any_of(run.errors.begin(), run.errors.end(), [](const TruthError& error) { return error.compared != 0; });
    if (run.truth.counts.pixels_seen == 0)
        list.emplace_back("nothing is seen, so these numbers say nothing: no ray meets a surface that the workload "
                          "draws");
    if (!run.errors.empty() && !compared)
        list.emplace_back("nothing was compared, so the check says no: there is no pixel that can be judged");
    list.insert(list.end(), run.scene.notes.begin(), run.scene.notes.end());
    list.insert(list.end(), run.notes.begin(), run.notes.end());
    return each_once(list);
}

TruthRun run_truth(const TruthRequest& request, const Supervision& supervision) {
    const Stopwatch watch;
    enter(supervision, Progress::Phase::reading);
    check_light(request.plan);
    const auto options = traces::WorkloadOptions::of(request.workload_settings);
    const traces::Scene scene = traces::load_scene(request.scene);
    std::vector<std::string> notes;
    const pipeline::View view = traces::make_view(scene, request.camera, request.width, request.height, &notes);
    TruthRun run;
    run.frame = std::make_shared<const pipeline::Frame>(traces::build_frame(scene, view, request.workload, options));
    run.method = traces::truth_method(scene, *run.frame, request.workload, options);
    if (!run.method.key) run.method.key = options.values->dump();
    run.plan = request.plan;
    if (!run.plan.light) run.plan.light = run.method.light;
    if (run.method.frame) run.frame = run.method.frame;
    run.scene = facts_of(scene, request.camera, *run.frame, notes);
    run.threads = request.threads == 0 ? core_count() : request.threads;
    trace_or_find(request, supervision, run);
    if (request.check) check(supervision, run);
    run.seconds = watch.seconds();
    return run;
}

} // namespace reports
