#include "reports/deferred/validation.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/comparison.hpp"
#include "reports/validation/null_models.hpp"
#include "sim/check.hpp"
#include "traces/camera.hpp"
#include "traces/loads.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

namespace reports {

namespace {

template <class T>
bool wanted(const std::vector<T>& list, const T& one) {
    return list.empty() || std::find(list.begin(), list.end(), one) != list.end();
}

traces::Load load_of(const DeferredFrame& frame, std::uint32_t map_size) {
    return traces::one_pane_load({frame.method, frame.shadows, frame.refraction, frame.lights, map_size});
}

DeferredRun shares_of(const pipeline::RunResult& run, const pipeline::GpuParams& gpu) {
    const nlohmann::ordered_json& stages = *run.stages;
    const auto cycles = static_cast<double>(run.cycles);
    const auto counter = [&](const char* stage, const char* name) {
        return stages.at(stage).at("counters").at(name).get<double>() / cycles;
    };
    DeferredRun shares;
    shares.milliseconds = cycles / (run.core_mhz * 1e3);
    shares.memory =
        run.bytes->at("dram").at("bytes").get<double>() / (gpu.memory.bandwidth * 1e6 * shares.milliseconds);
    shares.arithmetic = counter("fragment_pipeline", "issue_cycles") / gpu.fragment.pipes;
    shares.texture = counter("fragment_pipeline", "texture_cycles") / gpu.fragment.pipes;
    shares.draw_calls = counter("command_processor", "cpu_wait_cycles");
    return shares;
}

// The pictures of passes from the eye, without the picture that is shown.
std::set<pipeline::SurfaceId> render_targets(const pipeline::Frame& frame) {
    std::set<pipeline::SurfaceId> targets;
    for (const pipeline::Pass& pass : frame.passes)
        if (pass.rasterizes() && pass.view == 0)
            for (const pipeline::SurfaceId target : pass.targets)
                if (target != pipeline::no_surface && target != frame.output) targets.insert(target);
    return targets;
}

} // namespace

std::string DeferredRun::limit() const {
    const std::array<std::pair<const char*, double>, 4> shares{
        {{"memory", memory}, {"arithmetic", arithmetic}, {"texture units", texture}, {"draw calls", draw_calls}}};
    const auto most = std::max_element(shares.begin(), shares.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return fmt::format("{} {:.0f}%", most->first, 100 * most->second);
}

void check_deferred_options(const PublishedDeferred& published, const DeferredOptions& options) {
    const std::vector<std::string> gpus = published.gpus();
    for (const std::string& name : options.gpus)
        if (!wanted(gpus, name))
            throw sim::InputError(
                fmt::format("--gpus: '{}' was not measured; expected {}", name, fmt::join(gpus, ", ")));
    const std::vector<std::uint32_t> lights = published.lights();
    for (const std::uint32_t count : options.lights)
        if (!wanted(lights, count))
            throw sim::InputError(
                fmt::format("--lights: {} were not measured; expected {}", count, fmt::join(lights, ", ")));
}

FrameSize size_of(const PublishedDeferred& published, const DeferredOptions& options) {
    return options.size.width != 0 ? options.size : FrameSize{published.width, published.height};
}

std::uint32_t map_size_of(const PublishedDeferred& published, const DeferredOptions& options) {
    const std::uint64_t scaled =
        std::uint64_t{published.map_size} * size_of(published, options).height / published.height;
    return std::max(static_cast<std::uint32_t>(scaled) & ~1U, 2U); // rows take turns
}

DeferredRun run_deferred(const PublishedDeferred& published, const DeferredFrame& frame,
                         const DeferredOptions& options) {
    const FrameSize size = size_of(published, options);
    const traces::Load load = load_of(frame, map_size_of(published, options));
    ComparisonRequest request;
    request.scene = published.scene_with(frame.transparent);
    request.width = size.width;
    request.height = size.height;
    request.workload = load.workload;
    request.workload_settings = load.settings;
    request.gpu = frame.gpu;
    request.gpu_settings = options.gpu_settings;
    request.designs = {"existing"}; // nothing is read, modified and written by a shader: every design is the same
    request.threads = 1;
    const Supervision supervision{options.stop, nullptr, nullptr};
    ComparisonInput input = prepare(request, supervision);
    const pipeline::GpuParams gpu = input.designs.front().gpu;
    const Comparison comparison = compare(std::move(input), supervision);
    DeferredRun run = shares_of(comparison.runs.front(), gpu);
    run.host_seconds = comparison.host.seconds;
    return run;
}

std::vector<DeferredFrame> frames_of(const PublishedDeferred& published, const DeferredOptions& options) {
    std::set<DeferredFrame> frames;
    for (const DeferredColumn& column : published.columns)
        for (const std::uint32_t count : column.lights)
            if (wanted(options.gpus, column.frame.gpu) && wanted(options.lights, count))
                frames.insert(column.with(count));
    std::vector<DeferredFrame> list(frames.begin(), frames.end());
    // Long ones first, so that threads end together.
    std::stable_sort(list.begin(), list.end(),
                     [](const DeferredFrame& a, const DeferredFrame& b) { return a.lights > b.lights; });
    return list;
}

std::vector<ValidationRow> deferred_target_rows(const PublishedDeferred& published) {
    const traces::Scene scene = traces::load_scene(published.scene_with(0));
    const pipeline::View view = traces::make_view(scene, "auto", published.width, published.height);
    std::vector<ValidationRow> rows;
    for (const DeferredTargets& targets : published.targets) {
        const traces::Load load = load_of({"", targets.method, "transparent", true, 0, 1}, published.map_size);
        const pipeline::Frame frame =
            traces::build_frame(scene, view, load.workload, traces::WorkloadOptions::of(load.settings));
        double count = 0, bytes = 0;
        for (const pipeline::SurfaceId target : render_targets(frame)) {
            ++count;
            bytes += static_cast<double>(frame.surfaces[target].nominal_bytes());
        }
        const auto add = [&](const PrintedNumber& printed, const char* unit, double model) {
            ValidationRow row;
            row.table = "T4.1";
            row.row = targets.method;
            row.gpu = "any";
            row.unit = unit;
            row.low = row.high = printed.value;
            row.sigma = printed.sigma();
            row.model = model;
            row.status = RowStatus::derived; // counted, not measured
            row.source = "counted";
            rows.push_back(std::move(row));
        };
        add(targets.count, "surfaces", count);
        add(targets.megabytes, "MB", bytes / 1e6);
    }
    return rows;
}

DeferredValidation validate_deferred(const PublishedDeferred& published, const DeferredOptions& options) {
    check_deferred_options(published, options);
    const std::vector<DeferredFrame> frames = frames_of(published, options);
    if (frames.empty()) throw sim::InputError("--gpus, --lights: no frame was measured with these");
    std::vector<DeferredRun> results(frames.size());
    std::size_t done = 0;
    std::mutex mutex;
    pipeline::parallel_for(options.threads, frames.size(), [&](std::size_t i) {
        results[i] = run_deferred(published, frames[i], options);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(frames.size()));
    });
    DeferredRuns runs;
    DeferredValidation validation;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        runs.emplace(frames[i], results[i]);
        validation.host_seconds += results[i].host_seconds;
    }
    validation.source = published.source;
    validation.parameter = published.calibrated.parameter;
    validation.size = size_of(published, options);
    validation.map_size = map_size_of(published, options);
    validation.as_measured = validation.size.width == published.width && validation.size.height == published.height;
    validation.rows = deferred_target_rows(published);
    for (ValidationRow& row : deferred_rows(published, runs)) {
        if (!validation.as_measured && row.status != RowStatus::derived) {
            row.status = RowStatus::derived;
            row.source = "of a larger picture";
        }
        validation.rows.push_back(std::move(row));
    }
    const PrintedNumber* calibrated =
        published.column(published.calibrated.column).measured(published.calibrated.lights);
    if (calibrated != nullptr) apply_constant_null_model(validation.rows, calibrated->value);
    validation.summary = summarise(validation.rows);
    std::erase_if(validation.summary, [](const ErrorSummary& one) {
        return one.predicted.rows == 0 && one.fitted.rows == 0 && one.gpu != "all";
    });
    return validation;
}

} // namespace reports
