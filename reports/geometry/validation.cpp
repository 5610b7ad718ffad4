#include "reports/geometry/validation.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/geometry/figures.hpp"
#include "reports/validation/null_models.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <mutex>

namespace reports {

namespace {

void measure(ValidationRow& row, const pipeline::GpuParams& gpu, const pipeline::Frame& frame,
             const GeometryRunOptions& options) {
    const pipeline::VertexPathResult result = run_geometry(gpu, frame, options.fidelity, options.stop);
    row.model = result.frames_per_second();
    row.limit = result.limit();
    row.acmr = result.counts.acmr();
    row.host_seconds = result.host_seconds;
}

} // namespace

void check_measured(const std::vector<std::string>& gpus, const std::vector<std::string>& measured) {
    for (const std::string& gpu : gpus)
        if (std::find(measured.begin(), measured.end(), gpu) == measured.end())
            throw sim::InputError(fmt::format("--gpus: '{}' was not measured{}; expected of: {}", gpu,
                                              sim::did_you_mean(gpu, measured), fmt::join(measured, ", ")));
}

ValidationRow published_row(const PublishedRow& published, const std::string& gpu) {
    ValidationRow row;
    row.table = published.table;
    row.row = published.row;
    row.gpu = gpu;
    const PrintedNumber& fps = published.fps.at(gpu);
    row.low = row.high = fps.value;
    row.sigma = fps.sigma();
    if (const auto text = published.explanations.find(gpu); text != published.explanations.end())
        row.explanation = text->second;
    return row;
}

void apply_plan(ValidationRow& row, const CalibrationPlan& plan) {
    CalibrationKind kind{};
    row.parameter = plan.parameter_of(row.gpu, row.key(), kind);
    if (!row.parameter.empty())
        row.status = kind == CalibrationKind::penalty ? RowStatus::penalty : RowStatus::calibrated;
    apply_choices(row, plan.choices);
    if (row.status == RowStatus::predicted && row.origin != PublishedOrigin::measured) row.status = RowStatus::derived;
}

namespace {

std::vector<ValidationRow> validate_tables(const std::vector<PublishedRow>& published, const CalibrationPlan& plan,
                                           const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    std::vector<std::vector<ValidationRow>> by_experiment(published.size());
    std::size_t done = 0;
    std::mutex mutex;
    pipeline::parallel_for(options.threads, published.size(), [&](std::size_t i) {
        std::shared_ptr<const pipeline::Frame> frame;
        for (const std::string& gpu : gpus) {
            if (!published[i].fps.contains(gpu)) continue;
            const pipeline::GpuParams params = gpu_params(gpu);
            if (frame == nullptr) frame = prepare_frame(published[i].experiment, params).frame;
            by_experiment[i].push_back(published_row(published[i], gpu));
            apply_plan(by_experiment[i].back(), plan);
            measure(by_experiment[i].back(), params, *frame, options);
        }
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(published.size()));
    });
    std::vector<ValidationRow> rows;
    for (auto& of_experiment : by_experiment)
        std::move(of_experiment.begin(), of_experiment.end(), std::back_inserter(rows));
    return rows;
}

// The progress of a part of the work as that of the whole.
GeometryRunOptions part_of(const GeometryRunOptions& options, double from, double to) {
    GeometryRunOptions part = options;
    if (options.progress)
        part.progress = [&options, from, to](double share) { options.progress(from + (to - from) * share); };
    return part;
}

} // namespace

GeometryValidation validate_geometry(const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    const std::vector<PublishedRow> published = load_published_geometry();
    const std::vector<PublishedFigure> figures = load_published_figures();
    const CalibrationPlan plan = load_calibration_plan();
    const std::vector<std::string> known = measured_gpus(published);
    check_measured(gpus, known);
    const std::vector<std::string>& chosen = gpus.empty() ? known : gpus;
    constexpr double share_of_tables = 0.7; // of the time
    GeometryValidation validation;
    validation.fidelity = options.fidelity;
    validation.rows = validate_tables(published, plan, chosen, part_of(options, 0, share_of_tables));
    std::vector<ValidationRow> rows = validate_figures(figures, plan, chosen, part_of(options, share_of_tables, 1));
    std::move(rows.begin(), rows.end(), std::back_inserter(validation.rows));
    apply_geometry_null_model(validation.rows);
    validation.summary = summarise(validation.rows);
    return validation;
}

} // namespace reports
