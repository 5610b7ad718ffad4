#include "reports/stability/report.hpp"

#include "reports/html/markup.hpp"
#include "reports/text_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports::stability {

using nlohmann::ordered_json;

namespace {

std::string number(double value) { return fmt::format("{:.3g}", value); }

// A number that JSON can hold.
ordered_json finite_number(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr); }

std::string error_text(const Outcome& outcome) { return outcome.of->unit.empty() ? "" : number(outcome.error); }
std::string bound_text(const Outcome& outcome) { return outcome.of->unit.empty() ? "" : number(outcome.of->bound); }

std::string summary_of(const std::vector<Outcome>& outcomes) {
    const std::size_t failed = failures(outcomes);
    return fmt::format("{} case{}, {}", outcomes.size(), outcomes.size() == 1 ? "" : "s",
                       failed == 0 ? std::string("all as expected") : fmt::format("{} failed", failed));
}

std::string group_of(const Case& one) { return one.id.substr(0, one.id.find('.')); }

std::string file_name(const Outcome& outcome) { return outcome.of->id + ".png"; }

const std::vector<std::string>& page_header() {
    static const std::vector<std::string> header{
        "case", "stiff or extreme", "side", "expectation", "outcome", "error", "bound", "unit", "ok"};
    return header;
}

std::vector<HtmlCell> page_row(const Outcome& outcome) {
    const Case& one = *outcome.of;
    return {{one.id, "name"},
            {one.subject, ""},
            {std::string(sim::enum_name(one.side)), ""},
            {one.expectation, ""},
            {outcome.text, outcome.ok ? "" : "bad"},
            {error_text(outcome), "number"},
            {bound_text(outcome), "number"},
            {one.unit, ""},
            {outcome.ok ? "yes" : "NO", outcome.ok ? "good" : "bad"}};
}

std::vector<PageSection> case_sections(const std::vector<Outcome>& outcomes) {
    std::vector<PageSection> sections;
    for (auto begin = outcomes.begin(); begin != outcomes.end();) {
        const std::string group = group_of(*begin->of);
        std::vector<std::vector<HtmlCell>> rows;
        for (; begin != outcomes.end() && group_of(*begin->of) == group; ++begin) rows.push_back(page_row(*begin));
        sections.push_back({fmt::format("{} ({})", group, rows.size()),
                            "<div class=\"scroll\">" + html_table(page_header(), rows) + "</div>\n"});
    }
    return sections;
}

std::string figures(const std::vector<Outcome>& outcomes) {
    std::string html = "<div class=\"pictures\">\n";
    for (const Outcome& outcome : outcomes)
        if (!outcome.picture.pixels.empty())
            html += fmt::format("<figure class=\"magnified\"><img src=\"{0}\" alt=\"{1}\">"
                                "<figcaption>{1}: {2}</figcaption></figure>\n",
                                escape_html(file_name(outcome)), escape_html(outcome.of->id),
                                escape_html(outcome.of->subject));
    return html + "</div>\n";
}

std::string curves_html(const std::vector<Curve>& curves) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const Curve& curve : curves)
        rows.push_back({{curve.id, "name"},
                        {curve.formula, ""},
                        {number(curve.fewest_digits), "number"},
                        {fmt::format("{} = {}", curve.plot.x_title, number(curve.worst_input)), ""},
                        {curve.guard, ""}});
    return html_table({"formula", "what is computed", "fewest right digits", "at", "what keeps them"}, rows);
}

} // namespace

std::size_t failures(const std::vector<Outcome>& outcomes) {
    return static_cast<std::size_t>(
        std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& outcome) { return !outcome.ok; }));
}

std::string text_of(const std::vector<Outcome>& outcomes, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    std::string failed;
    for (const Outcome& outcome : outcomes) {
        const Case& one = *outcome.of;
        rows.push_back({one.id, std::string(sim::enum_name(one.side)), error_text(outcome), bound_text(outcome),
                        one.unit, outcome.ok ? "ok" : "FAILED"});
        if (!outcome.ok)
            failed += wrap(fmt::format("  {}: expected {}; {}{}", one.id, one.expectation, outcome.text,
                                       one.unit.empty() ? ""
                                                        : fmt::format(" (error {} {}, bound {})", error_text(outcome),
                                                                      one.unit, bound_text(outcome))),
                           style.columns, 4);
    }
    const std::vector<TextColumn> columns{{"case", "", true},   {"side", "", true}, {"error", "", false},
                                          {"bound", "", false}, {"unit", "", true}, {"", "", true}};
    std::string text = text_table(columns, rows, style) + "\n" + summary_of(outcomes) + "\n";
    if (!failed.empty()) text += "Failed:\n" + failed;
    return text;
}

ordered_json json_of(const std::vector<Outcome>& outcomes, const std::vector<Curve>& curves) {
    ordered_json cases = ordered_json::array();
    for (const Outcome& outcome : outcomes) {
        const Case& one = *outcome.of;
        cases.push_back({{"id", one.id},
                         {"subject", one.subject},
                         {"side", sim::enum_name(one.side)},
                         {"expectation", one.expectation},
                         {"outcome", outcome.text},
                         {"error", finite_number(outcome.error)},
                         {"bound", one.bound},
                         {"unit", one.unit},
                         {"ok", outcome.ok}});
    }
    ordered_json formulas = ordered_json::array();
    for (const Curve& curve : curves) {
        ordered_json lines = ordered_json::array();
        for (const PlotLine& line : curve.plot.lines) lines.push_back({{"name", line.name}, {"digits", line.values}});
        formulas.push_back({{"id", curve.id},
                            {"formula", curve.formula},
                            {"guard", curve.guard},
                            {"fewest_digits", curve.fewest_digits},
                            {"worst_input", curve.worst_input},
                            {"input", curve.plot.x_title},
                            {"inputs", curve.plot.labels},
                            {"lines", std::move(lines)}});
    }
    return {{"cases", std::move(cases)},
            {"summary", {{"cases", outcomes.size()}, {"failed", failures(outcomes)}}},
            {"conditioning", std::move(formulas)}};
}

Table table_of(const std::vector<Outcome>& outcomes) {
    Table table{
        "stability.csv", {"case", "subject", "side", "expectation", "outcome", "error", "bound", "unit", "ok"}, {}};
    for (const Outcome& outcome : outcomes) {
        const Case& one = *outcome.of;
        table.rows.push_back({one.id, one.subject, std::string(sim::enum_name(one.side)), one.expectation, outcome.text,
                              error_text(outcome), bound_text(outcome), one.unit, outcome.ok ? "yes" : "no"});
    }
    return table;
}

Table curves_table(const std::vector<Curve>& curves) {
    Table table{"conditioning.csv", {"formula", "line", "input", "value", "right digits"}, {}};
    for (const Curve& curve : curves)
        for (const PlotLine& line : curve.plot.lines)
            for (std::size_t i = 0; i < line.values.size(); ++i)
                table.rows.push_back(
                    {curve.id, line.name, curve.plot.x_title, curve.plot.labels[i], number(line.values[i])});
    return table;
}

std::vector<std::pair<std::string, const Picture*>> pictures_of(const std::vector<Outcome>& outcomes) {
    std::vector<std::pair<std::string, const Picture*>> pictures;
    for (const Outcome& outcome : outcomes)
        if (!outcome.picture.pixels.empty()) pictures.emplace_back(file_name(outcome), &outcome.picture);
    return pictures;
}

std::string page_of(const std::vector<Outcome>& outcomes, const std::vector<Curve>& curves, bool with_pictures) {
    std::vector<PageSection> sections;
    std::vector<Plot> plots;
    for (const Curve& curve : curves) plots.push_back(curve.plot);
    if (!curves.empty())
        sections.push_back(
            {"Formulas that cancel",
             "<p>Right decimal digits of the program's own functions beside an evaluation with 113 bits; "
             "binary32 holds 7.2 of them, binary64 16.</p>\n<div class=\"scroll\">" +
                 curves_html(curves) + "</div>\n"});
    std::vector<std::vector<HtmlCell>> failed;
    for (const Outcome& outcome : outcomes)
        if (!outcome.ok) failed.push_back(page_row(outcome));
    if (!failed.empty()) sections.push_back({"Failed", html_table(page_header(), failed)});
    if (with_pictures && !pictures_of(outcomes).empty()) sections.push_back({"Pictures", figures(outcomes)});
    for (PageSection& section : case_sections(outcomes)) sections.push_back(std::move(section));
    return plot_page("stiff and extreme cases", fmt::format("<p>{}.</p>\n", summary_of(outcomes)), plots, sections);
}

} // namespace reports::stability
