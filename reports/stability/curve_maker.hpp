// Curves of right digits.
#pragma once

#include "reports/stability/quad.hpp"
#include "reports/stability/report.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace reports::stability {

/// Decimal digits of `got` that are right, 0 to 17; one of no error has all that a double can have.
inline double right_digits(double got, Quad exact) {
    const double error = relative_error(got, exact);
    if (!(error < 1.0)) return 0.0; // also for what is not a number
    return error == 0.0 ? 17.0 : std::min(17.0, -std::log10(error));
}

struct CurveLine {
    std::string name;
    std::function<double(double input)> digits;
};

/// Inputs from `first` to `last`, evenly in their logarithm; the first line is the program's own function.
inline Curve make_curve(std::string id, std::string formula, std::string guard, std::string input, double first,
                        double last, const std::vector<CurveLine>& lines) {
    constexpr int points = 61;
    Curve curve{std::move(id), std::move(formula), std::move(guard), {}, 0.0, 17.0};
    curve.plot.title = fmt::format("{}: {}", curve.id, curve.formula);
    curve.plot.x_title = std::move(input);
    curve.plot.y_title = "right decimal digits";
    curve.plot.logarithmic = true;
    for (const CurveLine& line : lines) curve.plot.lines.push_back({line.name, {}});
    for (int i = 0; i < points; ++i) {
        const double at = first * std::pow(last / first, static_cast<double>(i) / (points - 1));
        curve.plot.labels.push_back(fmt::format("{:.6g}", at));
        for (std::size_t line = 0; line < lines.size(); ++line)
            curve.plot.lines[line].values.push_back(lines[line].digits(at));
        const double digits = curve.plot.lines[0].values.back();
        if (digits >= curve.fewest_digits && i > 0) continue;
        curve.fewest_digits = digits;
        curve.worst_input = at;
    }
    return curve;
}

} // namespace reports::stability
