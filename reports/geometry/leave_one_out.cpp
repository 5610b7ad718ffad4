// What becomes of the predictions when another row determines a number.
#include "reports/geometry/calibration.hpp"
#include "reports/geometry/solver.hpp"

#include <algorithm>

namespace reports {

namespace {

struct Case {
    CalibrationStep step;
    std::string row; ///< instead of the step's own
};

std::vector<Case> cases_of(const std::string& gpu, const CalibrationPlan& plan) {
    std::vector<Case> cases;
    for (const CalibrationStep& step : plan.steps)
        if (step.gpu == gpu)
            for (const std::string& row : step.alternatives) cases.push_back({step, row});
    return cases;
}

// Rows of a GPU with the present values; the roles of the two rows are exchanged.
ErrorSpread errors_with(const Case& exchanged, const std::vector<PublishedRow>& rows, const CalibrationPlan& plan,
                        const Solver& solver, const Values& values) {
    const std::string& gpu = exchanged.step.gpu;
    std::vector<ValidationRow> measured;
    for (const PublishedRow& published : rows) {
        if (!published.fps.contains(gpu)) continue;
        const auto in = [&published](const std::string& expression) {
            const std::vector<std::string> used = rows_in(expression);
            return std::find(used.begin(), used.end(), published.key()) != used.end();
        };
        ValidationRow row = published_row(published, gpu);
        apply_plan(row, plan);
        if (in(exchanged.row) || (!in(exchanged.step.row) && row.status != RowStatus::predicted)) continue;
        row.status = RowStatus::predicted;
        row.model = 1000 / solver.milliseconds(published.key(), values);
        measured.push_back(std::move(row));
    }
    return summarise(measured).front().predicted;
}

} // namespace

std::vector<LeftOneOut> leave_one_out(const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    GeometryRunOptions quick = options;
    quick.fidelity = Fidelity::estimate;
    const std::vector<PublishedRow> rows = load_published_geometry();
    const CalibrationPlan plan = load_calibration_plan();
    const std::vector<std::string> chosen = gpus.empty() ? measured_gpus(rows) : gpus;
    std::vector<LeftOneOut> list;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        RowFrames frames(rows, gpu_params(chosen[i]));
        const Solver solver(chosen[i], rows, frames, quick);
        for (Case& one : cases_of(chosen[i], plan)) {
            LeftOneOut entry{chosen[i], one.step.parameter, one.row, one.step.row, 0, 0, {}, true};
            entry.usual_value = value_of(gpu_params(chosen[i]), one.step.parameter);
            Values values{{one.step.parameter, entry.usual_value}};
            CalibrationStep step = one.step;
            step.row = one.row;
            entry.found = solver.solve(step, values);
            entry.value = values.at(step.parameter);
            if (entry.found) entry.with_row = errors_with(one, rows, plan, solver, values);
            list.push_back(std::move(entry));
        }
        if (options.progress) options.progress(static_cast<double>(i + 1) / static_cast<double>(chosen.size()));
    }
    return list;
}

} // namespace reports
