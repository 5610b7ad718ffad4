// Held-out errors: a card's numbers are fitted to some of its rows, and the rows left out say how well that predicts.
#pragma once

#include "reports/validation/least_squares.hpp"
#include "reports/validation/validation_row.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace reports {

struct FoldProblem {
    std::string gpu;
    FitProblem fit;
    std::vector<ValidationRow> rows; ///< of fit.published
    std::vector<bool> held_in;       ///< a row that no fold may leave out: something was chosen with it in view
};

/// A row that a fold left out.
struct HeldOutRow {
    ValidationRow
        row; ///< model: with the numbers that the other rows gave; null_model: the geometric mean of those rows
    unsigned fold = 0; ///< from 1
    /// Numbers that no row of the fold determines and that this one depends on: the row is not testable.
    std::vector<std::string> undetermined;

    bool testable() const { return undetermined.empty(); }
};

struct FoldFit {
    std::vector<std::string> left_out; ///< rows
    std::map<std::string, double> values;
    double rms = 0; ///< of the rows that were fitted
};

struct GpuFolds {
    std::string gpu;
    std::uint64_t seed = 1;
    FoldFit whole; ///< of all rows
    std::vector<FoldFit> folds;
    std::vector<HeldOutRow> rows;     ///< fold by fold
    std::vector<std::string> held_in; ///< rows that were in every fit
    ErrorSpread held_out;             ///< of the testable rows
};

/// Splits the rows that may be left out into as many folds as asked for, or one a row where they are fewer, by the
/// seed.
/// @param folds at least 2
GpuFolds cross_validate(const FoldProblem& problem, unsigned folds, std::uint64_t seed, unsigned threads);

} // namespace reports
