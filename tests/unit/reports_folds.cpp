// Least squares of logarithms, and rows left out of it.
#include "reports/peeling/calibration.hpp"
#include "reports/validation/folds_report.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

namespace {

using reports::FitProblem;
using reports::FoldProblem;

/// Times that add up, as those of an input port: a row is a list of what it has of each number.
FitProblem sums(std::vector<reports::FitNumber> numbers, std::vector<std::vector<double>> parts,
                const std::vector<double>& truth) {
    FitProblem problem;
    problem.numbers = std::move(numbers);
    problem.model = [parts](const std::vector<std::size_t>& rows, const std::vector<double>& values) {
        std::vector<double> rates;
        for (const std::size_t row : rows) {
            double time = 0.01;
            for (std::size_t i = 0; i < values.size(); ++i) time += parts[row][i] * values[i];
            rates.push_back(1 / time);
        }
        return rates;
    };
    std::vector<std::size_t> all;
    for (std::size_t row = 0; row < parts.size(); ++row) all.push_back(row);
    problem.published = problem.model(all, truth);
    return problem;
}

std::vector<std::size_t> first(std::size_t count) {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < count; ++row) rows.push_back(row);
    return rows;
}

FoldProblem fold_problem(const FitProblem& fit) {
    FoldProblem problem;
    problem.gpu = "g";
    problem.fit = fit;
    for (std::size_t row = 0; row < fit.published.size(); ++row) {
        reports::ValidationRow one;
        one.table = "T";
        one.row = std::to_string(row);
        one.gpu = "g";
        one.low = one.high = fit.published[row];
        one.sigma = 0.01;
        problem.rows.push_back(one);
        problem.held_in.push_back(false);
    }
    return problem;
}

} // namespace

TEST(LeastSquares, FindsNumbersOverSixDecadesThatExplainEveryRow) {
    const std::vector<double> truth{0.9, 2e-4, 37.0};
    const FitProblem problem = sums({{"a", 0.01, 20}, {"b", 0, 1}, {"c", 0, 5000}},
                                    {{1, 0, 0}, {1, 3000, 0}, {2, 1000, 0}, {1, 0, 1}, {3, 500, 2}}, truth);
    const auto fit = reports::least_squares(problem, reports::fit_pattern(problem), first(5));
    for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(fit.values[i] / truth[i], 1, 1e-3) << i;
    EXPECT_LT(fit.rms, 1e-4);
}

TEST(LeastSquares, DividesWhatNoNumberCanMeetAmongTheRows) {
    FitProblem problem = sums({{"a", 0.01, 20}}, {{100}, {100}}, {1});
    problem.published[0] *= 1.1;
    problem.published[1] /= 1.1;
    const auto fit = reports::least_squares(problem, reports::fit_pattern(problem), first(2));
    EXPECT_NEAR(fit.values[0], 1, 1e-3);
    EXPECT_NEAR(fit.rms, std::log(1.1), 1e-4);
}

TEST(LeastSquares, ANumberWithoutARowStaysInTheMiddleOfItsBounds) {
    const FitProblem problem = sums({{"a", 0.1, 10}, {"b", 0.01, 4}}, {{1, 0}, {2, 0}}, {3, 1});
    const auto pattern = reports::fit_pattern(problem);
    EXPECT_TRUE(pattern[0][0]);
    EXPECT_FALSE(pattern[0][1]);
    const auto fit = reports::least_squares(problem, pattern, first(2));
    EXPECT_NEAR(fit.values[0], 3, 3e-3);
    EXPECT_NEAR(fit.values[1], 0.2, 1e-12);
}

TEST(LeastSquares, WhatOtherGradientsCannotGive) {
    std::vector<double> outside;
    EXPECT_NEAR(reports::share_outside({1, 1, 0}, {{1, 0, 0}, {0, 5, 0}}, outside), 0, 1e-12);
    EXPECT_NEAR(reports::share_outside({0, 0, 2}, {{1, 0, 0}, {0, 5, 0}}, outside), 1, 1e-12);
    EXPECT_NEAR(outside[2], 2, 1e-12);
    EXPECT_NEAR(reports::share_outside({3, 0, 4}, {{1, 0, 0}}, outside), 0.8, 1e-12);
    EXPECT_NEAR(reports::share_outside({1, -1}, {{1, 1}, {2, 2}}, outside), 1, 1e-12); // twice the same is one
    EXPECT_EQ(reports::share_outside({0, 0}, {}, outside), 0);
    EXPECT_EQ(reports::share_outside({1, 0}, {}, outside), 1);
}

TEST(Folds, EveryRowIsLeftOutOnceAndWhatNothingElseDeterminesIsNamed) {
    const FitProblem fit = sums({{"a", 0.01, 20}, {"b", 0.01, 100}}, {{1, 0}, {2, 0}, {4, 0}, {8, 0}, {1, 1}}, {1, 10});
    const auto folds = reports::cross_validate(fold_problem(fit), 5, 7, 1);
    std::set<std::string> left_out;
    for (const auto& held : folds.rows) {
        EXPECT_TRUE(left_out.insert(held.row.key()).second);
        if (held.row.key() == "T 4") {
            EXPECT_EQ(held.undetermined, std::vector<std::string>{"b"});
        } else {
            EXPECT_TRUE(held.testable()) << held.row.key();
            EXPECT_NEAR(held.row.log_error(), 0, 1e-3);
        }
    }
    EXPECT_EQ(left_out.size(), 5U);
    EXPECT_EQ(folds.held_out.rows, 4U);
    EXPECT_EQ(folds.folds.size(), 5U);
    const std::string text = reports::folds_text({folds}, {});
    EXPECT_NE(text.find("not testable: nothing else determines b"), std::string::npos) << text;
    EXPECT_EQ(reports::folds_json({folds}).at("gpus").at(0).at("not_testable").at(0), "T 4");
}

// A row that lies off by 20% is seen to do so when it is left out, and only then.
TEST(Folds, AnOutlierShowsWhenItIsLeftOut) {
    FitProblem fit = sums({{"a", 0.01, 20}}, {{1}, {2}, {4}, {8}}, {1});
    fit.published[2] *= 1.2;
    const auto folds = reports::cross_validate(fold_problem(fit), 4, 1, 1);
    for (const auto& held : folds.rows)
        if (held.row.key() == "T 2") {
            EXPECT_NEAR(held.row.log_error(), -std::log(1.2), 2e-3);
        }
    EXPECT_LT(folds.whole.rms, std::log(1.2) / 2);
    EXPECT_NEAR(folds.held_out.worst, std::log(1.2), 2e-3);
}

TEST(Folds, TheSeedAloneDecidesWhichRowIsInWhichFoldAndFixedRowsAreInNone) {
    const FitProblem fit = sums({{"a", 0.01, 20}}, {{1}, {2}, {3}, {4}, {5}, {6}, {7}, {8}}, {1});
    FoldProblem problem = fold_problem(fit);
    problem.held_in[3] = true;
    const auto left_out = [&problem](std::uint64_t seed, unsigned threads) {
        std::vector<std::vector<std::string>> rows;
        for (const auto& fold : reports::cross_validate(problem, 3, seed, threads).folds) rows.push_back(fold.left_out);
        return rows;
    };
    EXPECT_EQ(left_out(1, 1), left_out(1, 2));
    EXPECT_NE(left_out(1, 1), left_out(2, 1));
    std::size_t rows = 0;
    for (const auto& fold : left_out(1, 1)) {
        rows += fold.size();
        EXPECT_EQ(std::count(fold.begin(), fold.end(), "T 3"), 0);
        EXPECT_GE(fold.size(), 2U);
    }
    EXPECT_EQ(rows, 7U);
    EXPECT_EQ(reports::cross_validate(problem, 100, 1, 1).folds.size(), 7U); // one a row
}

TEST(Calibration, SecantsOfLogarithmsSolveWhatIsCloseToAPower) {
    const auto grows = [](double x) { return 3 + 2 * x; };
    const auto up = reports::solve_power(grows, 23, 1, 0.01, 100);
    EXPECT_TRUE(up.met);
    EXPECT_NEAR(up.value, 10, 0.01);
    const auto falls = [](double x) { return 0.5 + 40 / x; };
    const auto down = reports::solve_power(falls, 4.5, 0.3, 0.01, 100);
    EXPECT_TRUE(down.met);
    EXPECT_NEAR(down.value, 10, 0.01);
    EXPECT_FALSE(reports::solve_power(grows, 2, 1, 0.01, 100).met); // below what any number takes
    const auto bound = reports::solve_power(grows, 1000, 1, 0.01, 100);
    EXPECT_FALSE(bound.met);
    EXPECT_NEAR(bound.value, 100, 1e-6);
    EXPECT_FALSE(reports::solve_power([](double) { return 1.0; }, 2, 1, 0.01, 100).met);       // does not depend
    EXPECT_EQ(reports::solve_power(grows, 23, 10, 0.01, 100).value, std::exp(std::log(10.0))); // one run
}
