#include "reports/geometry/calibration.hpp"

#include "models/gpu_library.hpp"
#include "pipeline/functional/parallel.hpp"
#include "reports/geometry/solver.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace reports {

namespace {

constexpr unsigned most_rounds = 12;

double scale_of(Scaling by, const pipeline::GpuParams& from, const pipeline::GpuParams& to, const std::string& path) {
    if (by == Scaling::memory)
        return (to.memory.bandwidth / to.clock.core_mhz) / (from.memory.bandwidth / from.clock.core_mhz);
    const double units = static_cast<double>(to.geometry.vertex_shader.units) / from.geometry.vertex_shader.units;
    return path.ends_with("_cycles") ? 1 / units : units;
}

GpuCalibration start_of(const std::string& gpu, const CalibrationPlan& plan) {
    GpuCalibration result;
    result.gpu = gpu;
    const pipeline::GpuParams params = gpu_params(gpu);
    for (const CalibrationStep& step : plan.steps) {
        if (step.gpu != gpu) continue;
        const double value = value_of(params, step.parameter);
        result.numbers.push_back({step, value, value, 0, 0});
    }
    for (const ScaledParameter& rule : plan.scaled)
        if (rule.gpu == gpu) result.scaled.push_back({rule, value_of(params, rule.parameter), 0});
    return result;
}

// Numbers found for a GPU before that this one's file takes from it.
Values inherited(const std::string& gpu, const std::vector<GpuCalibration>& before) {
    Values values;
    const pipeline::GpuParams params = gpu_params(gpu);
    const std::string base = models::base_of(gpu);
    for (const GpuCalibration& other : before) {
        if (other.gpu != base) continue;
        const pipeline::GpuParams from = gpu_params(other.gpu);
        for (const auto& [parameter, value] : other.values())
            if (value_of(params, parameter) == value_of(from, parameter)) values[parameter] = value;
    }
    return values;
}

void take_scaled(GpuCalibration& result, const std::vector<GpuCalibration>& before, Values& values) {
    const pipeline::GpuParams to = gpu_params(result.gpu);
    for (ScaledNumber& number : result.scaled) {
        const auto from = std::find_if(before.begin(), before.end(),
                                       [&](const GpuCalibration& other) { return other.gpu == number.rule.from; });
        const pipeline::GpuParams params =
            gpu_params(number.rule.from, from == before.end() ? Values{} : from->values());
        number.value =
            value_of(params, number.rule.parameter) * scale_of(number.rule.by, params, to, number.rule.parameter);
        values[number.rule.parameter] = number.value;
    }
}

void solve_all(GpuCalibration& result, const Solver& solver, Values& values) {
    bool settled = false;
    while (!settled && result.rounds < most_rounds) {
        settled = true;
        ++result.rounds;
        for (CalibratedNumber& number : result.numbers) {
            const double before = values.at(number.step.parameter);
            const bool met = solver.solve(number.step, values);
            if (!met && result.rounds == most_rounds)
                throw sim::InputError(fmt::format(
                    "{}: {}: expected a value between {} and {} at which row '{}' takes {:.4g} ms, {} comes "
                    "nearest",
                    number.step.gpu, number.step.parameter, number.step.low, number.step.high, number.step.row,
                    solver.wanted(number.step.row), values.at(number.step.parameter)));
            const double after = values.at(number.step.parameter);
            if (!met || std::abs(after - before) > 1e-3 * std::abs(after)) settled = false;
        }
    }
}

} // namespace

std::map<std::string, double> GpuCalibration::values() const {
    Values values;
    for (const CalibratedNumber& number : numbers) values[number.step.parameter] = number.value;
    for (const ScaledNumber& number : scaled) values[number.rule.parameter] = number.value;
    return values;
}

std::vector<GpuCalibration> calibrate_geometry(const std::vector<std::string>& gpus,
                                               const GeometryRunOptions& options) {
    const std::vector<PublishedRow> rows = load_published_geometry();
    const CalibrationPlan plan = load_calibration_plan();
    check_measured(gpus, measured_gpus(rows));
    std::vector<std::string> order = gpus.empty() ? measured_gpus(rows) : gpus;
    std::stable_partition(order.begin(), order.end(), [&plan](const std::string& gpu) {
        return std::none_of(plan.scaled.begin(), plan.scaled.end(),
                            [&gpu](const ScaledParameter& rule) { return rule.gpu == gpu; });
    });
    std::vector<GpuCalibration> results;
    for (const std::string& gpu : order) {
        GpuCalibration result = start_of(gpu, plan);
        Values values = inherited(gpu, results);
        take_scaled(result, results, values);
        for (const CalibratedNumber& number : result.numbers) values[number.step.parameter] = number.in_file;
        RowFrames frames(rows, gpu_params(gpu));
        const Solver solver(gpu, rows, frames, options);
        solve_all(result, solver, values);
        pipeline::parallel_for(options.threads, result.numbers.size(), [&](std::size_t i) {
            CalibratedNumber& number = result.numbers[i];
            number.value = values.at(number.step.parameter);
            number.published = solver.wanted(number.step.row);
            number.model = solver.milliseconds(number.step.row, values);
        });
        results.push_back(std::move(result));
        if (options.progress) options.progress(static_cast<double>(results.size()) / static_cast<double>(order.size()));
    }
    return results;
}

} // namespace reports
