#include "reports/geometry/page.hpp"

#include "reports/geometry/tables.hpp"
#include "reports/geometry/text.hpp"
#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/result.hpp"
#include "reports/validation/error_report.hpp"
#include "reports/validation/null_models.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace reports {

namespace {

std::string rows_html(const GeometryValidation& validation) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const ValidationRow& row : validation.rows) {
        const char* colour = row.status != RowStatus::predicted ? "number"
                             : row.missed()                     ? "number bad"
                                                                : "number good";
        rows.push_back({{row.table, ""},
                        {row.row, "name"},
                        {row.gpu, ""},
                        {row.unit, ""},
                        {published_text(row), "number"},
                        {fmt::format("{:.4g}", row.model), "number"},
                        {error_text(row.log_error()), colour},
                        {error_in_sigma_text(row), "number"},
                        {row_status_text(row), ""},
                        {row.null_model > 0 ? fmt::format("{:.4g}", row.null_model) : "", "number"},
                        {std::string(sim::enum_name(row.origin)), ""},
                        {row.source, ""},
                        {row.parameter, ""},
                        {row.limit, ""},
                        {row.explanation, ""}});
    }
    return html_table({"table", "row", "GPU", "unit", "published", "model", "error (ln)", "in sigmas", "status",
                       "null model", "published number", "from", "number it decides, or that decides it", "limit",
                       "why it misses"},
                      rows);
}

std::string table_html(const Table& table) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const auto& row : table.rows) {
        rows.emplace_back();
        for (const std::string& cell : row) rows.back().push_back({cell, ""});
    }
    return html_table(table.header, rows);
}

// Predicted rows of a table, all GPUs; rows that decide a number would all stand at 0.
Plot predicted_errors(const GeometryValidation& validation) {
    Plot plot;
    plot.title = "Predicted rows: ln(model / published)";
    plot.y_title = "error";
    plot.bars = true;
    std::vector<std::string> gpus;
    for (const ValidationRow& row : validation.rows) {
        if (row.status != RowStatus::predicted) continue;
        const std::string label = row.key();
        if (std::find(plot.labels.begin(), plot.labels.end(), label) == plot.labels.end()) plot.labels.push_back(label);
        if (std::find(gpus.begin(), gpus.end(), row.gpu) == gpus.end()) gpus.push_back(row.gpu);
    }
    for (const std::string& gpu : gpus) {
        plot.lines.push_back({gpu, std::vector<double>(plot.labels.size(), std::nan(""))});
        for (const ValidationRow& row : validation.rows) {
            if (row.gpu != gpu || row.status != RowStatus::predicted) continue;
            const auto label = std::find(plot.labels.begin(), plot.labels.end(), row.key());
            plot.lines.back().values[static_cast<std::size_t>(label - plot.labels.begin())] = row.log_error();
        }
    }
    return plot;
}

} // namespace

std::string validation_page(const GeometryValidation& validation, const std::vector<LeftOneOut>& entries) {
    const std::string intro = fmt::format(
        "<p>Geometry feed as published (Bavoil 2007, tables 3.1 to 3.4, figures 3.1 to 3.3) and as the model gives it. "
        "{}</p>\n<p>{} Of the figures only what the text <b>states</b> is left, and what can be <b>derived</b> from "
        "it and the tables: where that is an interval, a model within it has no error.</p>\n<p>Null model: {} "
        "Skill: 1 - RMS error of the model over that of the null model, on the same rows.</p>\n<p><b>{}</b></p>\n"
        "<p class=\"note\">ropsim {} ({}); {}.</p>\n",
        error_reading, status_reading, geometry_null_model, escape_html(error_sentences(validation.summary.back())),
        version_text(), escape_html(build_text()), sim::enum_name(validation.fidelity));
    std::vector<PageSection> sections{{"Errors of rows, in natural logarithms", error_summary_html(validation.summary)},
                                      {"Rows", rows_html(validation)}};
    for (const Table& table : validation_tables(validation, entries))
        if (table.name == "leave_one_out.csv")
            sections.push_back({"When another row determines a number (estimates)", table_html(table)});
    return plot_page("Geometry feed: model and measurements", intro, {predicted_errors(validation)}, sections);
}

} // namespace reports
