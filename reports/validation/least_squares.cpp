#include "reports/validation/least_squares.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace reports {

namespace {

using Vector = std::vector<double>;

constexpr double least_share = 1e-6;       ///< of its upper bound: below, a number that adds time adds nothing
constexpr double moves = 1e-4;             ///< a row that moves by less than this between the bounds does not depend
constexpr double gradient_step = 0.01;     ///< of a logarithm
constexpr unsigned grid_points = 11;       ///< points of a search along one number
constexpr unsigned narrowings = 8;         ///< halvings of the step behind the grid
constexpr unsigned sweeps = 2;             ///< over all numbers, before the steps of Gauss and Newton
constexpr unsigned most_newton_steps = 12; ///< of these
constexpr double small_gain = 1e-5;        ///< of the sum of squares, at which they end
constexpr double same_direction = 1e-2;    ///< share of a gradient that counts as none

double dot(const Vector& a, const Vector& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

double squares_of(const Vector& values) { return dot(values, values); }

double lower_bound_of(const FitNumber& number) { return std::max(number.low, number.high * least_share); }

/// Solves a symmetric positive definite system by Gauss's elimination; its size is that of the numbers of a card.
Vector solved(std::vector<Vector> matrix, Vector right) {
    const std::size_t size = right.size();
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t row = i + 1; row < size; ++row) {
            const double factor = matrix[row][i] / matrix[i][i];
            for (std::size_t column = i; column < size; ++column) matrix[row][column] -= factor * matrix[i][column];
            right[row] -= factor * right[i];
        }
    for (std::size_t i = size; i-- > 0;) {
        for (std::size_t column = i + 1; column < size; ++column) right[i] -= matrix[i][column] * right[column];
        right[i] /= matrix[i][i];
    }
    return right;
}

/// One fit: its rows, the errors at the present values, and the two ways to lower them.
class Fitting {
  public:
    Fitting(const FitProblem& problem, const FitPattern& pattern, const std::vector<std::size_t>& rows)
        : problem_(problem), rows_(rows) {
        for (const FitNumber& number : problem.numbers)
            values_.push_back(std::sqrt(lower_bound_of(number) * number.high));
        by_number_.resize(problem.numbers.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t number = 0; number < problem.numbers.size(); ++number)
                if (pattern[rows[i]][number]) by_number_[number].push_back(i);
        for (std::size_t number = 0; number < by_number_.size(); ++number)
            if (!by_number_[number].empty()) free_.push_back(number);
        std::vector<std::size_t> all(rows.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        errors_ = errors(all, values_);
    }

    Fit run() {
        for (unsigned sweep = 0; sweep < sweeps; ++sweep)
            for (const std::size_t number : free_) search_along(number);
        double damping = 1e-3;
        for (unsigned step = 0; step < most_newton_steps && !free_.empty(); ++step) {
            const double before = squares_of(errors_);
            if (!gauss_newton(damping) || before - squares_of(errors_) < small_gain * before) break;
        }
        return {values_, rows_.empty() ? 0 : std::sqrt(squares_of(errors_) / static_cast<double>(rows_.size()))};
    }

  private:
    /// Errors of some of the rows, by their places in rows_.
    Vector errors(const std::vector<std::size_t>& places, const Vector& values) const {
        std::vector<std::size_t> rows;
        for (const std::size_t place : places) rows.push_back(rows_[place]);
        Vector result = problem_.model(rows, values);
        CHECK(result.size() == rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) result[i] = std::log(result[i] / problem_.published[rows[i]]);
        return result;
    }

    Vector errors_with(std::size_t number, double logarithm) const {
        Vector values = values_;
        values[number] = std::exp(logarithm);
        return errors(by_number_[number], values);
    }

    void take(std::size_t number, double logarithm, const Vector& found) {
        values_[number] = std::exp(logarithm);
        for (std::size_t i = 0; i < found.size(); ++i) errors_[by_number_[number][i]] = found[i];
    }

    void search_along(std::size_t number) {
        const FitNumber& bounds = problem_.numbers[number];
        const double low = std::log(lower_bound_of(bounds)), width = std::log(bounds.high) - low;
        double best = std::log(values_[number]), half = width / (grid_points - 1);
        Vector best_errors = errors_with(number, best);
        const auto try_at = [&](double logarithm) {
            Vector found = errors_with(number, logarithm);
            if (squares_of(found) >= squares_of(best_errors)) return;
            best = logarithm;
            best_errors = std::move(found);
        };
        for (unsigned i = 0; i < grid_points; ++i) try_at(low + width * i / (grid_points - 1));
        for (unsigned i = 0; i < narrowings; ++i) {
            half *= 0.5;
            const double middle = best;
            try_at(std::max(low, middle - half));
            try_at(std::min(low + width, middle + half));
        }
        take(number, best, best_errors);
    }

    /// One damped step that lowers the sum of squares; false when none does.
    bool gauss_newton(double& damping) {
        std::vector<Vector> slopes; // [free number][row], 0 where it has no part
        for (const std::size_t number : free_) {
            const Vector moved = errors_with(number, std::log(values_[number]) + gradient_step);
            Vector slope(rows_.size(), 0.0);
            for (std::size_t i = 0; i < moved.size(); ++i) {
                const std::size_t place = by_number_[number][i];
                slope[place] = (moved[i] - errors_[place]) / gradient_step;
            }
            slopes.push_back(std::move(slope));
        }
        constexpr unsigned tries = 6;
        for (unsigned i = 0; i < tries; ++i, damping *= 10)
            if (step_with(slopes, damping)) {
                damping /= 10;
                return true;
            }
        return false;
    }

    bool step_with(const std::vector<Vector>& slopes, double damping) {
        const std::size_t size = free_.size();
        std::vector<Vector> matrix(size, Vector(size, 0.0));
        Vector right(size, 0.0);
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t j = 0; j < size; ++j) matrix[i][j] = dot(slopes[i], slopes[j]);
            matrix[i][i] = matrix[i][i] * (1 + damping) + 1e-9;
            right[i] = -dot(slopes[i], errors_);
        }
        const Vector step = solved(std::move(matrix), std::move(right));
        Vector values = values_;
        for (std::size_t i = 0; i < size; ++i) {
            const FitNumber& bounds = problem_.numbers[free_[i]];
            const double moved = values_[free_[i]] * std::exp(std::clamp(step[i], -2.0, 2.0));
            values[free_[i]] = std::clamp(moved, lower_bound_of(bounds), bounds.high);
        }
        std::vector<std::size_t> all(rows_.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        Vector found = errors(all, values);
        if (squares_of(found) >= squares_of(errors_)) return false;
        values_ = std::move(values);
        errors_ = std::move(found);
        return true;
    }

    const FitProblem& problem_;
    std::vector<std::size_t> rows_;
    Vector values_, errors_;
    std::vector<std::vector<std::size_t>> by_number_; ///< places in rows_ of the rows that a number moves
    std::vector<std::size_t> free_;                   ///< numbers that move any row
};

} // namespace

FitPattern fit_pattern(const FitProblem& problem) {
    const std::size_t count = problem.published.size();
    FitPattern pattern(count, std::vector<bool>(problem.numbers.size(), false));
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    Vector middle;
    for (const FitNumber& number : problem.numbers) middle.push_back(std::sqrt(lower_bound_of(number) * number.high));
    for (std::size_t number = 0; number < middle.size(); ++number) {
        Vector values = middle;
        values[number] = lower_bound_of(problem.numbers[number]);
        const Vector low = problem.model(all, values);
        values[number] = problem.numbers[number].high;
        const Vector high = problem.model(all, values);
        for (std::size_t row = 0; row < count; ++row)
            pattern[row][number] = std::abs(std::log(low[row] / high[row])) > moves;
    }
    return pattern;
}

Fit least_squares(const FitProblem& problem, const FitPattern& pattern, const std::vector<std::size_t>& rows) {
    return Fitting(problem, pattern, rows).run();
}

std::vector<double> fit_gradient(const FitProblem& problem, const FitPattern& pattern, std::size_t row,
                                 const std::vector<double>& values) {
    Vector gradient(problem.numbers.size(), 0.0);
    for (std::size_t number = 0; number < gradient.size(); ++number) {
        if (!pattern[row][number]) continue;
        Vector less = values, more = values;
        less[number] *= std::exp(-gradient_step);
        more[number] *= std::exp(gradient_step);
        gradient[number] = std::log(problem.model({row}, more)[0] / problem.model({row}, less)[0]) / 2 / gradient_step;
    }
    return gradient;
}

double share_outside(const std::vector<double>& gradient, const std::vector<std::vector<double>>& others,
                     std::vector<double>& outside) {
    outside = gradient;
    const double length = std::sqrt(squares_of(gradient));
    if (length <= 0) return 0;
    std::vector<Vector> basis; // orthonormal, of what the others span
    for (const Vector& other : others) {
        const double whole = squares_of(other);
        Vector left = other;
        for (unsigned twice = 0; twice < 2; ++twice) // once is not orthogonal enough where directions are alike
            for (const Vector& one : basis) {
                const double part = dot(left, one);
                for (std::size_t i = 0; i < left.size(); ++i) left[i] -= part * one[i];
            }
        const double rest = std::sqrt(squares_of(left));
        if (rest <= same_direction * std::sqrt(whole) || rest <= 0) continue;
        for (double& value : left) value /= rest;
        const double part = dot(outside, left);
        for (std::size_t i = 0; i < outside.size(); ++i) outside[i] -= part * left[i];
        basis.push_back(std::move(left));
    }
    return std::sqrt(squares_of(outside)) / length;
}

} // namespace reports
