// Numbers of a model that fit many published rows at once: least squares of ln(model / published).
//
// Every number is looked for as its logarithm, between bounds. A search along each number in turn finds the valley,
// Gauss-Newton steps with Levenberg's damping the bottom. The start is the same whatever was published, so that rows
// that were left out have no part in what is found.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace reports {

struct FitNumber {
    std::string name;
    double low = 0, high = 0; ///< above 0
};

struct FitProblem {
    std::vector<FitNumber> numbers;
    std::vector<double> published; ///< of each row
    /// The model of some rows with these values of the numbers; both above 0. Called by several threads at once.
    std::function<std::vector<double>(const std::vector<std::size_t>& rows, const std::vector<double>& values)> model;
};

/// Which numbers have a part in which rows: [row][number], true where the model moves between the bounds.
using FitPattern = std::vector<std::vector<bool>>;
FitPattern fit_pattern(const FitProblem& problem);

struct Fit {
    std::vector<double> values; ///< of a number that no row moves: the geometric middle of its bounds
    double rms = 0;             ///< of the errors of the rows that were fitted
};

/// Fits the numbers to `rows`.
Fit least_squares(const FitProblem& problem, const FitPattern& pattern, const std::vector<std::size_t>& rows);

/// d ln(model) / d ln(number) of a row, by number.
std::vector<double> fit_gradient(const FitProblem& problem, const FitPattern& pattern, std::size_t row,
                                 const std::vector<double>& values);

/// Share of a gradient that no combination of `others` gives, 0 to 1; 0 of a gradient of zeros. `outside` gets what is
/// left of it.
double share_outside(const std::vector<double>& gradient, const std::vector<std::vector<double>>& others,
                     std::vector<double>& outside);

} // namespace reports
