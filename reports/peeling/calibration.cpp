#include "reports/peeling/calibration.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/geometry/solver.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace reports {

namespace {

constexpr double met_within = 5e-4; ///< of the time; runs of one stand-in differ by a thousandth from seed to seed
constexpr unsigned most_runs = 16;
constexpr unsigned most_rounds_of_steps = 4;

CalibrationStep calibration_step(const PublishedPeeling& published, const PeelingStep& step) {
    CalibrationStep result;
    result.gpu = published.gpu;
    result.parameter = step.parameter;
    result.row = fmt::format("T6.1 {}, {}, {}", step.dataset, step.buffer, sim::enum_name(step.column));
    result.low = step.low;
    result.high = step.high;
    result.reason = step.reason;
    return result;
}

double published_milliseconds(const PublishedPeeling& published, const PeelingStep& step) {
    return 1e3 / published.row(step.dataset, step.buffer).fps[static_cast<std::size_t>(step.column)].value;
}

GpuCalibration as_in_file(const PublishedPeeling& published, Values& values) {
    GpuCalibration result;
    result.gpu = published.gpu;
    result.command = "ropsim calibrate peeling";
    const pipeline::GpuParams params = gpu_params(published.gpu);
    for (const PeelingStep& step : published.calibrated) {
        const double in_file = values[step.parameter] = value_of(params, step.parameter);
        result.numbers.push_back({calibration_step(published, step), in_file, in_file, 0, 0});
    }
    return result;
}

void solve_step(const PublishedPeeling& published, const PeelingStep& step, const PeelingOptions& options,
                Values& values, CalibratedNumber& number) {
    const auto time = [&](double value) {
        Values with = values;
        with[step.parameter] = value;
        return peeling_milliseconds(published, step, with, options);
    };
    number.published = published_milliseconds(published, step);
    const SolvedNumber solved = solve_power(time, number.published, values.at(step.parameter), step.low, step.high);
    if (!solved.met)
        throw sim::InputError(fmt::format("{}: {}: expected a value between {} and {} at which '{}' takes {:.4g} ms, "
                                          "{:.4g} comes nearest",
                                          published.gpu, step.parameter, step.low, step.high, number.step.row,
                                          number.published, solved.value));
    number.value = values[step.parameter] = solved.value;
    number.model = solved.time;
}

} // namespace

double peeling_milliseconds(const PublishedPeeling& published, const PeelingStep& step, const Values& values,
                            const PeelingOptions& options, bool smallest) {
    const PeelingDataset& dataset = published.dataset(step.dataset);
    std::vector<std::uint64_t> sizes = peeling_sizes(dataset, options.fidelity);
    if (smallest) sizes = {dataset.sizes.front()};
    std::vector<std::string> settings;
    for (const auto& [parameter, value] : values) settings.push_back(fmt::format("{}={:.17g}", parameter, value));
    std::vector<double> triangles(sizes.size()), milliseconds(sizes.size());
    pipeline::parallel_for(options.threads, sizes.size(), [&](std::size_t i) {
        const StandInRun run = run_stand_in(published, published.row(step.dataset, step.buffer), sizes[i], settings,
                                            options.stop, {step.column});
        triangles[i] = static_cast<double>(run.triangles);
        milliseconds[i] = run.milliseconds[static_cast<std::size_t>(step.column)];
    });
    if (smallest) return milliseconds.front();
    return line_value(triangles, milliseconds, static_cast<double>(dataset.triangles)).value;
}

SolvedNumber solve_power(const TimeOfNumber& time, double wanted, double start, double low, double high) {
    CHECK(wanted > 0 && low > 0 && low < high);
    double x = std::log(std::clamp(start, low, high));
    const auto miss_at = [&](double logarithm) { return std::log(time(std::exp(logarithm)) / wanted); };
    double miss = miss_at(x), best_x = x, best = miss;
    double before_x = x, before = miss;
    for (unsigned run = 1; run < most_runs && std::abs(best) > met_within; ++run) {
        // A first step of a tenth says which way the number acts.
        const bool first = before_x == x;
        const double slope = first ? 0 : (miss - before) / (x - before_x);
        const double step = first ? 0.1 : slope == 0 ? 0.5 : std::clamp(-miss / slope, -1.5, 1.5);
        double next = std::clamp(x + step, std::log(low), std::log(high));
        if (next == x) next = first ? x - 0.1 : x;
        if (next == x) break; // held by a bound
        before_x = std::exchange(x, next);
        before = std::exchange(miss, miss_at(next));
        if (std::abs(miss) < std::abs(best)) best_x = x, best = miss;
    }
    return {std::exp(best_x), wanted * std::exp(best), std::abs(best) <= met_within};
}

GpuCalibration calibrate_peeling(const PublishedPeeling& published, const PeelingOptions& options) {
    Values values;
    GpuCalibration result = as_in_file(published, values);
    const std::size_t steps = published.calibrated.size();
    bool settled = false;
    while (!settled) {
        if (++result.rounds > most_rounds_of_steps)
            throw sim::InputError(
                fmt::format("{}: expected numbers that settle within {} rounds", published.gpu, most_rounds_of_steps));
        settled = true;
        for (std::size_t i = 0; i < steps; ++i) {
            const double before = values.at(published.calibrated[i].parameter);
            solve_step(published, published.calibrated[i], options, values, result.numbers[i]);
            if (std::abs(result.numbers[i].value / before - 1) > 1e-3) settled = false;
            // Half of a second round is usual.
            const double rounds = result.rounds - 1 + static_cast<double>(i + 1) / static_cast<double>(steps);
            if (options.progress) options.progress(std::min(1.0, rounds / 1.5));
        }
    }
    return result;
}

} // namespace reports
