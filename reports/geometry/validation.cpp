#include "reports/geometry/validation.hpp"

#include "pipeline/functional/parallel.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <mutex>

namespace reports {

namespace {

double median_of(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

ErrorSummary summary_of(std::string gpu, const std::vector<ValidationRow>& rows) {
    ErrorSummary summary;
    std::vector<double> errors;
    for (const ValidationRow& row : rows) {
        if (row.status != RowStatus::predicted || (gpu != "all" && row.gpu != gpu)) continue;
        errors.push_back(row.error());
        if (row.error() < summary.worst) continue;
        summary.worst = row.error();
        summary.worst_row = fmt::format("{} {}{}", row.table, row.row, gpu == "all" ? " on " + row.gpu : "");
    }
    summary.gpu = std::move(gpu);
    summary.predicted = errors.size();
    summary.median = median_of(std::move(errors));
    return summary;
}

void check_gpus(const std::vector<std::string>& gpus, const std::vector<std::string>& known) {
    for (const std::string& gpu : gpus)
        if (std::find(known.begin(), known.end(), gpu) == known.end())
            throw sim::InputError(fmt::format("--gpus: '{}' was not measured{}; expected of: {}", gpu,
                                              sim::did_you_mean(gpu, known), fmt::join(known, ", ")));
}

ValidationRow unmeasured(const PublishedRow& published, const std::string& gpu, const CalibrationPlan& plan) {
    ValidationRow row;
    row.table = published.table;
    row.row = published.row;
    row.gpu = gpu;
    row.published = published.fps.at(gpu);
    CalibrationKind kind{};
    row.parameter = plan.parameter_of(gpu, published.key(), kind);
    if (!row.parameter.empty())
        row.status = kind == CalibrationKind::penalty ? RowStatus::penalty : RowStatus::calibrated;
    if (const auto text = published.explanations.find(gpu); text != published.explanations.end())
        row.explanation = text->second;
    return row;
}

void measure(ValidationRow& row, const pipeline::GpuParams& gpu, const pipeline::Frame& frame,
             const GeometryRunOptions& options) {
    const pipeline::VertexPathResult result = run_geometry(gpu, frame, options.fidelity, options.stop);
    row.model = result.frames_per_second();
    row.limit = result.limit();
    row.acmr = result.counts.acmr();
    row.host_seconds = result.host_seconds;
}

} // namespace

double ValidationRow::error() const { return std::abs(ratio() - 1); }

std::vector<ErrorSummary> summarise(const std::vector<ValidationRow>& rows) {
    std::vector<std::string> gpus;
    for (const ValidationRow& row : rows)
        if (std::find(gpus.begin(), gpus.end(), row.gpu) == gpus.end()) gpus.push_back(row.gpu);
    std::vector<ErrorSummary> list;
    for (const std::string& gpu : gpus) list.push_back(summary_of(gpu, rows));
    list.push_back(summary_of("all", rows));
    return list;
}

GeometryValidation validate_geometry(const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    const std::vector<PublishedRow> published = load_published_geometry();
    const CalibrationPlan plan = load_calibration_plan();
    const std::vector<std::string> known = measured_gpus(published);
    check_gpus(gpus, known);
    std::vector<std::vector<ValidationRow>> by_experiment(published.size());
    std::size_t done = 0;
    std::mutex mutex;
    pipeline::parallel_for(options.threads, published.size(), [&](std::size_t i) {
        std::shared_ptr<const pipeline::Frame> frame;
        for (const std::string& gpu : gpus.empty() ? known : gpus) {
            if (!published[i].fps.contains(gpu)) continue;
            const pipeline::GpuParams params = gpu_params(gpu);
            if (frame == nullptr) frame = prepare_frame(published[i].experiment, params).frame;
            by_experiment[i].push_back(unmeasured(published[i], gpu, plan));
            measure(by_experiment[i].back(), params, *frame, options);
        }
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(published.size()));
    });
    GeometryValidation validation;
    validation.fidelity = options.fidelity;
    for (auto& rows : by_experiment)
        for (ValidationRow& row : rows) validation.rows.push_back(std::move(row));
    validation.summary = summarise(validation.rows);
    return validation;
}

} // namespace reports
