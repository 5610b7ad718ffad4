#include "reports/peeling/folds.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/geometry/solver.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace reports {

namespace {

constexpr double widest = 2; ///< times the value in the file, and one over it
constexpr double without_part = 1e-3;

/// ln(time) of one row over ln(number / file value) of each number.
struct RowTime {
    double at_file = 0;
    struct Bend {
        double slope = 0, curvature = 0;
    };
    std::vector<Bend> bends;

    double operator()(const std::vector<double>& logarithms) const {
        double sum = at_file;
        for (std::size_t i = 0; i < bends.size(); ++i)
            sum += (bends[i].slope + bends[i].curvature * logarithms[i]) * logarithms[i];
        return sum;
    }
};

struct FoldRow {
    PeelingStep number; ///< of the table
    ValidationRow row;
    bool held_in = false;
    RowTime time;
};

std::vector<FoldRow> fold_rows(const PublishedPeeling& published) {
    std::vector<FoldRow> rows;
    for (const PeelingMeasurement& measured : published.rows)
        for (const PeelingColumn column : {PeelingColumn::mp, PeelingColumn::sp}) {
            ValidationRow row = published_peeling_row(published, measured, column);
            if (row.status == RowStatus::derived) continue; // the same number again
            FoldRow one;
            one.number.dataset = measured.dataset;
            one.number.buffer = measured.buffer;
            one.number.column = column;
            one.held_in = std::any_of(published.choices.begin(), published.choices.end(),
                                      [&row](const Choice& choice) { return choice.concerns(row); });
            one.row = std::move(row);
            rows.push_back(std::move(one));
        }
    return rows;
}

void measure_row(FoldRow& row, const PublishedPeeling& published, const Values& in_file,
                 const PeelingOptions& options) {
    const auto time = [&](const Values& values, bool smallest) {
        return std::log(peeling_milliseconds(published, row.number, values, options, smallest));
    };
    row.time.at_file = time(in_file, false);
    const double smallest = time(in_file, true);
    for (const PeelingStep& step : published.calibrated) {
        Values less = in_file, more = in_file;
        less[step.parameter] /= widest;
        more[step.parameter] *= widest;
        row.time.bends.emplace_back();
        const bool has_part = std::abs(time(less, true) - smallest) > without_part ||
                              std::abs(time(more, true) - smallest) > without_part;
        if (!has_part) continue;
        const double low = time(less, false) - row.time.at_file, high = time(more, false) - row.time.at_file;
        const double width = std::log(widest);
        row.time.bends.back() = {(high - low) / 2 / width, (high + low) / 2 / width / width};
    }
}

} // namespace

GpuFolds fold_peeling(const PublishedPeeling& published, unsigned folds, std::uint64_t seed,
                      const PeelingOptions& options) {
    const pipeline::GpuParams params = gpu_params(published.gpu);
    Values in_file;
    FoldProblem problem;
    problem.gpu = published.gpu;
    for (const PeelingStep& step : published.calibrated) {
        const double value = in_file[step.parameter] = value_of(params, step.parameter);
        problem.fit.numbers.push_back({step.parameter, value / widest, value * widest});
    }
    std::vector<FoldRow> rows = fold_rows(published);
    PeelingOptions alone = options;
    alone.threads = 1;
    std::size_t done = 0;
    std::mutex mutex;
    pipeline::parallel_for(options.threads, rows.size(), [&](std::size_t i) {
        measure_row(rows[i], published, in_file, alone);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(rows.size()));
    });
    for (const FoldRow& row : rows) {
        problem.rows.push_back(row.row);
        problem.held_in.push_back(row.held_in);
        problem.fit.published.push_back(row.row.low);
    }
    problem.fit.model = [&](const std::vector<std::size_t>& wanted, const std::vector<double>& values) {
        std::vector<double> logarithms, rates;
        for (std::size_t i = 0; i < values.size(); ++i)
            logarithms.push_back(std::log(values[i] / in_file.at(published.calibrated[i].parameter)));
        for (const std::size_t row : wanted) rates.push_back(1e3 / std::exp(rows[row].time(logarithms)));
        return rates;
    };
    return cross_validate(problem, folds, seed, 1);
}

} // namespace reports
