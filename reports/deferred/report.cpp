#include "reports/deferred/report.hpp"

#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/result.hpp"
#include "reports/terminal_table.hpp"
#include "reports/validation/error_report.hpp"
#include "reports/validation/misses.hpp"
#include "reports/validation/null_models.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

std::string value_text(double value) { return fmt::format("{:.4g}", value); }

bool is_band(const ValidationRow& row) { return row.low < row.high; }

std::string published_text(const ValidationRow& row) {
    return is_band(row) ? fmt::format("{} to {}", value_text(row.low), value_text(row.high)) : value_text(row.low);
}

// A band is met or missed; a number has an error.
std::string verdict_text(const ValidationRow& row) {
    if (!is_band(row)) return error_text(row.log_error());
    return row.log_error() == 0 ? "met" : "missed";
}

std::string full_name(const ValidationRow& row) { return row.key() + " on " + row.gpu; }

std::vector<Misses> deferred_misses(const DeferredValidation& validation) {
    return validation.as_measured ? large_misses(validation.rows, full_name) : std::vector<Misses>{};
}

std::string intro_text(const DeferredValidation& validation) {
    return fmt::format("Deferred shading with one transparent layer and its rivals as published ({}) and on the model, "
                       "{}x{} pixels, maps of {}x{} texels. {} Limit: what took the largest share of the time. ",
                       validation.source, validation.size.width, validation.size.height, validation.map_size,
                       validation.map_size, error_reading);
}

Plot errors_plot(const DeferredValidation& validation) {
    Plot plot;
    plot.title = "Predicted numbers: ln(model / published)";
    plot.y_title = "error";
    plot.bars = true;
    plot.lines = {{"model", {}}, {"null model", {}}};
    for (const ValidationRow& row : validation.rows) {
        if (row.status != RowStatus::predicted) continue;
        plot.labels.push_back(row.key());
        plot.lines[0].values.push_back(row.log_error());
        plot.lines[1].values.push_back(row.null_log_error());
    }
    return plot;
}

std::string rows_html(const DeferredValidation& validation) {
    std::vector<std::vector<HtmlCell>> cells;
    for (const ValidationRow& row : validation.rows)
        cells.push_back({{row.key(), "name"},
                         {row.gpu, ""},
                         {row.unit, ""},
                         {published_text(row), "number"},
                         {value_text(row.model), "number"},
                         {verdict_text(row), row.missed() ? "number bad" : "number good"},
                         {error_in_sigma_text(row), "number"},
                         {row_status_text(row), ""},
                         {row.limit, ""},
                         {row.source, ""}});
    return html_table(
        {"number", "GPU", "unit", "published", "model", "error (ln)", "in sigmas", "status", "limit", "from"}, cells);
}

} // namespace

std::string deferred_text(const DeferredValidation& validation, TerminalStyle style) {
    std::vector<std::vector<std::string>> cells;
    for (const ValidationRow& row : validation.rows)
        cells.push_back({row.key(), row.gpu, row.unit, published_text(row), value_text(row.model), verdict_text(row),
                         error_in_sigma_text(row), row_status_text(row), row.limit});
    std::string text = wrap(intro_text(validation), style.columns, 0) + "\n" +
                       text_table({{"number", "", true},
                                   {"GPU", "", true},
                                   {"unit", "", true},
                                   {"published", ""},
                                   {"model", ""},
                                   {"error", "ln"},
                                   {"error", "sigma"},
                                   {"status", "", true},
                                   {"limit", "", true}},
                                  cells, style);
    text +=
        "\n" + wrap(std::string(status_reading), style.columns, 0) +
        wrap(fmt::format("The calibrated row decides {}. Null model: {}", validation.parameter, constant_null_model),
             style.columns, 0) +
        "\n" + error_summary_text(validation.summary, style) + "\n" +
        wrap(error_sentences(validation.summary.back()), style.columns, 0);
    const std::string explanations = misses_text(deferred_misses(validation), style);
    if (!explanations.empty()) text += "\nMisses above 25%:\n" + explanations;
    return text;
}

ordered_json deferred_json(const DeferredValidation& validation) {
    ordered_json rows = ordered_json::array();
    for (const ValidationRow& row : validation.rows) {
        rows.push_back(validation_row_json(row));
        if (!row.limit.empty()) rows.back()["limit"] = row.limit;
    }
    ordered_json by_gpu = ordered_json::array();
    for (const ErrorSummary& one : validation.summary)
        if (one.gpu != "all") by_gpu.push_back(error_summary_json(one));
    ordered_json summary = error_summary_json(validation.summary.back());
    summary["null_model"] = constant_null_model;
    return {{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
            {"source", validation.source},
            {"fidelity", "detailed"},
            {"size", {validation.size.width, validation.size.height}},
            {"map_size", validation.map_size},
            {"host", {{"run_seconds", validation.host_seconds}}},
            {"rows", std::move(rows)},
            {"summary", std::move(summary)},
            {"summary_by_gpu", std::move(by_gpu)}};
}

std::vector<Table> deferred_tables(const DeferredValidation& validation) {
    Table table{"validation.csv", validation_columns(), {}};
    table.header.emplace_back("limit");
    for (const ValidationRow& row : validation.rows) {
        table.rows.push_back(validation_cells(row));
        table.rows.back().push_back(row.limit);
    }
    return {table, error_summary_table(validation.summary)};
}

std::string deferred_page(const DeferredValidation& validation) {
    const std::string intro = fmt::format(
        "<p>{}</p>\n<p>{} The calibrated row decides {}.</p>\n<p>Null model: {} Skill: 1 - RMS error of the model over "
        "that of the null model, on the same numbers.</p>\n<p><b>{}</b></p>\n<p class=\"note\">ropsim {} ({}).</p>\n",
        escape_html(intro_text(validation)), status_reading, validation.parameter, constant_null_model,
        escape_html(error_sentences(validation.summary.back())), version_text(), escape_html(build_text()));
    return plot_page("Deferred shading: model and measurements", intro, {errors_plot(validation)},
                     {{"Errors, in natural logarithms", error_summary_html(validation.summary)},
                      {"Numbers", rows_html(validation)},
                      {"Misses above 25%", misses_html(deferred_misses(validation))}});
}

} // namespace reports
