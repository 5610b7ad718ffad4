#include "reports/geometry/json.hpp"

#include "reports/result.hpp"
#include "reports/validation/error_report.hpp"
#include "reports/validation/null_models.hpp"
#include "sim/described_json.hpp"

#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

ordered_json about() { return {{"version", version_text()}, {"build", build_text()}}; }

ordered_json case_json(const GeometryCase& one) {
    ordered_json steps = ordered_json::array();
    for (const traces::PreparationStep& step : one.steps) {
        ordered_json json = {{"id", step.id},
                             {"before", sim::to_json(step.before)},
                             {"after", sim::to_json(step.after)},
                             {"notes", step.notes}};
        if (step.position_error) json["position_error"] = *step.position_error;
        steps.push_back(std::move(json));
    }
    ordered_json draws = ordered_json::array();
    constexpr std::size_t most_draws_listed = 64; // draws.csv has each
    const bool listed = one.result.draws.size() <= most_draws_listed;
    for (std::size_t i = 0; listed && i < one.result.draws.size(); ++i) {
        const pipeline::VertexPathDraw& draw = one.result.draws[i];
        ordered_json json = {{"draw", i}, {"acmr", draw.counts.acmr()}, {"counters", sim::to_json(draw.counts)}};
        json["index_range"] = draw.terms.span;
        json["slowdown"] = draw.terms.slowdown;
        draws.push_back(std::move(json));
    }
    return {{"name", one.name},
            {"prepare", one.prepare},
            {"cycles", one.result.cycles},
            {"milliseconds", one.result.milliseconds},
            {"fps", one.result.frames_per_second()},
            {"limit", one.result.limit()},
            {"share_sampled", one.result.share_sampled},
            {"demand", sim::to_json(one.result.demand)},
            {"mesh", sim::to_json(one.measure)},
            {"steps", std::move(steps)},
            {"draws", std::move(draws)},
            {"draws_not_listed", listed ? 0 : one.result.draws.size()},
            {"stages", *one.result.stages}};
}

} // namespace

ordered_json advice_json(const GeometryAdvice& advice) {
    ordered_json cases = ordered_json::array(), left_out = ordered_json::array();
    double host = 0;
    for (const GeometryCase& one : advice.cases) {
        cases.push_back(case_json(one));
        host += one.result.host_seconds;
    }
    for (const pipeline::LeftOut& item : advice.left_out)
        left_out.push_back({{"unit", item.unit}, {"reason", item.reason}});
    return {{"ropsim", about()},
            {"scene",
             {{"name", advice.scene},
              {"hash", advice.hash},
              {"triangles_drawn", advice.triangles},
              {"notes", advice.notes}}},
            {"gpu", advice.gpu},
            {"submission", sim::enum_name(advice.submission)},
            {"fidelity", sim::enum_name(advice.fidelity)},
            {"seed", advice.seed},
            {"host", {{"seconds", advice.seconds}, {"run_seconds", host}}},
            {"left_out", std::move(left_out)},
            {"cases", std::move(cases)},
            {"best", advice.cases[advice.best()].name},
            {"recommendation", advice.recommendation()}};
}

ordered_json validation_json(const GeometryValidation& validation, const std::vector<LeftOneOut>& entries) {
    ordered_json rows = ordered_json::array(), summary = ordered_json::object(), by_gpu = ordered_json::array();
    for (const ValidationRow& row : validation.rows) {
        ordered_json json = validation_row_json(row);
        if (row.acmr > 0) json["acmr"] = row.acmr;
        if (!row.limit.empty()) json["limit"] = row.limit;
        rows.push_back(std::move(json));
    }
    for (const ErrorSummary& one : validation.summary) {
        if (one.gpu != "all")
            by_gpu.push_back(error_summary_json(one));
        else
            summary = error_summary_json(one);
    }
    summary["null_model"] = geometry_null_model;
    summary["gpus"] = std::move(by_gpu);
    ordered_json document = {{"ropsim", about()},
                             {"fidelity", sim::enum_name(validation.fidelity)},
                             {"rows", std::move(rows)},
                             {"summary", std::move(summary)}};
    for (const LeftOneOut& entry : entries)
        document["leave_one_out"].push_back({{"gpu", entry.gpu},
                                             {"parameter", entry.parameter},
                                             {"row", entry.row},
                                             {"instead_of", entry.instead_of},
                                             {"found", entry.found},
                                             {"value", entry.value},
                                             {"usual_value", entry.usual_value},
                                             {"median_predicted_error", entry.with_row.median},
                                             {"worst_predicted_error", entry.with_row.worst}});
    return document;
}

ordered_json calibration_json(const std::vector<GpuCalibration>& calibrations) {
    ordered_json gpus = ordered_json::array();
    for (const GpuCalibration& calibration : calibrations) {
        ordered_json numbers = ordered_json::array();
        for (const CalibratedNumber& number : calibration.numbers)
            numbers.push_back({{"parameter", number.step.parameter},
                               {"row", number.step.row},
                               {"kind", number.step.kind == CalibrationKind::penalty ? "penalty" : "calibrated"},
                               {"reason", number.step.reason},
                               {"in_file", number.in_file},
                               {"value", number.value},
                               {"published", number.published},
                               {"model", number.model}});
        for (const ScaledNumber& number : calibration.scaled)
            numbers.push_back({{"parameter", number.rule.parameter},
                               {"kind", "scaled"},
                               {"from", number.rule.from},
                               {"in_file", number.in_file},
                               {"value", number.value}});
        gpus.push_back({{"gpu", calibration.gpu}, {"rounds", calibration.rounds}, {"numbers", std::move(numbers)}});
    }
    return {{"ropsim", about()}, {"gpus", std::move(gpus)}};
}

} // namespace reports
