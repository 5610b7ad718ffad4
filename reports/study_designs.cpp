// Studies of k-buffer designs.
#include "reports/comparison.hpp"
#include "reports/frame_size.hpp"
#include "reports/run_values.hpp"
#include "reports/study_runs.hpp"
#include "sim/check.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace reports {

namespace {

std::string place(const Study& study, const StudySeries& series, const StudyPoint& point) {
    return fmt::format("study {}: series '{}' at {}", study.name, series.name, point.at("x"));
}

ComparisonRequest request_of(const Study& study, const StudySeries& series, const StudyPoint& point,
                             const std::string& gpu) {
    ComparisonRequest request;
    request.scene = filled(series.scene, point, study);
    const std::string size = filled(study.size, point, study);
    const auto pixels = frame_size(size);
    if (!pixels)
        throw sim::InputError(fmt::format("study {}: size: expected WIDTHxHEIGHT with 1 to {} pixels each, got '{}'",
                                          study.name, largest_side, size));
    request.width = pixels->width;
    request.height = pixels->height;
    const std::string samples = filled(study.samples, point, study);
    const auto count = sample_count(samples);
    if (!count)
        throw sim::InputError(fmt::format("study {}: samples: expected 1, 4 or 8, got '{}'", study.name, samples));
    request.samples = *count;
    request.workload = study.workload;
    request.gpu = gpu;
    constexpr std::string_view workload = "workload.";
    for (const std::string& setting : filled(series.settings, point, study))
        if (setting.starts_with(workload))
            request.workload_settings.push_back(setting.substr(workload.size()));
        else
            request.gpu_settings.push_back(setting);
    request.designs = {filled(series.design, point, study)};
    request.threads = 1; // the runs of a study are side by side
    return request;
}

/// The runs of one design with different seeds.
class Samples {
  public:
    explicit Samples(const Study& study) : study_(study), numbers_(study.measures.size()) {}

    void add(const Comparison& comparison, const std::string& place) {
        const RunValues values(comparison, 0);
        change_.add(comparison, 0);
        drew_ = drew_ || comparison.runs.front().fragments != 0;
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            const StudyMeasure& measure = study_.measures[i];
            if (is_change(measure)) continue;
            const auto number = values.at(measure.value);
            if (!number && !measure.optional)
                throw sim::InputError(fmt::format("{}: the run has no value '{}'{}", place, measure.value,
                                                  sim::did_you_mean(measure.value, values.names())));
            numbers_[i].push_back(number.value_or(std::numeric_limits<double>::quiet_NaN()));
        }
    }

    std::vector<StudyNumber> numbers() const {
        std::vector<StudyNumber> list;
        for (std::size_t i = 0; i < numbers_.size(); ++i) list.push_back(number(study_.measures[i], numbers_[i]));
        return list;
    }

    bool drew() const { return drew_; }

  private:
    static bool is_change(const StudyMeasure& measure) {
        return measure.value == "frame_change" || measure.value == "frame_change_worst";
    }

    StudyNumber number(const StudyMeasure& measure, const std::vector<double>& list) const {
        if (is_change(measure)) {
            const double change = measure.value == "frame_change" ? change_.mean() : change_.worst();
            return {measure.value, change, change, change};
        }
        double sum = 0;
        for (const double one : list) sum += one;
        const auto [low, high] = std::minmax_element(list.begin(), list.end());
        return {measure.value, sum / static_cast<double>(list.size()), *low, *high};
    }

    const Study& study_;
    std::vector<std::vector<double>> numbers_; ///< by measure, then seed
    FrameChange change_;
    bool drew_ = false;
};

StudyValue measure(const Study& study, const StudySeries& series, const StudyPoint& point, const std::string& gpu,
                   const std::atomic<bool>* stop) {
    Samples samples(study);
    for (std::uint32_t seed = 1; seed <= study.seeds; ++seed) {
        StudyPoint variables = point;
        variables["seed"] = std::to_string(seed);
        ComparisonRequest request = request_of(study, series, variables, gpu);
        request.seed = seed;
        const Supervision supervision{stop, nullptr, nullptr};
        samples.add(compare(prepare(request, supervision), supervision), place(study, series, point));
    }
    StudyValue value;
    value.numbers = samples.numbers();
    value.drew = samples.drew();
    return value;
}

} // namespace

std::vector<StudyValue> run_design_series(const Study& study, const StudySeries& series, const StudyPoint& point,
                                          const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    std::vector<StudyValue> values;
    for (const std::string& gpu : gpus) {
        try {
            values.push_back(measure(study, series, point, gpu, options.stop));
        } catch (const sim::InputError& error) {
            const std::string text = error.what();
            const std::string start = place(study, series, point) + ": ";
            throw sim::InputError(text.starts_with("study ") ? text : start + text);
        }
    }
    return values;
}

} // namespace reports
