#include "reports/peeling/report.hpp"

#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/result.hpp"
#include "reports/text_table.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports {

using nlohmann::ordered_json;

namespace {

std::string number(double value) { return fmt::format("{:.4g}", value); }

std::string range_text(const PeelingNumber& one) {
    return fmt::format("{} to {}", number(one.row.low), number(one.row.high));
}

std::string uncertainty_text(const PeelingNumber& one) {
    return one.uncertainty > 0 ? fmt::format("{:.1f}%", 100 * one.uncertainty) : "";
}

std::string status_text(const PeelingNumber& one) { return std::string(sim::enum_name(one.row.status)); }

std::string summary_text(const PeelingValidation& validation) {
    const ErrorSpread& all = validation.summary.predicted;
    return fmt::format("{} predicted numbers miss the range of rounding by {:.1f}% in the median, by {:.1f}% at most "
                       "({}).",
                       all.rows, 100 * all.median, 100 * all.worst, all.worst_row);
}

Plot ratios(const PeelingValidation& validation) {
    Plot plot;
    plot.title = "Predicted numbers: model over published";
    plot.y_title = "ratio";
    plot.bars = true;
    plot.lines.push_back({validation.gpu, {}});
    for (const PeelingNumber& one : validation.numbers) {
        if (one.row.status != RowStatus::predicted) continue;
        plot.labels.push_back(one.row.row);
        plot.lines.front().values.push_back(one.row.ratio());
    }
    return plot;
}

std::string rows_html(const PeelingValidation& validation) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const PeelingNumber& one : validation.numbers) {
        const bool predicted = one.row.status == RowStatus::predicted;
        rows.push_back({{one.row.row, "name"},
                        {one.row.unit, ""},
                        {number(one.printed), "number"},
                        {range_text(one), "number"},
                        {number(one.row.model), "number"},
                        {uncertainty_text(one), "number"},
                        {fmt::format("{:.3f}", one.row.ratio()), !predicted                     ? "number"
                                                                 : one.row.error() > large_miss ? "number bad"
                                                                                                : "number good"},
                        {status_text(one), ""},
                        {one.row.parameter, ""}});
    }
    return html_table({"number", "unit", "published", "rounding range", "model", "line +-", "ratio", "status",
                       "parameter it decides"},
                      rows);
}

/// Numbers that are missed for one reason.
struct Misses {
    std::string numbers, reason;
};

std::vector<Misses> large_misses(const PeelingValidation& validation) {
    std::vector<Misses> all;
    for (const PeelingNumber& one : validation.numbers) {
        if (one.row.error() <= large_miss) continue;
        const std::string name = fmt::format("{} ({})", one.row.row, status_text(one));
        const std::string reason = one.row.explanation.empty() ? "not explained" : one.row.explanation;
        const auto same =
            std::find_if(all.begin(), all.end(), [&](const Misses& miss) { return miss.reason == reason; });
        if (same == all.end())
            all.push_back({name, reason});
        else
            same->numbers += "; " + name;
    }
    return all;
}

std::string misses_html(const PeelingValidation& validation) {
    std::string html;
    for (const Misses& miss : large_misses(validation))
        html += fmt::format("<p><b>{}</b>: {}</p>\n", escape_html(miss.numbers), escape_html(miss.reason));
    return html.empty() ? "<p>None.</p>\n" : html;
}

} // namespace

std::string peeling_text(const PeelingValidation& validation, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const PeelingNumber& one : validation.numbers)
        rows.push_back({one.row.row, one.row.unit, number(one.printed), range_text(one), number(one.row.model),
                        uncertainty_text(one), fmt::format("{:.3f}", one.row.ratio()), status_text(one),
                        one.row.parameter});
    std::string explanations;
    for (const Misses& miss : large_misses(validation))
        explanations += wrap(fmt::format("  {}: {}", miss.numbers, miss.reason), style.columns, 4);
    std::string text = wrap(fmt::format("Depth peeling on {} as published ({}) and on the model, {}. Ratio: model over "
                                        "the nearest number that is rounded to the published one. Line: how far the "
                                        "line through the stand-ins may miss the whole mesh, if its slope goes on "
                                        "changing as it did between them.",
                                        validation.gpu, validation.source, sim::enum_name(validation.fidelity)),
                            style.columns, 0) +
                       "\n" +
                       text_table({{"number", "", true},
                                   {"unit", "", true},
                                   {"published", ""},
                                   {"rounding range", ""},
                                   {"model", ""},
                                   {"line", "+-"},
                                   {"ratio", ""},
                                   {"status", "", true},
                                   {"parameter it decides", "", true}},
                                  rows, style.colour);
    text += "\n" + wrap(summary_text(validation), style.columns, 0);
    if (!explanations.empty()) text += "\nMisses above 25%:\n" + explanations;
    return text;
}

ordered_json peeling_json(const PeelingValidation& validation) {
    ordered_json rows = ordered_json::array();
    for (const PeelingNumber& one : validation.numbers) {
        ordered_json json = {
            {"table", one.row.table},         {"row", one.row.row},         {"gpu", one.row.gpu},
            {"unit", one.row.unit},           {"published", one.printed},   {"published_least", one.row.low},
            {"published_most", one.row.high}, {"model", one.row.model},     {"line_error", one.uncertainty},
            {"ratio", one.row.ratio()},       {"status", status_text(one)}, {"origin", sim::enum_name(one.row.origin)}};
        if (!one.row.source.empty()) json["source"] = one.row.source;
        if (!one.row.parameter.empty()) json["parameter"] = one.row.parameter;
        if (!one.row.explanation.empty()) json["explanation"] = one.row.explanation;
        rows.push_back(std::move(json));
    }
    const ErrorSpread& predicted = validation.summary.predicted;
    return {{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
            {"source", validation.source},
            {"fidelity", sim::enum_name(validation.fidelity)},
            {"host", {{"run_seconds", validation.host_seconds}}},
            {"rows", std::move(rows)},
            {"summary",
             {{"predicted_rows", predicted.rows},
              {"median_predicted_error", predicted.median},
              {"worst_predicted_error", predicted.worst},
              {"worst_row", predicted.worst_row}}}};
}

Table peeling_table(const PeelingValidation& validation) {
    Table table{"validation.csv",
                {"number", "unit", "published", "published, least", "published, most", "model", "line error", "ratio",
                 "status", "origin", "parameter", "explanation"},
                {}};
    for (const PeelingNumber& one : validation.numbers)
        table.rows.push_back({one.row.row, one.row.unit, number(one.printed), number(one.row.low), number(one.row.high),
                              number(one.row.model), number(one.uncertainty), number(one.row.ratio()), status_text(one),
                              std::string(sim::enum_name(one.row.origin)), one.row.parameter, one.row.explanation});
    return table;
}

std::string peeling_page(const PeelingValidation& validation) {
    const std::string intro = fmt::format(
        "<p>Depth peeling as published ({}) and as the model gives it. A <b>calibrated</b> number decided a parameter "
        "of the GPU; the others are <b>predicted</b>. The ratio is that to the nearest number which is rounded to the "
        "published one. Meshes that are not run whole are read off a line through runs of stand-ins; beside the model "
        "stands by how much that line may miss, if its slope goes on changing as it did between them.</p>\n"
        "<p>{}</p>\n<p class=\"note\">ropsim {} ({}); {}.</p>\n",
        escape_html(validation.source), escape_html(summary_text(validation)), version_text(),
        escape_html(build_text()), sim::enum_name(validation.fidelity));
    return plot_page("Depth peeling: model and measurements", intro, {ratios(validation)},
                     {{"Numbers", rows_html(validation)}, {"Misses above 25%", misses_html(validation)}});
}

} // namespace reports
