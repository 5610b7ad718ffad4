#include "reports/study.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/study_points.hpp"
#include "reports/study_runs.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <mutex>
#include <set>
#include <thread>

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

namespace {

/// Runs the cells of a study, each a series at a point, and puts their values into the result.
class StudyRun {
  public:
    StudyRun(StudyResult& result, const GeometryRunOptions& options, StudyPoints* points)
        : result_(result),
          options_(options),
          points_(points),
          cells_(result.study.points.size() * result.study.series.size()) {
        result.values.resize(cells_ * result.study.gpus.size());
    }

    void run() {
        pipeline::parallel_for(options_.threads, cells_, [this](std::size_t cell) { begin(cell); });
        // Another process is at these: it finishes them, or ends and leaves them.
        for (const Waiting& one : waiting_)
            while (!finish(one)) std::this_thread::sleep_for(std::chrono::milliseconds(100));
        if (points_ != nullptr) points_->forget_others(keys_of_all_);
    }

  private:
    struct Waiting {
        std::size_t cell = 0;
        std::string key;
    };

    const StudySeries& series(std::size_t cell) const {
        return result_.study.series[cell % result_.study.series.size()];
    }
    const StudyPoint& point(std::size_t cell) const { return result_.study.points[cell / result_.study.series.size()]; }

    void begin(std::size_t cell) {
        Waiting one{cell, {}};
        if (points_ != nullptr) {
            one.key = keys_.key_of(result_.study, series(cell), point(cell), result_.study.gpus, options_.fidelity);
            const std::lock_guard lock(mutex_);
            keys_of_all_.insert(one.key);
        }
        if (finish(one)) return;
        const std::lock_guard lock(mutex_);
        waiting_.push_back(std::move(one));
    }

    // False where another process is at it.
    bool finish(const Waiting& one) {
        if (options_.stop != nullptr && *options_.stop) throw sim::Interrupted();
        if (points_ == nullptr) return store(one.cell, compute(one.cell)), true;
        if (found(one)) return true;
        const PointLock lock = points_->lock(one.key);
        if (!lock.held()) return false;
        if (found(one)) return true; // finished just before the lock was had
        std::vector<StudyValue> values = compute(one.cell);
        points_->keep(one.key, values);
        store(one.cell, std::move(values));
        return true;
    }

    bool found(const Waiting& one) {
        auto values = points_->find(one.key);
        if (!values || values->size() != result_.study.gpus.size()) return false;
        store(one.cell, std::move(*values));
        const std::lock_guard lock(mutex_);
        ++result_.found;
        return true;
    }

    std::vector<StudyValue> compute(std::size_t cell) const {
        return run_series(result_.study, series(cell), point(cell), result_.study.gpus, options_);
    }

    void store(std::size_t cell, std::vector<StudyValue> values) {
        std::move(values.begin(), values.end(),
                  result_.values.begin() + static_cast<std::ptrdiff_t>(cell * result_.study.gpus.size()));
        const std::lock_guard lock(mutex_);
        ++done_;
        if (options_.progress) options_.progress(static_cast<double>(done_) / static_cast<double>(cells_));
    }

    StudyResult& result_;
    const GeometryRunOptions& options_;
    StudyPoints* points_;
    StudyKeys keys_;
    std::size_t cells_, done_ = 0;
    std::mutex mutex_;
    std::vector<Waiting> waiting_;
    std::set<std::string> keys_of_all_;
};

} // namespace

StudyResult run_study(const Study& study, const std::vector<std::string>& gpus, const GeometryRunOptions& options,
                      StudyPoints* points) {
    StudyResult result{study, {}, options.fidelity};
    if (study.of_designs() && options.fidelity != Fidelity::detailed)
        throw sim::InputError(fmt::format("study {}: designs are only run in detail", study.name));
    if (!gpus.empty()) result.study.gpus = gpus;
    if (result.study.gpus.empty()) result.study.gpus = {"neutral"};
    StudyRun(result, options, points).run();
    finish(result);
    return result;
}

} // namespace reports
