#include "reports/geometry/solver.hpp"

#include "sim/described_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace reports {

namespace {

constexpr double close_enough = 2e-4; ///< of a row's time
constexpr int most_steps = 60;

/// An interval at whose ends the row misses its time on different sides.
struct Bracket {
    double low = 0, low_miss = 0, high = 0, high_miss = 0;

    bool holds_a_root() const { return (low_miss > 0) != (high_miss > 0); }
    void narrow(double value, double miss) {
        if ((miss > 0) == (low_miss > 0))
            low = value, low_miss = miss;
        else
            high = value, high_miss = miss;
    }
    // Rates act by their reciprocal, so the interpolation is in that where both ends allow it. Every third step halves
    // the interval, so that a bend cannot hold one end fast.
    double next(int step) const {
        const bool rate = low > 0;
        const auto turned = [rate](double value) { return rate ? 1 / value : value; };
        const double part = step % 3 == 2 ? 0.5 : std::clamp(low_miss / (low_miss - high_miss), 0.001, 0.999);
        return turned(turned(low) + (turned(high) - turned(low)) * part);
    }
};

} // namespace

double value_of(const pipeline::GpuParams& params, const std::string& path) {
    const nlohmann::ordered_json json = sim::to_json(params);
    std::string pointer = "/" + path;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    return json.at(nlohmann::ordered_json::json_pointer(pointer)).get<double>();
}

const pipeline::Frame& RowFrames::of(const std::string& row) {
    const std::lock_guard lock(mutex_);
    auto& frame = frames_[row];
    if (frame == nullptr) frame = prepare_frame(find_row(*rows_, row).experiment, measure_with_).frame;
    return *frame;
}

double Solver::milliseconds(const std::string& rows, const Values& values) const {
    double sign = 1, sum = 0;
    for (const std::string& row : rows_in(rows)) {
        const auto result =
            run_geometry(gpu_params(gpu_, values), frames_->of(row), options_->fidelity, options_->stop);
        sum += sign * result.milliseconds;
        sign = -1;
    }
    return sum;
}

double Solver::wanted(const std::string& rows) const {
    double sign = 1, sum = 0;
    for (const std::string& row : rows_in(rows)) {
        sum += sign * 1000 / find_row(*rows_, row).fps.at(gpu_).value;
        sign = -1;
    }
    return sum;
}

double Solver::miss(const CalibrationStep& step, double value, Values& values) const {
    values[step.parameter] = value;
    return milliseconds(step.row, values) / wanted(step.row) - 1;
}

bool Solver::solve(const CalibrationStep& step, Values& values) const {
    double value = std::clamp(values.at(step.parameter), step.low, step.high);
    double error = miss(step, value, values);
    if (std::abs(error) < close_enough) return true;
    Bracket bracket{step.low, miss(step, step.low, values), step.high, miss(step, step.high, values)};
    if (!bracket.holds_a_root()) {
        values[step.parameter] = std::abs(bracket.low_miss) < std::abs(bracket.high_miss) ? step.low : step.high;
        return false;
    }
    for (int i = 0; i < most_steps && std::abs(error) >= close_enough; ++i) {
        bracket.narrow(value, error);
        value = bracket.next(i);
        error = miss(step, value, values);
    }
    return true;
}

} // namespace reports
