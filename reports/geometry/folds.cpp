#include "reports/geometry/folds.hpp"

#include "models/gpu_library.hpp"
#include "pipeline/functional/parallel.hpp"
#include "reports/geometry/solver.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports {

namespace {

constexpr std::uint64_t fold_sample = 20'000; ///< primitives that an estimate looks at, and at least a window a draw

/// Rows of one card, drawn with values of the numbers that are fitted.
class CardModel {
  public:
    CardModel(const std::string& gpu, std::vector<FitNumber> numbers, const std::atomic<bool>* stop)
        : config_(models::load_gpu(gpu)), numbers_(std::move(numbers)), stop_(stop) {}

    void add(std::shared_ptr<const pipeline::Frame> frame) { frames_.push_back(std::move(frame)); }

    std::vector<double> rates(const std::vector<std::size_t>& rows, const std::vector<double>& values) const {
        sim::Config config = config_;
        for (std::size_t i = 0; i < numbers_.size(); ++i)
            config.set(fmt::format("{}={:.17g}", numbers_[i].name, values[i]));
        pipeline::GpuParams params;
        config.read("", params);
        pipeline::VertexPathOptions options;
        options.stop = stop_;
        options.estimate_primitives = fold_sample;
        std::vector<double> found;
        for (const std::size_t row : rows)
            found.push_back(pipeline::estimate_vertex_path(params, *frames_[row], options).frames_per_second());
        return found;
    }

  private:
    sim::Config config_;
    std::vector<FitNumber> numbers_;
    const std::atomic<bool>* stop_;
    std::vector<std::shared_ptr<const pipeline::Frame>> frames_;
};

bool chosen_in_view(const ValidationRow& row, const std::vector<Choice>& choices) {
    return std::any_of(choices.begin(), choices.end(), [&row](const Choice& one) { return one.concerns(row); });
}

GpuFolds folds_of_card(const std::string& gpu, const std::vector<PublishedRow>& published, const CalibrationPlan& plan,
                       unsigned folds, std::uint64_t seed, const GeometryRunOptions& options) {
    FoldProblem problem;
    problem.gpu = gpu;
    for (const CalibrationStep& step : plan.steps)
        if (step.gpu == gpu) problem.fit.numbers.push_back({step.parameter, step.low, step.high});
    CardModel card(gpu, problem.fit.numbers, options.stop);
    const pipeline::GpuParams params = gpu_params(gpu);
    for (const PublishedRow& one : published) {
        if (!one.fps.contains(gpu)) continue;
        ValidationRow row = published_row(one, gpu);
        apply_plan(row, plan);
        problem.held_in.push_back(chosen_in_view(row, plan.choices));
        problem.fit.published.push_back(row.low);
        problem.rows.push_back(std::move(row));
    }
    std::vector<PreparedFrame> frames(problem.rows.size());
    pipeline::parallel_for(options.threads, frames.size(), [&](std::size_t i) {
        frames[i] = prepare_frame(find_row(published, problem.rows[i].key()).experiment, params);
    });
    for (const PreparedFrame& frame : frames) card.add(frame.frame);
    problem.fit.model = [&card](const auto& rows, const auto& values) { return card.rates(rows, values); };
    return cross_validate(problem, folds, seed, options.threads);
}

} // namespace

std::vector<GpuFolds> fold_geometry(const std::vector<std::string>& gpus, unsigned folds, std::uint64_t seed,
                                    const GeometryRunOptions& options) {
    const std::vector<PublishedRow> published = load_published_geometry();
    const CalibrationPlan plan = load_calibration_plan();
    const std::vector<std::string> known = measured_gpus(published);
    check_measured(gpus, known);
    std::vector<GpuFolds> results;
    for (const std::string& gpu : gpus.empty() ? known : gpus) {
        results.push_back(folds_of_card(gpu, published, plan, folds, seed, options));
        if (options.progress)
            options.progress(static_cast<double>(results.size()) /
                             static_cast<double>(gpus.empty() ? known.size() : gpus.size()));
    }
    return results;
}

} // namespace reports
