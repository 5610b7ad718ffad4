// What was published of curves of geometry feed: a number or an interval that is read off a curve of a study.
//
// A figure of which only the text survives still says where it is highest, whether it falls, how large a ratio is. Each
// such statement is an entry of reports/published/figures.toml, and the model's curve is read in the same way.
#pragma once

#include "reports/geometry/validation.hpp"
#include "reports/study.hpp"

#include <map>
#include <string>
#include <vector>

namespace reports {

/// What of a curve is a number.
enum class CurveReading : std::uint8_t {
    value,           ///< of its only point
    argmax,          ///< where it is highest
    least,           ///< value of all
    first_over_last, ///< point
    least_growth,    ///< from a point to the next, as a ratio
    greatest_growth
};

/// Bounds that were published; equal ones state a number.
struct PublishedInterval {
    double low = 0, high = 0;
};

/// The values of a series of a study at some of its points, or their ratios to those of another series.
struct StudyCurve {
    std::string study, series;
    std::string over; ///< series; "" for none
    std::string measure;
    std::vector<std::string> points; ///< by x; all of the study where the file names none
};

struct PublishedFigure {
    std::string table, row; ///< "F3.2", "best number of draw calls"
    StudyCurve curve;
    CurveReading reading = CurveReading::value;
    std::string unit; ///< of the number
    PublishedOrigin origin = PublishedOrigin::derived;
    std::string source; ///< from what
    std::map<std::string, PublishedInterval> by_gpu;
    std::map<std::string, std::string> explanations; ///< of a large miss, by GPU: by what mechanism

    std::string key() const { return table + " " + row; }
};

/// Throws sim::InputError naming file and place when it is not as expected.
std::vector<PublishedFigure> load_published_figures();

/// @param x of the points, as numbers
double read_curve(CurveReading reading, const std::vector<double>& x, const std::vector<double>& y);

/// One row per figure and GPU, of `gpus` alone.
std::vector<ValidationRow> validate_figures(const std::vector<PublishedFigure>& figures, const CalibrationPlan& plan,
                                            const std::vector<std::string>& gpus, const GeometryRunOptions& options);

} // namespace reports

template <>
struct sim::EnumNames<reports::CurveReading> {
    static constexpr std::array<std::string_view, 6> names{"value",           "argmax",       "least",
                                                           "first_over_last", "least_growth", "greatest_growth"};
};
