#include "reports/peeling/report.hpp"

#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/result.hpp"
#include "reports/text_table.hpp"
#include "reports/validation/error_report.hpp"
#include "reports/validation/misses.hpp"
#include "reports/validation/null_models.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

std::string rate_number(double value) { return fmt::format("{:.4g}", value); }

std::string line_text(const PeelingNumber& one) {
    return one.uncertainty > 0 ? fmt::format("{:.1f}%", 100 * one.uncertainty) : "";
}

std::string printed_text(const ValidationRow& row) { return rate_number(row.published()); }

std::string null_text(const ValidationRow& row) { return row.null_model > 0 ? rate_number(row.null_model) : ""; }

Plot peeling_errors(const PeelingValidation& validation) {
    Plot plot;
    plot.title = "Predicted numbers: ln(model / published)";
    plot.y_title = "error";
    plot.bars = true;
    plot.lines = {{"model", {}}, {"null model", {}}};
    for (const PeelingNumber& one : validation.numbers) {
        if (one.row.status != RowStatus::predicted) continue;
        plot.labels.push_back(one.row.row);
        plot.lines[0].values.push_back(one.row.log_error());
        plot.lines[1].values.push_back(one.row.null_log_error());
    }
    return plot;
}

std::string numbers_html(const PeelingValidation& validation) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const PeelingNumber& one : validation.numbers) {
        const ValidationRow& row = one.row;
        const bool predicted = row.status == RowStatus::predicted;
        rows.push_back({{row.row, "name"},
                        {row.unit, ""},
                        {printed_text(row), "number"},
                        {fmt::format("{:.1f}%", 100 * row.sigma), "number"},
                        {rate_number(row.model), "number"},
                        {line_text(one), "number"},
                        {error_text(row.log_error()), !predicted     ? "number"
                                                      : row.missed() ? "number bad"
                                                                     : "number good"},
                        {error_in_sigma_text(row), "number"},
                        {row_status_text(row), ""},
                        {null_text(row), "number"},
                        {row.parameter, ""},
                        {row.source, ""}});
    }
    return html_table({"number", "unit", "published", "sigma", "model", "line +-", "error (ln)", "in sigmas", "status",
                       "null model", "number it decides, or what was chosen with it in view", "from"},
                      rows);
}

std::vector<Misses> peeling_misses(const PeelingValidation& validation) {
    std::vector<ValidationRow> rows;
    for (const PeelingNumber& one : validation.numbers) rows.push_back(one.row);
    return large_misses(rows, [](const ValidationRow& row) { return row.row; });
}

} // namespace

std::string peeling_text(const PeelingValidation& validation, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const PeelingNumber& one : validation.numbers) {
        const ValidationRow& row = one.row;
        rows.push_back({row.row, row.unit, printed_text(row), fmt::format("{:.1f}%", 100 * row.sigma),
                        rate_number(row.model), line_text(one), error_text(row.log_error()), error_in_sigma_text(row),
                        row_status_text(row), null_text(row), row.parameter});
    }
    const std::string explanations = misses_text(peeling_misses(validation), style);
    std::string text =
        wrap(fmt::format("Depth peeling on {} as published ({}) and on the model, {}. {} Line: how far the line "
                         "through the stand-ins may miss the whole mesh, if its slope goes on changing as it did "
                         "between them.",
                         validation.gpu, validation.source, sim::enum_name(validation.fidelity), error_reading),
             style.columns, 0) +
        "\n" +
        text_table({{"number", "", true},
                    {"unit", "", true},
                    {"published", ""},
                    {"sigma", ""},
                    {"model", ""},
                    {"line", "+-"},
                    {"error", "ln"},
                    {"error", "sigma"},
                    {"status", "", true},
                    {"null", ""},
                    {"number it decides, or what was chosen with it in view", "", true}},
                   rows, style);
    text += "\n" + wrap(std::string(status_reading), style.columns, 0) +
            wrap(fmt::format("Null model: {}", peeling_null_model), style.columns, 0) + "\n" +
            error_summary_text({validation.summary}, style) + "\n" +
            wrap(error_sentences(validation.summary), style.columns, 0);
    if (!explanations.empty()) text += "\nMisses above 25%:\n" + explanations;
    return text;
}

ordered_json peeling_json(const PeelingValidation& validation) {
    ordered_json rows = ordered_json::array();
    for (const PeelingNumber& one : validation.numbers) {
        ordered_json json = validation_row_json(one.row);
        json["line_error"] = one.uncertainty;
        rows.push_back(std::move(json));
    }
    ordered_json summary = error_summary_json(validation.summary);
    summary["null_model"] = peeling_null_model;
    return {{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
            {"source", validation.source},
            {"fidelity", sim::enum_name(validation.fidelity)},
            {"host", {{"run_seconds", validation.host_seconds}}},
            {"rows", std::move(rows)},
            {"summary", std::move(summary)}};
}

std::vector<Table> peeling_tables(const PeelingValidation& validation) {
    Table table{"validation.csv", validation_columns(), {}};
    table.header.emplace_back("line error");
    for (const PeelingNumber& one : validation.numbers) {
        table.rows.push_back(validation_cells(one.row));
        table.rows.back().push_back(rate_number(one.uncertainty));
    }
    return {table, error_summary_table({validation.summary})};
}

std::string peeling_page(const PeelingValidation& validation) {
    const std::string intro = fmt::format(
        "<p>Depth peeling as published ({}) and as the model gives it. {}</p>\n<p>{}</p>\n<p>Null model: {} Skill: 1 - "
        "RMS error of the model over that of the null model, on the same numbers.</p>\n<p>Meshes that are not run "
        "whole are read off a line through runs of stand-ins; beside the model stands by how much that line may miss, "
        "if its slope goes on changing as it did between them.</p>\n<p><b>{}</b></p>\n<p class=\"note\">ropsim {} "
        "({}); {}.</p>\n",
        escape_html(validation.source), error_reading, status_reading, peeling_null_model,
        escape_html(error_sentences(validation.summary)), version_text(), escape_html(build_text()),
        sim::enum_name(validation.fidelity));
    return plot_page("Depth peeling: model and measurements", intro, {peeling_errors(validation)},
                     {{"Errors, in natural logarithms", error_summary_html({validation.summary})},
                      {"Numbers", numbers_html(validation)},
                      {"Misses above 25%", misses_html(peeling_misses(validation))}});
}

} // namespace reports
