#include "reports/validation/folds.hpp"

#include "pipeline/functional/parallel.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reports {

namespace {

using RowList = std::vector<std::size_t>;

/// A row whose gradient lies outside what the others span by more than this is not testable.
constexpr double outside_share = 0.1;
/// Of what lies outside, the numbers named have at least this share.
constexpr double named_share = 0.5;

std::vector<RowList> folds_of(const FoldProblem& problem, unsigned folds, std::uint64_t seed) {
    RowList rows;
    for (std::size_t row = 0; row < problem.rows.size(); ++row)
        if (!problem.held_in[row]) rows.push_back(row);
    sim::Random random(seed, "folds of " + problem.gpu);
    for (std::size_t i = rows.size(); i > 1; --i) std::swap(rows[i - 1], rows[random.below(i)]);
    std::vector<RowList> parts(std::min<std::size_t>(folds, rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) parts[i % parts.size()].push_back(rows[i]);
    for (RowList& part : parts) std::sort(part.begin(), part.end());
    return parts;
}

RowList all_but(const FoldProblem& problem, const RowList& left_out) {
    RowList rows;
    for (std::size_t row = 0; row < problem.rows.size(); ++row)
        if (std::find(left_out.begin(), left_out.end(), row) == left_out.end()) rows.push_back(row);
    return rows;
}

FoldFit fold_fit(const FoldProblem& problem, const RowList& left_out, const Fit& fit) {
    FoldFit result;
    for (const std::size_t row : left_out) result.left_out.push_back(problem.rows[row].key());
    for (std::size_t i = 0; i < fit.values.size(); ++i) result.values[problem.fit.numbers[i].name] = fit.values[i];
    result.rms = fit.rms;
    return result;
}

std::vector<std::string> undetermined(const FoldProblem& problem, const std::vector<std::vector<double>>& gradients,
                                      std::size_t row, const RowList& training) {
    std::vector<std::vector<double>> others;
    for (const std::size_t other : training) others.push_back(gradients[other]);
    std::vector<double> outside;
    if (share_outside(gradients[row], others, outside) <= outside_share) return {};
    double largest = 0;
    for (const double part : outside) largest = std::max(largest, std::abs(part));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < outside.size(); ++i)
        if (std::abs(outside[i]) >= named_share * largest) names.push_back(problem.fit.numbers[i].name);
    return names;
}

double mean_rate(const FoldProblem& problem, const RowList& rows) {
    double sum = 0;
    for (const std::size_t row : rows) sum += std::log(problem.fit.published[row]);
    return std::exp(sum / static_cast<double>(rows.size()));
}

} // namespace

GpuFolds cross_validate(const FoldProblem& problem, unsigned folds, std::uint64_t seed, unsigned threads) {
    CHECK(folds >= 2 && problem.rows.size() == problem.fit.published.size());
    CHECK(problem.held_in.size() == problem.rows.size());
    const FitPattern pattern = fit_pattern(problem.fit);
    const std::vector<RowList> parts = folds_of(problem, folds, seed);
    std::vector<Fit> fits(parts.size() + 1); // the last one of all rows
    pipeline::parallel_for(threads, fits.size(), [&](std::size_t i) {
        fits[i] = least_squares(problem.fit, pattern, all_but(problem, i < parts.size() ? parts[i] : RowList{}));
    });
    std::vector<std::vector<double>> gradients(problem.rows.size());
    pipeline::parallel_for(threads, gradients.size(), [&](std::size_t row) {
        gradients[row] = fit_gradient(problem.fit, pattern, row, fits.back().values);
    });

    GpuFolds result;
    result.gpu = problem.gpu;
    result.seed = seed;
    result.whole = fold_fit(problem, {}, fits.back());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        result.folds.push_back(fold_fit(problem, parts[i], fits[i]));
        const RowList training = all_but(problem, parts[i]);
        const std::vector<double> model = problem.fit.model(parts[i], fits[i].values);
        for (std::size_t j = 0; j < parts[i].size(); ++j) {
            HeldOutRow held{problem.rows[parts[i][j]], static_cast<unsigned>(i + 1),
                            undetermined(problem, gradients, parts[i][j], training)};
            held.row.model = model[j];
            held.row.null_model = mean_rate(problem, training);
            result.rows.push_back(std::move(held));
        }
    }
    for (std::size_t row = 0; row < problem.rows.size(); ++row)
        if (problem.held_in[row]) result.held_in.push_back(problem.rows[row].key());
    std::vector<const ValidationRow*> testable;
    for (const HeldOutRow& held : result.rows)
        if (held.testable()) testable.push_back(&held.row);
    result.held_out = error_spread(problem.gpu, testable);
    return result;
}

} // namespace reports
