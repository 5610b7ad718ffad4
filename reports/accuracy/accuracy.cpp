#include "reports/accuracy/accuracy.hpp"

#include "reports/accuracy/averaged_shadows.hpp"
#include "reports/accuracy/error_picture.hpp"
#include "reports/remarks.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reports {

namespace {

using Knobs = std::vector<std::string>;

// Every combination of the values, the last knob turning fastest.
std::vector<Knobs> combinations(const std::vector<traces::QualityKnob>& sweep) {
    std::vector<Knobs> result{{}};
    for (const traces::QualityKnob& knob : sweep) {
        std::vector<Knobs> longer;
        for (const Knobs& begun : result)
            for (const std::string& value : knob.values) {
                longer.push_back(begun);
                longer.back().push_back(fmt::format("{}={}", knob.parameter, value));
            }
        result = std::move(longer);
    }
    return result;
}

bool is_set(const std::vector<std::string>& settings, const std::string& knob) {
    for (const std::string& setting : settings)
        if (setting.starts_with(knob + "=")) return true;
    return false;
}

// The shared settings as they are, and each knob alone.
std::vector<Knobs> one_at_a_time(const traces::Workload& workload, const std::vector<std::string>& settings) {
    std::vector<Knobs> result{{}};
    for (const traces::QualityKnob& knob : workload.quality)
        if (!is_set(settings, knob.parameter))
            for (const std::string& value : knob.values)
                result.push_back({fmt::format("{}={}", knob.parameter, value)});
    return result;
}

std::vector<Knobs> plan(const AccuracyRequest& request) {
    const traces::Workload& workload = traces::workload_named(request.comparison.workload);
    if (workload.quality.empty())
        throw sim::InputError(
            fmt::format("accuracy: expected a workload with a truth and knobs of quality, got '{}'", workload.id));
    if (request.sweep.empty()) return one_at_a_time(workload, request.comparison.workload_settings);
    for (const traces::QualityKnob& knob : request.sweep)
        if (is_set(request.comparison.workload_settings, knob.parameter))
            throw sim::InputError(fmt::format("--sweep: '{}' is set for all points, too", knob.parameter));
    return combinations(request.sweep);
}

TruthRun truth_of(const AccuracyRequest& request, const Supervision& supervision) {
    const ComparisonRequest& comparison = request.comparison;
    TruthRequest truth;
    truth.scene = comparison.scene;
    truth.camera = comparison.camera;
    truth.width = comparison.width;
    truth.height = comparison.height;
    truth.workload = comparison.workload;
    truth.workload_settings = comparison.workload_settings;
    truth.plan.layers = 1; // pictures are made from all
    truth.plan.sampling = request.sampling;
    truth.use_cache = request.use_cache;
    truth.threads = comparison.threads;
    return run_truth(truth, supervision);
}

// Measures the picture, and shows it where that is wanted.
void judge(const AccuracyRequest& request, const FramePixels& pixels, const pipeline::Frame& frame, const Truth& truth,
           AccuracyPoint& point) {
    if (frame.light) {
        const auto kinds = kinds_of_pixels(frame.view, pixels.depth);
        point.error = shadow_error(pixels.composite, truth.visibility, kinds);
        if (request.pictures)
            point.picture = shadow_error_picture(frame.view, pixels.composite, truth.visibility, kinds, point.name());
        return;
    }
    point.error = picture_error(pixels.composite, truth);
    if (request.pictures) point.picture = picture_error_picture(pixels.composite, truth, point.name());
}

// What the method did not do as asked for, besides what is known of the scene.
void add_notes(const SceneFacts& drawn, Accuracy& accuracy) {
    const auto knows = [](const std::vector<std::string>& notes, const std::string& note) {
        return std::find(notes.begin(), notes.end(), note) != notes.end();
    };
    for (const std::string& note : drawn.notes)
        if (!knows(accuracy.scene.notes, note) && !knows(accuracy.notes, note)) accuracy.notes.push_back(note);
}

AccuracyPoint point_of(const AccuracyRequest& request, const Knobs& knobs, const Truth& truth,
                       const Supervision& supervision, Accuracy& accuracy) {
    ComparisonRequest one = request.comparison;
    one.workload_settings.insert(one.workload_settings.end(), knobs.begin(), knobs.end());
    const Comparison comparison = compare(prepare(one, supervision), supervision);
    add_notes(comparison.scene, accuracy);
    const pipeline::RunResult& run = comparison.runs.front();
    AccuracyPoint point;
    point.knobs = knobs;
    point.sim_ms = static_cast<double>(run.cycles) / (run.core_mhz * 1000.0);
    point.host_s = run.host_seconds + comparison.host.front_end_seconds;
    point.wrong_pixels = run.wrong_pixels;
    judge(request, comparison.pixels.front(), *comparison.frame, truth, point);
    return point;
}

void add_averages(const AccuracyRequest& request, const Truth& truth, const Supervision& supervision,
                  std::vector<AccuracyPoint>& points) {
    for (const AveragedShadows& averaged : average_hard_shadows(request, supervision)) {
        AccuracyPoint point;
        point.knobs = {fmt::format("averaged={}", averaged.lights)};
        point.sim_ms = averaged.sim_ms;
        point.host_s = averaged.host_s;
        judge(request, averaged.pixels, *averaged.frame, truth, point);
        points.push_back(std::move(point));
    }
}

bool beats(double time, double error, double other_time, double other_error) {
    return time <= other_time && error <= other_error && (time < other_time || error < other_error);
}

} // namespace

std::string AccuracyPoint::name() const { return knobs.empty() ? "as set" : fmt::format("{}", fmt::join(knobs, " ")); }

std::vector<std::string> remarks(const Accuracy& accuracy) {
    std::vector<std::string> list;
    if (std::all_of(accuracy.points.begin(), accuracy.points.end(),
                    [](const AccuracyPoint& point) { return point.error.compared == 0; }))
        list.emplace_back("nothing was compared, so these errors say nothing: no pixel shows a surface away from "
                          "silhouettes");
    list.insert(list.end(), accuracy.scene.notes.begin(), accuracy.scene.notes.end());
    list.insert(list.end(), accuracy.notes.begin(), accuracy.notes.end());
    return each_once(list);
}

void mark_pareto(std::vector<AccuracyPoint>& points) {
    for (AccuracyPoint& point : points) {
        point.pareto = point.pareto_host = true;
        for (const AccuracyPoint& other : points) {
            if (beats(other.sim_ms, other.error.rmse, point.sim_ms, point.error.rmse)) point.pareto = false;
            if (beats(other.host_s, other.error.rmse, point.host_s, point.error.rmse)) point.pareto_host = false;
        }
    }
}

Accuracy measure_accuracy(const AccuracyRequest& request, const Supervision& supervision) {
    const std::vector<Knobs> points = plan(request);
    Accuracy accuracy;
    TruthRun truth = truth_of(request, supervision);
    accuracy.workload = request.comparison.workload;
    accuracy.design = request.comparison.designs.front();
    accuracy.gpu = request.comparison.gpu;
    accuracy.scene = std::move(truth.scene);
    accuracy.width = request.comparison.width;
    accuracy.height = request.comparison.height;
    accuracy.settings = request.comparison.workload_settings;
    accuracy.notes = std::move(truth.notes);
    accuracy.truth_seconds = truth.seconds;
    accuracy.truth_cached = truth.cached;
    if (truth.plan.light) {
        const std::uint32_t parts = light_parts(truth.plan.sampling.rays);
        accuracy.rays = parts * parts;
    }
    for (const Knobs& knobs : points)
        accuracy.points.push_back(point_of(request, knobs, truth.truth, supervision, accuracy));
    if (request.averaged > 0) add_averages(request, truth.truth, supervision, accuracy.points);
    mark_pareto(accuracy.points);
    return accuracy;
}

} // namespace reports
