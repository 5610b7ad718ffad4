#include "reports/accuracy/accuracy.hpp"

#include "reports/accuracy/averaged_frames.hpp"
#include "reports/accuracy/error_picture.hpp"
#include "reports/remarks.hpp"
#include "reports/stopwatch.hpp"
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
    const traces::Workload& workload = request.comparison.workload.get();
    if (!request.against && (!workload.truth || workload.quality.empty()))
        throw sim::InputError(
            fmt::format("accuracy: expected a workload with a truth and knobs of quality, got '{}'", workload.id));
    if (request.sweep.empty()) return one_at_a_time(workload, request.comparison.workload_settings);
    for (const traces::QualityKnob& knob : request.sweep)
        if (is_set(request.comparison.workload_settings, knob.parameter))
            throw sim::InputError(fmt::format("--sweep: '{}' is set for all points, too", knob.parameter));
    return combinations(request.sweep);
}

// What pictures are measured against.
struct Standard {
    Truth truth;
    traces::Measured measured = traces::Measured::colours;
    bool same_rasterizer = false; ///< so that pixels at silhouettes show the same surfaces
};

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

std::vector<PixelKind> kinds_of(const FramePixels& pixels, const pipeline::Frame& frame, const Standard& standard) {
    auto kinds = kinds_of_pixels(frame.view, pixels.depth);
    if (standard.same_rasterizer) std::replace(kinds.begin(), kinds.end(), PixelKind::silhouette, PixelKind::inner);
    return kinds;
}

// Of a surface that is black in full light a method need not know how much it gets, as nothing shows it.
void leave_out_black(std::span<const float> picture, std::vector<PixelKind>& kinds) {
    for (std::size_t pixel = 0; pixel < kinds.size(); ++pixel) {
        const auto rgba = picture.subspan(4 * pixel, 4);
        if (rgba[0] == 0.0F && rgba[1] == 0.0F && rgba[2] == 0.0F && rgba[3] == 1.0F)
            kinds[pixel] = PixelKind::background;
    }
}

// Measures the picture, and shows it where that is wanted.
void judge(const AccuracyRequest& request, const FramePixels& pixels, const pipeline::Frame& frame,
           const Standard& standard, AccuracyPoint& point) {
    const Truth& truth = standard.truth;
    if (standard.measured == traces::Measured::light) {
        auto kinds = kinds_of(pixels, frame, standard);
        leave_out_black(pixels.composite, kinds);
        point.error = shadow_error(pixels.composite, truth.visibility, kinds);
        if (request.pictures)
            point.picture = shadow_error_picture(frame.view, pixels.composite, truth.visibility, kinds, point.name());
        return;
    }
    point.error = picture_error(pixels.composite, truth);
    if (request.pictures) point.picture = picture_error_picture(pixels.composite, truth, point.name());
}

bool is_listed(const std::vector<std::string>& list, const std::string& text) {
    return std::find(list.begin(), list.end(), text) != list.end();
}

// What the method did not do as asked for, besides what is known of the scene.
void add_notes(const SceneFacts& drawn, Accuracy& accuracy) {
    for (const std::string& note : drawn.notes)
        if (!is_listed(accuracy.scene.notes, note) && !is_listed(accuracy.notes, note)) accuracy.notes.push_back(note);
}

Comparison run_of(ComparisonRequest request, const Knobs& knobs, const Supervision& supervision, Accuracy& accuracy) {
    request.workload_settings.insert(request.workload_settings.end(), knobs.begin(), knobs.end());
    Comparison comparison = compare(prepare(request, supervision), supervision);
    add_notes(comparison.scene, accuracy);
    return comparison;
}

AccuracyPoint point_of(const AccuracyRequest& request, const Knobs& knobs, const Comparison& comparison,
                       const Standard& standard) {
    const pipeline::RunResult& run = comparison.runs.front();
    AccuracyPoint point;
    point.workload = comparison.frame->workload;
    point.design = comparison.variants.front().label;
    point.knobs = knobs;
    point.sim_ms = static_cast<double>(run.cycles) / (run.core_mhz * 1000.0);
    point.host_s = run.host_seconds + comparison.host.front_end_seconds;
    point.wrong_pixels = run.wrong_pixels;
    judge(request, comparison.pixels.front(), *comparison.frame, standard, point);
    return point;
}

void add_averages(const AccuracyRequest& request, const Standard& standard, const Supervision& supervision,
                  std::vector<AccuracyPoint>& points) {
    for (const AveragedFrames& averaged : average_frames(request, supervision)) {
        AccuracyPoint point;
        point.workload = request.comparison.workload.name();
        point.knobs = {fmt::format("averaged={}", averaged.frames)};
        point.sim_ms = averaged.sim_ms;
        point.host_s = averaged.host_s;
        judge(request, averaged.pixels, *averaged.frame, standard, point);
        points.push_back(std::move(point));
    }
}

// The request of the rival, without its own settings.
ComparisonRequest rival_of(const AccuracyRequest& request) {
    ComparisonRequest rival = request.comparison;
    if (request.against->workload) {
        rival.workload = *request.against->workload;
        if (rival.workload.name() != request.comparison.workload.name()) rival.workload_settings.clear();
        if (rival.workload.get().measured != request.comparison.workload.get().measured)
            throw sim::InputError(fmt::format(
                "--against: workloads {} and {} are not measured alike: one by its colours, the other by the "
                "light in alpha",
                request.comparison.workload.name(), rival.workload.name()));
    }
    for (const std::string& own : request.against->settings) {
        const std::string key = own.substr(0, own.find('=') + 1);
        std::erase_if(rival.workload_settings, [&](const std::string& shared) { return shared.starts_with(key); });
    }
    return rival;
}

Standard standard_of(const Comparison& rival, traces::Measured measured) {
    const std::vector<float>& picture = rival.reference.composite;
    if (picture.empty())
        throw sim::InputError(fmt::format("--against: workload {} makes no picture", rival.frame->workload));
    Standard standard{{}, measured, true};
    Truth& truth = standard.truth;
    truth.width = rival.width();
    truth.height = rival.height();
    truth.colours = picture;
    truth.marks.resize(truth.pixels());
    for (std::size_t alpha = 3; alpha < picture.size(); alpha += 4) truth.visibility.push_back(picture[alpha]);
    return standard;
}

Standard traced_standard(const AccuracyRequest& request, const Supervision& supervision, Accuracy& accuracy) {
    TruthRun truth = truth_of(request, supervision);
    accuracy.scene = std::move(truth.scene);
    accuracy.notes = std::move(truth.notes);
    accuracy.truth_seconds = truth.seconds;
    accuracy.truth_cached = truth.cached;
    if (truth.plan.light) {
        const std::uint32_t parts = light_parts(truth.plan.sampling.rays);
        accuracy.rays = parts * parts;
    }
    return {std::move(truth.truth), request.comparison.workload.get().measured, false};
}

bool beats(double time, double error, double other_time, double other_error) {
    return time <= other_time && error <= other_error && (time < other_time || error < other_error);
}

} // namespace

std::string AccuracyPoint::name() const {
    if (rival) return fmt::format("against {} {}", workload, fmt::join(knobs, " "));
    return knobs.empty() ? "as set" : fmt::format("{}", fmt::join(knobs, " "));
}

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
    accuracy.workload = request.comparison.workload.name();
    accuracy.gpu = request.comparison.gpu;
    accuracy.width = request.comparison.width;
    accuracy.height = request.comparison.height;
    accuracy.settings = request.comparison.workload_settings;
    std::optional<Comparison> rival;
    Standard standard;
    if (request.against) {
        const Stopwatch watch;
        const ComparisonRequest other = rival_of(request);
        rival = run_of(other, request.against->settings, supervision, accuracy);
        accuracy.scene = rival->scene;
        accuracy.notes.clear(); // they are the scene's
        accuracy.against =
            fmt::format("{}{}", other.workload.name() == accuracy.workload ? "" : other.workload.name() + " ",
                        fmt::join(request.against->settings, " "));
        standard = standard_of(*rival, request.comparison.workload.get().measured);
        accuracy.truth_seconds = watch.seconds();
    } else {
        standard = traced_standard(request, supervision, accuracy);
    }
    for (const Knobs& knobs : points)
        accuracy.points.push_back(
            point_of(request, knobs, run_of(request.comparison, knobs, supervision, accuracy), standard));
    if (request.averaged > 0) add_averages(request, standard, supervision, accuracy.points);
    if (rival) {
        accuracy.points.push_back(point_of(request, request.against->settings, *rival, standard));
        accuracy.points.back().rival = true;
    }
    for (const AccuracyPoint& point : accuracy.points)
        if (!point.design.empty() && !is_listed(accuracy.designs, point.design))
            accuracy.designs.push_back(point.design);
    mark_pareto(accuracy.points);
    return accuracy;
}

} // namespace reports
