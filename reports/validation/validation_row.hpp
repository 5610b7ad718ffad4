// A published number beside the model, and the errors of many.
//
// The error is the natural logarithm of model over published: as large for half as for twice, and signed. Half a unit
// of the last printed digit over the number is its sigma.
#pragma once

#include "sim/field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reports {

/// Where a published number comes from.
enum class PublishedOrigin : std::uint8_t {
    measured, ///< printed in a table
    stated,   ///< in words
    derived   ///< from numbers that were printed, or from words
};

enum class RowStatus : std::uint8_t {
    calibrated, ///< a number of the GPU was fitted to this row, or a constant or stand-in was chosen with it in view
    predicted,  ///< a printed number that decided nothing; only these are counted
    penalty,    ///< a driver artefact whose size this row states
    not_modelled,
    derived ///< a quotient or repetition of printed numbers, or a statement in words: listed, not counted
};

/// A printed number counts as sharp where its sigma is at most this.
constexpr double sharp_sigma = 0.05;
/// A miss whose ratio, or one over it, lies above 1 + this asks for an explanation.
constexpr double large_miss = 0.25;

struct ValidationRow {
    std::string table, row, gpu;
    std::string unit = "frames/s";
    double low = 0, high = 0; ///< between which a statement lies; equal where a number was published
    double sigma = 0;         ///< of the logarithm of a printed number; of a quotient, of both; 0: of a statement
    double model = 0;
    double null_model = 0; ///< what the null model says; 0: nothing
    RowStatus status = RowStatus::predicted;
    PublishedOrigin origin = PublishedOrigin::measured;
    std::string source;      ///< of a number that was not measured
    std::string parameter;   ///< that the row decides, or that decides it; or what was chosen with it in view
    std::string limit;       ///< what limits the model
    std::string explanation; ///< of a large miss, by mechanism; "" when there is none
    double acmr = 0;
    double host_seconds = 0;

    std::string key() const { return table + " " + row; }
    /// The number; of an interval, what is nearest to the model.
    double published() const { return std::clamp(model, low, high); }
    double ratio() const { return model / published(); }
    /// ln(model / published)
    double log_error() const { return std::log(ratio()); }
    double null_log_error() const { return std::log(null_model / published()); }
    /// The error over sigma; 0 where there is no sigma.
    double error_in_sigma() const { return sigma > 0 ? log_error() / sigma : 0; }
    bool sharp() const { return sigma > 0 && sigma <= sharp_sigma; }
    bool missed() const { return std::abs(log_error()) > std::log(1 + large_miss); }
};

/// Errors of some rows, in natural logarithms; 0 without rows.
struct ErrorSpread {
    std::size_t rows = 0;
    double median = 0; ///< of |error|
    double rms = 0;
    double mean = 0;  ///< signed: whether they lie on one side
    double worst = 0; ///< |error|
    std::string worst_row;
    std::optional<double> null_rms; ///< of the null model, where it says something of every one of these rows

    /// 1 - RMS of the model over that of the null model: 1 is perfect, 0 no better than the null model.
    std::optional<double> skill() const;
};

struct ErrorSummary {
    std::string gpu;       ///< "all" for all of them
    ErrorSpread predicted; ///< every predicted row
    ErrorSpread sharp;     ///< those among them whose sigma is at most sharp_sigma
    ErrorSpread fitted;    ///< calibrated rows, which say how well the fit holds and nothing else
};

/// @param gpu names rows of "all" with theirs
ErrorSpread error_spread(const std::string& gpu, const std::vector<const ValidationRow*>& rows);

/// Per GPU, in the order in which they occur, and of all.
std::vector<ErrorSummary> summarise(const std::vector<ValidationRow>& rows);

/// The middle one, or the mean of the middle two; 0 of none.
double median_of(std::vector<double> values);

} // namespace reports

template <>
struct sim::EnumNames<reports::PublishedOrigin> {
    static constexpr std::array<std::string_view, 3> names{"measured", "stated", "derived"};
};
template <>
struct sim::EnumNames<reports::RowStatus> {
    static constexpr std::array<std::string_view, 5> names{"calibrated", "predicted", "penalty", "not-modelled",
                                                           "derived"};
};
