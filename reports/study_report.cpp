// Studies as text, table, document and page.
#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/numbers.hpp"
#include "reports/result.hpp"
#include "reports/study.hpp"
#include "reports/study_runs.hpp"
#include "reports/text_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/ranges.h>
#include <map>
#include <nlohmann/json.hpp>

namespace reports {

namespace {

std::string line_name(const StudyResult& result, const StudyValue& value) {
    if (result.study.gpus.size() == 1) return value.series;
    return result.study.series.size() == 1 ? value.gpu : fmt::format("{}, {}", value.series, value.gpu);
}

std::string title_of(const StudyMeasure& measure) {
    return measure.over.empty() ? measure.title : fmt::format("{}, over {}", measure.title, measure.over);
}

std::string number_text(double number) {
    if (std::isnan(number)) return "-";
    return number >= 10000 ? short_number(number) : fmt::format("{:.4g}", number);
}

Plot plot_of(const StudyResult& result, std::size_t measure) {
    const Study& study = result.study;
    Plot plot;
    plot.x_title = study.x;
    plot.y_title = title_of(study.measures[measure]);
    plot.title = study.measures.size() == 1 ? study.title : plot.y_title;
    plot.logarithmic = study.logarithmic;
    for (const StudyPoint& point : study.points) plot.labels.push_back(point.at("x"));
    const std::size_t lines = study.series.size() * study.gpus.size();
    for (std::size_t i = 0; i < lines; ++i) {
        plot.lines.push_back({line_name(result, result.values[i]), {}});
        for (std::size_t point = 0; point < plot.labels.size(); ++point) {
            const StudyValue& value = result.values[point * lines + i];
            plot.lines.back().values.push_back(study.of_designs() ? value.numbers[measure].mean
                                                                  : measure_of(value, study.measures[measure].value));
        }
    }
    return plot;
}

std::vector<Plot> plots_of(const StudyResult& result) {
    std::vector<Plot> plots;
    for (std::size_t i = 0; i < result.study.measures.size(); ++i) plots.push_back(plot_of(result, i));
    return plots;
}

// One row per point, one column per line of the plot.
std::string plot_text(const Plot& plot, TerminalStyle style) {
    std::vector<TextColumn> columns{{plot.x_title, "", true}};
    std::vector<std::vector<std::string>> rows(plot.labels.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(plot.labels[i]);
    for (const PlotLine& line : plot.lines) {
        columns.push_back({line.name, "", false});
        for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(number_text(line.values[i]));
    }
    return text_table(columns, rows, style);
}

std::string how_run(const StudyResult& result) {
    const Study& study = result.study;
    if (!study.of_designs()) return std::string(sim::enum_name(result.fidelity));
    const std::string seeds = study.seeds == 1 ? "one run" : "mean of " + counted(study.seeds, "seed");
    const std::string first = filled(study.size, study.points.front(), study),
                      last = filled(study.size, study.points.back(), study);
    return fmt::format("{} pixels, {}", first == last ? first : fmt::format("{} to {}", first, last), seeds);
}

// Columns of the table: numbers of geometry feed under short names with units, those of designs under their titles.
std::string column_of(const StudyResult& result, std::size_t number) {
    static const std::map<std::string, std::string> short_names{{"fps", "frames/s"},
                                                                {"ms", "time [ms]"},
                                                                {"vertices_per_s", "vertices/s"},
                                                                {"triangles_per_s", "triangles/s"},
                                                                {"acmr", "ACMR"},
                                                                {"bytes", "bytes [B]"}};
    if (result.study.of_designs()) return title_of(result.study.measures[number]);
    const std::string& value = result.values.front().numbers[number].value;
    const auto found = short_names.find(value);
    return found == short_names.end() ? value : found->second;
}

std::vector<std::vector<HtmlCell>> html_rows(const Table& table) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const auto& row : table.rows) {
        rows.emplace_back();
        for (std::size_t i = 0; i < row.size(); ++i)
            rows.back().push_back({row[i], i < 3 || table.header[i] == "limit" ? "" : "number"});
    }
    return rows;
}

std::string paragraph(const std::string& text, const char* kind) {
    return text.empty() ? "" : fmt::format("<p{}>{}</p>\n", kind, escape_html(text));
}

nlohmann::ordered_json numbers_json(const StudyResult& result, const StudyValue& value) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < value.numbers.size(); ++i) {
        const StudyNumber& number = value.numbers[i];
        const std::string over = result.study.of_designs() ? result.study.measures[i].over : "";
        const std::string key = over.empty() ? number.value : fmt::format("{}, over {}", number.value, over);
        if (result.study.seeds == 1)
            json[key] = number.mean;
        else
            json[key] = {{"mean", number.mean}, {"low", number.low}, {"high", number.high}};
    }
    return json;
}

} // namespace

std::string nothing_drawn(const StudyResult& result) {
    const std::size_t lines = result.study.series.size() * result.study.gpus.size();
    std::map<std::string, std::vector<std::string>> empty; // points by line
    for (std::size_t i = 0; i < result.values.size(); ++i)
        if (!result.values[i].drew) empty[line_name(result, result.values[i])].push_back(result.values[i].x);
    if (empty.empty()) return "";
    const auto& first = empty.begin()->second;
    const bool all = empty.size() == lines &&
                     std::all_of(empty.begin(), empty.end(), [&](const auto& line) { return line.second == first; });
    std::vector<std::string> where;
    if (all)
        where.push_back(fmt::format("{} = {}", result.study.x, fmt::join(first, ", ")));
    else
        for (const auto& [line, points] : empty)
            where.push_back(fmt::format("{} = {} of {}", result.study.x, fmt::join(points, ", "), line));
    return fmt::format("no fragment reached the pixels at {}: numbers of these points say nothing",
                       fmt::join(where, "; "));
}

std::string studies_text(const std::vector<std::string>& names, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const std::string& name : names) {
        const Study study = load_study(name);
        rows.push_back({name, study.question});
    }
    return text_table({{"study", "", true}, {"question", "", true}}, rows, style);
}

std::string study_text(const StudyResult& result, TerminalStyle style) {
    std::string text = wrap(fmt::format("{} {}", result.study.title + ":", result.study.question), style.columns, 2);
    for (const Plot& plot : plots_of(result))
        text += fmt::format("{}; {}\n\n{}\n", plot.y_title, how_run(result), plot_text(plot, style));
    if (!result.study.answer.empty())
        text += wrap(fmt::format("Answer on record: {}", result.study.answer), style.columns, 2);
    return text;
}

Table study_table(const StudyResult& result) {
    const bool spread = result.study.seeds > 1, limits = !result.study.of_designs();
    Table table;
    table.name = "study.csv";
    table.header = {result.study.x, "series", "gpu"};
    for (std::size_t i = 0; i < result.values.front().numbers.size(); ++i) {
        const std::string column = column_of(result, i);
        table.header.push_back(column);
        if (!spread) continue;
        table.header.push_back(column + ", lowest");
        table.header.push_back(column + ", highest");
    }
    if (limits) table.header.emplace_back("limit");
    const auto cell = [](double number) { return std::isnan(number) ? "" : fmt::format("{:.6g}", number); };
    for (const StudyValue& value : result.values) {
        std::vector<std::string> row{value.x, value.series, value.gpu};
        for (const StudyNumber& number : value.numbers) {
            row.push_back(cell(number.mean));
            if (!spread) continue;
            row.push_back(cell(number.low));
            row.push_back(cell(number.high));
        }
        if (limits) row.push_back(value.limit);
        table.rows.push_back(std::move(row));
    }
    return table;
}

nlohmann::ordered_json study_json(const StudyResult& result) {
    const Study& study = result.study;
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    for (const StudyValue& value : result.values) {
        nlohmann::ordered_json json{{"x", value.x}, {"series", value.series}, {"gpu", value.gpu}};
        json.update(numbers_json(result, value));
        if (!study.of_designs()) json["limit"] = value.limit;
        values.push_back(std::move(json));
    }
    nlohmann::ordered_json measures = nlohmann::ordered_json::array();
    for (const StudyMeasure& measure : study.measures) measures.push_back(measure.value);
    nlohmann::ordered_json json{{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
                                {"study", study.name},
                                {"title", study.title},
                                {"question", study.question},
                                {"answer", study.answer},
                                {"source", study.source},
                                {"x", study.x},
                                {"measures", std::move(measures)}};
    if (study.of_designs()) {
        json["size"] = study.size;
        json["seeds"] = study.seeds;
    } else {
        json["fidelity"] = sim::enum_name(result.fidelity);
    }
    json["values"] = std::move(values);
    return json;
}

std::string study_page(const StudyResult& result) {
    const Table table = study_table(result);
    const std::string intro = paragraph(result.study.question, "") + paragraph(result.study.answer, "") +
                              paragraph(nothing_drawn(result), "") + paragraph(result.study.source, " class=\"note\"") +
                              fmt::format("<p class=\"note\">ropsim {} ({}); {}.</p>\n", version_text(),
                                          escape_html(build_text()), how_run(result));
    return plot_page(result.study.title, intro, plots_of(result),
                     {{"Table", html_table(table.header, html_rows(table))}});
}

} // namespace reports
