#include "reports/geometry/page.hpp"

#include "reports/geometry/tables.hpp"
#include "reports/geometry/text.hpp"
#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/result.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace reports {

namespace {

std::string rows_html(const GeometryValidation& validation) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const ValidationRow& row : validation.rows) {
        const bool predicted = row.status == RowStatus::predicted;
        const char* colour = !predicted ? "number" : row.error() > large_miss ? "number bad" : "number good";
        rows.push_back({{row.table, ""},
                        {row.row, "name"},
                        {row.gpu, ""},
                        {row.unit, ""},
                        {published_text(row), "number"},
                        {fmt::format("{:.4g}", row.model), "number"},
                        {fmt::format("{:.3f}", row.ratio()), colour},
                        {std::string(sim::enum_name(row.status)), ""},
                        {std::string(sim::enum_name(row.origin)), ""},
                        {row.source, ""},
                        {row.parameter, ""},
                        {row.limit, ""},
                        {row.explanation, ""}});
    }
    return html_table({"table", "row", "GPU", "unit", "published", "model", "ratio", "status", "published number",
                       "from", "number it decides, or that decides it", "limit", "why it misses"},
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

// Predicted rows of a table, all GPUs, as ratios; rows that decide a number would all stand at 1.
Plot ratios(const GeometryValidation& validation) {
    Plot plot;
    plot.title = "Predicted rows: model over published";
    plot.y_title = "ratio";
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
            plot.lines.back().values[static_cast<std::size_t>(label - plot.labels.begin())] = row.ratio();
        }
    }
    return plot;
}

} // namespace

std::string validation_page(const GeometryValidation& validation, const std::vector<LeftOneOut>& entries) {
    const std::string intro = fmt::format(
        "<p>Geometry feed as published (Bavoil 2007, tables 3.1 to 3.4, figures 3.1 to 3.3) and as the model gives it. "
        "A <b>calibrated</b> row determined a number of its GPU, or a number was chosen with it in view; a "
        "<b>penalty</b> row states the size of a driver artefact; only <b>predicted</b> rows say how good the model "
        "is. Numbers that were <b>measured</b> are printed in the tables; of the figures only what the text "
        "<b>states</b> "
        "is left, and what can be <b>derived</b> from both: where that is an interval, a model within it has a ratio "
        "of 1.</p>\n<p class=\"note\">ropsim {} ({}); {}.</p>\n",
        version_text(), escape_html(build_text()), sim::enum_name(validation.fidelity));
    std::vector<PageSection> sections{{"Errors of predicted rows", ""}, {"Rows", rows_html(validation)}};
    for (const Table& table : validation_tables(validation, entries)) {
        if (table.name == "summary.csv") sections.front().html = table_html(table);
        if (table.name == "leave_one_out.csv")
            sections.push_back({"When another row determines a number (estimates)", table_html(table)});
    }
    return plot_page("Geometry feed: model and measurements", intro, {ratios(validation)}, sections);
}

} // namespace reports
