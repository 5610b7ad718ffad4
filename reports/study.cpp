#include "reports/study.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/study_runs.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <mutex>

namespace reports {

namespace {

/// Numbers of the series that a measure is taken over, at the same point on the same GPU.
void divide(StudyResult& result, std::size_t measure) {
    const Study& study = result.study;
    const std::string& over = study.measures[measure].over;
    const auto base = std::find_if(study.series.begin(), study.series.end(),
                                   [&over](const StudySeries& series) { return series.name == over; });
    const std::size_t gpus = study.gpus.size(), row = study.series.size() * gpus;
    const auto first = static_cast<std::size_t>(base - study.series.begin()) * gpus;
    const std::vector<StudyValue> undivided = result.values;
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        const double by = undivided[i / row * row + first + i % gpus].numbers[measure].mean;
        StudyNumber& number = result.values[i].numbers[measure];
        for (double* one : {&number.mean, &number.low, &number.high}) *one /= by;
    }
}

// A misspelt number that runs may lack is found out when no run has it.
void expect_somewhere(const StudyResult& result, std::size_t measure) {
    const auto missing = [measure](const StudyValue& value) { return std::isnan(value.numbers[measure].mean); };
    if (std::all_of(result.values.begin(), result.values.end(), missing))
        throw sim::InputError(fmt::format("study {}: no run has the value '{}'", result.study.name,
                                          result.study.measures[measure].value));
}

void finish(StudyResult& result) {
    for (std::size_t measure = 0; result.study.of_designs() && measure < result.study.measures.size(); ++measure) {
        if (result.study.measures[measure].optional) expect_somewhere(result, measure);
        if (!result.study.measures[measure].over.empty()) divide(result, measure);
    }
    for (StudyValue& value : result.values) value.measure = measure_of(value, result.study.measures.front().value);
}

} // namespace

std::string filled(const std::string& text, const StudyPoint& point, const Study& study) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t end = text[i] == '{' ? text.find('}', i) : std::string::npos;
        if (end == std::string::npos) {
            result += text[i++];
            continue;
        }
        const auto found = point.find(text.substr(i + 1, end - i - 1));
        if (found == point.end())
            throw sim::InputError(fmt::format("study {}: '{}' names a variable that the point x = {} does not have",
                                              study.name, text, point.at("x")));
        result += found->second;
        i = end + 1;
    }
    return result;
}

std::vector<std::string> filled(const std::vector<std::string>& texts, const StudyPoint& point, const Study& study) {
    std::vector<std::string> list;
    for (const std::string& text : texts) list.push_back(filled(text, point, study));
    return list;
}

double measure_of(const StudyValue& value, const std::string& measure) {
    const auto found = std::find_if(value.numbers.begin(), value.numbers.end(),
                                    [&measure](const StudyNumber& number) { return number.value == measure; });
    CHECK(found != value.numbers.end());
    return found->mean;
}

std::vector<StudyValue> run_series(const Study& study, const StudySeries& series, const StudyPoint& point,
                                   const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    const auto run = study.of_designs() ? run_design_series : run_geometry_series;
    std::vector<StudyValue> values = run(study, series, point, gpus, options);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i].gpu = gpus[i];
        values[i].series = series.name;
        values[i].x = point.at("x");
    }
    return values;
}

StudyResult run_study(const Study& study, const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    StudyResult result{study, {}, options.fidelity};
    if (study.of_designs() && options.fidelity != Fidelity::detailed)
        throw sim::InputError(fmt::format("study {}: designs are only run in detail", study.name));
    if (!gpus.empty()) result.study.gpus = gpus;
    if (result.study.gpus.empty()) result.study.gpus = {"neutral"};
    const std::size_t cells = study.points.size() * study.series.size();
    const std::size_t each = result.study.gpus.size();
    result.values.resize(cells * each);
    std::mutex mutex;
    std::size_t done = 0;
    pipeline::parallel_for(options.threads, cells, [&](std::size_t cell) {
        const StudyPoint& point = study.points[cell / study.series.size()];
        const StudySeries& series = study.series[cell % study.series.size()];
        std::vector<StudyValue> values = run_series(study, series, point, result.study.gpus, options);
        std::move(values.begin(), values.end(), result.values.begin() + static_cast<std::ptrdiff_t>(cell * each));
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(cells));
    });
    finish(result);
    return result;
}

} // namespace reports
