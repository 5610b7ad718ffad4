// Studies as text, table, document and page.
#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/numbers.hpp"
#include "reports/result.hpp"
#include "reports/study.hpp"
#include "reports/text_table.hpp"

#include <fmt/format.h>
#include <map>

namespace reports {

namespace {

const std::map<std::string, std::string>& measure_titles() {
    static const std::map<std::string, std::string> titles{{"fps", "frames per second"},
                                                           {"ms", "milliseconds"},
                                                           {"vertices_per_s", "vertices per second"},
                                                           {"triangles_per_s", "triangles per second"},
                                                           {"acmr", "vertices shaded per triangle (ACMR)"},
                                                           {"overfetch", "bytes fetched per byte of vertices"},
                                                           {"bytes", "bytes fetched"}};
    return titles;
}

std::string line_name(const StudyResult& result, const StudyValue& value) {
    if (result.study.gpus.size() == 1) return value.series;
    return result.study.series.size() == 1 ? value.gpu : fmt::format("{}, {}", value.series, value.gpu);
}

std::string number_text(double number) {
    return number >= 10000 ? short_number(number) : fmt::format("{:.4g}", number);
}

Plot plot_of(const StudyResult& result) {
    Plot plot;
    plot.title = result.study.title;
    plot.x_title = result.study.x;
    plot.y_title = measure_titles().at(result.study.measure);
    plot.logarithmic = result.study.logarithmic;
    for (const auto& point : result.study.points) plot.labels.push_back(point.at("x"));
    const std::size_t lines = result.study.series.size() * result.study.gpus.size();
    for (std::size_t i = 0; i < lines; ++i) {
        plot.lines.push_back({line_name(result, result.values[i]), {}});
        for (std::size_t point = 0; point < plot.labels.size(); ++point)
            plot.lines.back().values.push_back(result.values[point * lines + i].measure);
    }
    return plot;
}

std::vector<std::vector<HtmlCell>> html_rows(const Table& table) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const auto& row : table.rows) {
        rows.emplace_back();
        for (std::size_t i = 0; i < row.size(); ++i)
            rows.back().push_back({row[i], i < 3 || i + 1 == row.size() ? "" : "number"});
    }
    return rows;
}

} // namespace

std::string studies_text(const std::vector<std::string>& names, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const std::string& name : names) {
        const Study study = load_study(name);
        rows.push_back({name, study.question});
    }
    return text_table({{"study", "", true}, {"question", "", true}}, rows, style.colour);
}

// One row per point, one column per line of the plot.
std::string study_text(const StudyResult& result, TerminalStyle style) {
    const Plot plot = plot_of(result);
    std::vector<TextColumn> columns{{result.study.x, "", true}};
    std::vector<std::vector<std::string>> rows(plot.labels.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(plot.labels[i]);
    for (const PlotLine& line : plot.lines) {
        columns.push_back({line.name, "", false});
        for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(number_text(line.values[i]));
    }
    return wrap(fmt::format("{} {}", result.study.title + ":", result.study.question), style.columns, 2) +
           fmt::format("{}; {}\n\n", plot.y_title, sim::enum_name(result.fidelity)) +
           text_table(columns, rows, style.colour);
}

Table study_table(const StudyResult& result) {
    Table table;
    table.name = "study.csv";
    table.header = {result.study.x, "series", "gpu",       "frames/s",  "time [ms]", "vertices/s",
                    "triangles/s",  "ACMR",   "overfetch", "bytes [B]", "draws",     "limit"};
    for (const StudyValue& value : result.values)
        table.rows.push_back({value.x, value.series, value.gpu, fmt::format("{:.6g}", value.fps),
                              fmt::format("{:.6g}", value.milliseconds),
                              fmt::format("{:.6g}", value.vertices_per_second),
                              fmt::format("{:.6g}", value.triangles_per_second), fmt::format("{:.6g}", value.acmr),
                              fmt::format("{:.6g}", value.overfetch), fmt::format("{:.0f}", value.bytes),
                              std::to_string(value.draws), value.limit});
    return table;
}

nlohmann::ordered_json study_json(const StudyResult& result) {
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    for (const StudyValue& value : result.values)
        values.push_back({{"x", value.x},
                          {"series", value.series},
                          {"gpu", value.gpu},
                          {"fps", value.fps},
                          {"milliseconds", value.milliseconds},
                          {"vertices_per_second", value.vertices_per_second},
                          {"triangles_per_second", value.triangles_per_second},
                          {"acmr", value.acmr},
                          {"overfetch", value.overfetch},
                          {"bytes", value.bytes},
                          {"draws", value.draws},
                          {"limit", value.limit}});
    return {{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
            {"study", result.study.name},
            {"title", result.study.title},
            {"question", result.study.question},
            {"source", result.study.source},
            {"x", result.study.x},
            {"measure", result.study.measure},
            {"fidelity", sim::enum_name(result.fidelity)},
            {"values", std::move(values)}};
}

std::string study_page(const StudyResult& result) {
    const Table table = study_table(result);
    std::string intro = fmt::format("<p>{}</p>\n", escape_html(result.study.question));
    if (!result.study.source.empty())
        intro += fmt::format("<p class=\"note\">{}</p>\n", escape_html(result.study.source));
    intro += fmt::format("<p class=\"note\">ropsim {} ({}); {}.</p>\n", version_text(), escape_html(build_text()),
                         sim::enum_name(result.fidelity));
    return plot_page(result.study.title, intro, {plot_of(result)},
                     {{"Table", html_table(table.header, html_rows(table))}});
}

} // namespace reports
