#include "reports/geometry/text.hpp"

#include "reports/numbers.hpp"
#include "reports/text_table.hpp"
#include "reports/validation/error_report.hpp"
#include "reports/validation/null_models.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace reports {

namespace {

/// Three digits, however large: 0.8, 24.5, 397.
std::string rate_text(double number) {
    if (number >= 99.95) return fmt::format("{:.0f}", number);
    return fmt::format("{:.{}f}", number, number >= 9.995 ? 1 : 2);
}

std::string percent_text(double share) { return fmt::format("{:.1f}%", 100 * share); }

std::string cases_text(const GeometryAdvice& advice, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const GeometryCase& one : advice.cases) {
        const traces::MeshMeasure& mesh = one.measure;
        rows.push_back({one.name, with_commas(mesh.draws), short_number(static_cast<double>(mesh.index_bytes)),
                        short_number(static_cast<double>(mesh.vertex_bytes)), fmt::format("{:.3f}", mesh.acmr),
                        fmt::format("{:.2f}", mesh.atvr), fmt::format("{:.2f}", mesh.overfetch),
                        with_commas(one.result.cycles), fmt::format("{:.3f}", one.result.milliseconds),
                        rate_text(one.result.frames_per_second()),
                        fmt::format("{:.2f}", advice.cases.front().result.milliseconds / one.result.milliseconds),
                        one.result.limit()});
    }
    return text_table({{"mesh", "", true},
                       {"draws", ""},
                       {"indices", "B"},
                       {"vertices", "B"},
                       {"ACMR", ""},
                       {"ATVR", ""},
                       {"overfetch", "x"},
                       {"cycles", ""},
                       {"time", "ms"},
                       {"frames", "/s"},
                       {"speed", "x"},
                       {"limit", "", true}},
                      rows, style);
}

// What each part of the vertex path would take alone, the largest first.
std::string demand_text(const GeometryAdvice& advice, TerminalStyle style) {
    struct Demand {
        std::string name;
        double cycles;
    };
    std::vector<Demand> demands;
    const pipeline::VertexPathResult& result = advice.cases.front().result;
    sim::for_each_field(result.demand, [&](const auto& field, const double& cycles) {
        if (cycles > 0) demands.push_back({std::string(field.text), cycles});
    });
    std::stable_sort(demands.begin(), demands.end(),
                     [](const Demand& a, const Demand& b) { return a.cycles > b.cycles; });
    std::vector<std::vector<std::string>> rows;
    for (const Demand& demand : demands)
        rows.push_back({demand.name, with_commas(static_cast<std::uint64_t>(std::llround(demand.cycles))),
                        fmt::format("{:.3f}", demand.cycles / (advice.core_mhz * 1e3)),
                        percent_text(demand.cycles / static_cast<double>(result.cycles))});
    return text_table(
        {{"as it is: what each part takes alone", "", true}, {"cycles", ""}, {"time", "ms"}, {"of frame", ""}}, rows,
        style);
}

std::string steps_text(const GeometryAdvice& advice, TerminalStyle style) {
    std::string text;
    for (const GeometryCase& one : advice.cases)
        for (const traces::PreparationStep& step : one.steps) {
            std::string line =
                fmt::format("  {}: ACMR {:.3f} -> {:.3f}, overfetch {:.2f} -> {:.2f}, {} -> {} B, draws {} -> {}",
                            step.id, step.before.acmr, step.after.acmr, step.before.overfetch, step.after.overfetch,
                            short_number(static_cast<double>(step.before.index_bytes + step.before.vertex_bytes)),
                            short_number(static_cast<double>(step.after.index_bytes + step.after.vertex_bytes)),
                            step.before.draws, step.after.draws);
            if (step.position_error) line += fmt::format("; positions move by at most {:.3g}", *step.position_error);
            for (const std::string& note : step.notes) line += "; " + note;
            text += wrap(line, style.columns, 4);
        }
    return text.empty() ? "" : "Preparations:\n" + text;
}

} // namespace

std::string published_text(const ValidationRow& row) {
    if (row.low == row.high) return rate_text(row.low);
    if (std::isinf(row.high)) return fmt::format("at least {}", rate_text(row.low));
    if (row.low == 0) return fmt::format("at most {}", rate_text(row.high));
    return fmt::format("{} to {}", rate_text(row.low), rate_text(row.high));
}

std::string advice_text(const GeometryAdvice& advice, TerminalStyle style) {
    std::string text =
        wrap(fmt::format("{}: {}; vertices from {}; GPU {}; {}", advice.scene, counted(advice.triangles, "triangle"),
                         sim::enum_name(advice.submission), advice.gpu, sim::enum_name(advice.fidelity)),
             style.columns, 2);
    const double share = advice.cases.front().result.share_sampled;
    if (share < 1)
        text += wrap(fmt::format("Counts are taken from {} of the triangles.", percent_text(share)), style.columns, 2);
    text += "\n" + cases_text(advice, style) + "\n" + demand_text(advice, style) + "\n" + steps_text(advice, style);
    if (!advice.left_out.empty()) text += "Left out:\n";
    for (const pipeline::LeftOut& item : advice.left_out)
        text += wrap(fmt::format("  {}: {}", item.unit, item.reason), style.columns, 4);
    return text + "\n" + wrap(advice.recommendation(), style.columns, 0);
}

std::string validation_text(const GeometryValidation& validation, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    std::string explanations;
    for (const ValidationRow& row : validation.rows) {
        rows.push_back({row.table, row.row, row.gpu, row.unit, published_text(row), rate_text(row.model),
                        error_text(row.log_error()), error_in_sigma_text(row), row_status_text(row),
                        row.null_model > 0 ? rate_text(row.null_model) : "",
                        row.acmr > 0 ? fmt::format("{:.3f}", row.acmr) : "", row.limit});
        if (row.missed())
            explanations += wrap(fmt::format("  {} on {} ({}): {}", row.key(), row.gpu, row_status_text(row),
                                             row.explanation.empty() ? "not explained" : row.explanation),
                                 style.columns, 4);
    }
    std::string text = text_table({{"table", "", true},
                                   {"row", "", true},
                                   {"GPU", "", true},
                                   {"unit", "", true},
                                   {"published", ""},
                                   {"model", ""},
                                   {"error", "ln"},
                                   {"error", "sigma"},
                                   {"status", "", true},
                                   {"null", ""},
                                   {"ACMR", ""},
                                   {"limit", "", true}},
                                  rows, style);
    text += "\n" + wrap(std::string(error_reading), style.columns, 0) +
            wrap(std::string(status_reading), style.columns, 0) +
            wrap(fmt::format("Null model: {}", geometry_null_model), style.columns, 0) + "\n" +
            error_summary_text(validation.summary, style) + "\n" +
            wrap(error_sentences(validation.summary.back()), style.columns, 0);
    if (!explanations.empty()) text += "\nMisses above 25%:\n" + explanations;
    return text;
}

std::string leave_one_out_text(const std::vector<LeftOneOut>& entries, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const LeftOneOut& entry : entries)
        rows.push_back({entry.gpu, entry.parameter, entry.row, entry.instead_of, fmt::format("{:.4g}", entry.value),
                        fmt::format("{:.4g}", entry.usual_value),
                        entry.found ? fmt::format("{:.3f}", entry.with_row.median) : "-",
                        entry.found ? fmt::format("{:.3f}", entry.with_row.worst) : "-",
                        entry.found ? entry.with_row.worst_row : "no value meets this row"});
    return "Predictions when another row determines a number (estimates):\n" + text_table({{"GPU", "", true},
                                                                                           {"number", "", true},
                                                                                           {"from row", "", true},
                                                                                           {"instead of", "", true},
                                                                                           {"value", ""},
                                                                                           {"usually", ""},
                                                                                           {"median", "|ln|"},
                                                                                           {"worst", "|ln|"},
                                                                                           {"worst row", "", true}},
                                                                                          rows, style);
}

std::string calibration_text(const std::vector<GpuCalibration>& calibrations, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const GpuCalibration& calibration : calibrations) {
        for (const CalibratedNumber& number : calibration.numbers)
            rows.push_back({calibration.gpu, number.step.parameter, fmt::format("{:.4g}", number.value),
                            fmt::format("{:.4g}", number.in_file), number.step.row, rate_text(number.published),
                            rate_text(number.model), number.step.reason});
        for (const ScaledNumber& number : calibration.scaled)
            rows.push_back({calibration.gpu, number.rule.parameter, fmt::format("{:.4g}", number.value),
                            fmt::format("{:.4g}", number.in_file), "", "", "",
                            fmt::format("that of {} by {}", number.rule.from,
                                        number.rule.by == Scaling::memory ? "memory" : "vertex units")});
    }
    return text_table({{"GPU", "", true},
                       {"number", "", true},
                       {"found", ""},
                       {"in file", ""},
                       {"row", "", true},
                       {"measured", "ms"},
                       {"model", "ms"},
                       {"why this row", "", true}},
                      rows, style);
}

} // namespace reports
