#include "reports/validation/error_report.hpp"

#include "reports/html/markup.hpp"
#include "sim/described.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

std::string csv_number_text(double value) { return fmt::format("{:.6g}", value); }

std::string short_error_text(double size) { return fmt::format("{:.3f}", size); }

std::string skill_text(const ErrorSpread& spread) {
    const auto skill = spread.skill();
    return skill ? fmt::format("{:+.2f}", *skill) : "";
}

struct SummaryLine {
    std::string gpu, kind;
    const ErrorSpread* spread;
};

std::vector<SummaryLine> summary_lines(const std::vector<ErrorSummary>& summaries) {
    std::vector<SummaryLine> lines;
    for (const ErrorSummary& one : summaries) {
        lines.push_back({one.gpu, "predicted", &one.predicted});
        lines.push_back({one.gpu, "predicted, sharp", &one.sharp});
        lines.push_back({one.gpu, "calibrated, not counted", &one.fitted});
    }
    return lines;
}

std::vector<std::string> summary_cells(const SummaryLine& line) {
    const ErrorSpread& spread = *line.spread;
    if (spread.rows == 0) return {line.gpu, line.kind, "0", "", "", "", "", "", "", ""};
    return {line.gpu,
            line.kind,
            std::to_string(spread.rows),
            short_error_text(spread.median),
            short_error_text(spread.rms),
            error_text(spread.mean),
            short_error_text(spread.worst),
            spread.null_rms ? short_error_text(*spread.null_rms) : "",
            skill_text(spread),
            spread.worst_row};
}

ordered_json spread_json(const ErrorSpread& spread) {
    ordered_json json = {{"predicted_rows", spread.rows},
                         {"median_predicted_error", spread.median},
                         {"rms_predicted_error", spread.rms},
                         {"mean_predicted_error", spread.mean},
                         {"worst_predicted_error", spread.worst},
                         {"worst_row", spread.worst_row},
                         {"null_model_rms", nullptr},
                         {"skill", nullptr}};
    if (spread.null_rms) json["null_model_rms"] = *spread.null_rms;
    if (const auto skill = spread.skill()) json["skill"] = *skill;
    return json;
}

// A logarithm as how much larger or smaller that is.
std::string as_percent(double size) { return fmt::format("{:.1f}%", 100 * std::expm1(size)); }

} // namespace

std::string error_text(double logarithm) { return fmt::format("{:+.3f}", logarithm); }

std::string error_in_sigma_text(const ValidationRow& row) {
    return row.sigma > 0 ? fmt::format("{:+.1f}", row.error_in_sigma()) : "";
}

std::string row_status_text(const ValidationRow& row) { return std::string(sim::enum_name(row.status)); }

std::string error_sentences(const ErrorSummary& summary) {
    const ErrorSpread &all = summary.predicted, &sharp = summary.sharp;
    if (all.rows == 0) return "No row is predicted.";
    std::string text = fmt::format(
        "{} predicted numbers: the error is {:.3f} in the median (a factor off by {}), {:.3f} RMS, {:.3f} at "
        "worst ({}).",
        all.rows, all.median, as_percent(all.median), all.rms, all.worst, all.worst_row);
    if (const auto skill = all.skill())
        text += fmt::format(" Null model: {:.3f} RMS; skill {:+.2f}.", *all.null_rms, *skill);
    if (sharp.rows == 0) return text;
    text += fmt::format(" The {} of them that are sharp (sigma at most {:.0f}%): {:.3f} in the median, {:.3f} RMS, "
                        "{:.3f} at worst.",
                        sharp.rows, 100 * sharp_sigma, sharp.median, sharp.rms, sharp.worst);
    if (const auto skill = sharp.skill())
        text += fmt::format(" Null model: {:.3f} RMS; skill {:+.2f}.", *sharp.null_rms, *skill);
    return text;
}

std::string error_summary_text(const std::vector<ErrorSummary>& summaries, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const SummaryLine& line : summary_lines(summaries)) rows.push_back(summary_cells(line));
    return text_table({{"GPU", "", true},
                       {"rows", "", true},
                       {"count", ""},
                       {"median", "|ln|"},
                       {"RMS", "ln"},
                       {"mean", "ln"},
                       {"worst", "|ln|"},
                       {"null RMS", "ln"},
                       {"skill", ""},
                       {"worst row", "", true}},
                      rows, style);
}

std::string error_summary_html(const std::vector<ErrorSummary>& summaries) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const SummaryLine& line : summary_lines(summaries)) {
        const std::vector<std::string> cells = summary_cells(line);
        rows.emplace_back();
        for (std::size_t i = 0; i < cells.size(); ++i)
            rows.back().push_back({cells[i], i < 2 || i + 1 == cells.size() ? "" : "number"});
    }
    return html_table({"GPU", "rows", "count", "median |error|", "RMS error", "mean error", "worst |error|",
                       "RMS of the null model", "skill", "worst row"},
                      rows);
}

Table error_summary_table(const std::vector<ErrorSummary>& summaries) {
    Table table{
        "summary.csv",
        {"GPU", "rows", "count", "median |ln|", "RMS ln", "mean ln", "worst |ln|", "null RMS ln", "skill", "worst row"},
        {}};
    for (const SummaryLine& line : summary_lines(summaries)) {
        const ErrorSpread& spread = *line.spread;
        const auto skill = spread.skill();
        table.rows.push_back({line.gpu, line.kind, std::to_string(spread.rows), csv_number_text(spread.median),
                              csv_number_text(spread.rms), csv_number_text(spread.mean), csv_number_text(spread.worst),
                              spread.null_rms ? csv_number_text(*spread.null_rms) : "",
                              skill ? csv_number_text(*skill) : "", spread.worst_row});
    }
    return table;
}

ordered_json error_summary_json(const ErrorSummary& summary) {
    ordered_json json = {{"gpu", summary.gpu}};
    json.update(spread_json(summary.predicted));
    json["sharp"] = spread_json(summary.sharp);
    const ErrorSpread& fitted = summary.fitted;
    json["calibrated"] = {{"rows", fitted.rows},
                          {"median_error", fitted.median},
                          {"rms_error", fitted.rms},
                          {"worst_error", fitted.worst},
                          {"worst_row", fitted.worst_row}};
    return json;
}

ordered_json validation_row_json(const ValidationRow& row) {
    ordered_json json = {{"table", row.table},
                         {"row", row.row},
                         {"gpu", row.gpu},
                         {"published", row.published()},
                         {"model", row.model},
                         {"ratio", row.ratio()},
                         {"log_error", row.log_error()},
                         {"status", sim::enum_name(row.status)},
                         {"unit", row.unit},
                         {"origin", sim::enum_name(row.origin)}};
    if (row.sigma > 0) {
        json["sigma"] = row.sigma;
        json["error_in_sigma"] = row.error_in_sigma();
        json["sharp"] = row.sharp();
    }
    if (row.null_model > 0) {
        json["null_model"] = row.null_model;
        json["null_log_error"] = row.null_log_error();
    }
    if (row.low < row.high) {
        json["published_least"] = row.low;
        if (std::isfinite(row.high)) json["published_most"] = row.high;
    }
    if (!row.source.empty()) json["source"] = row.source;
    if (!row.parameter.empty()) json["parameter"] = row.parameter;
    if (!row.explanation.empty()) json["explanation"] = row.explanation;
    return json;
}

std::vector<std::string> validation_columns() {
    return {"table",           "row",    "GPU",    "unit",   "published", "published, least",
            "published, most", "sigma",  "model",  "ratio",  "ln error",  "error in sigmas",
            "null model",      "status", "origin", "source", "number",    "explanation"};
}

std::vector<std::string> validation_cells(const ValidationRow& row) {
    return {row.table,
            row.row,
            row.gpu,
            row.unit,
            csv_number_text(row.published()),
            csv_number_text(row.low),
            csv_number_text(row.high),
            row.sigma > 0 ? csv_number_text(row.sigma) : "",
            csv_number_text(row.model),
            csv_number_text(row.ratio()),
            csv_number_text(row.log_error()),
            row.sigma > 0 ? csv_number_text(row.error_in_sigma()) : "",
            row.null_model > 0 ? csv_number_text(row.null_model) : "",
            row_status_text(row),
            std::string(sim::enum_name(row.origin)),
            row.source,
            row.parameter,
            row.explanation};
}

} // namespace reports
