// Error against run time as text, table, document and page.
#include "reports/accuracy/accuracy.hpp"
#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/numbers.hpp"
#include "reports/result.hpp"
#include "reports/text_table.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace reports {

namespace {

// Letters that every file system takes.
std::string picture_name(const AccuracyPoint& point) {
    std::string name = point.name();
    for (char& letter : name)
        if (std::isalnum(static_cast<unsigned char>(letter)) == 0 &&
            std::string_view("=._-").find(letter) == std::string_view::npos)
            letter = '_';
    return name + ".png";
}

std::string figures_of(const Accuracy& accuracy) {
    std::string html;
    for (const AccuracyPoint& point : accuracy.points)
        if (!point.picture.pixels.empty())
            html += fmt::format("<figure><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\" loading=\"lazy\"></a>"
                                "<figcaption>{1}</figcaption></figure>\n",
                                escape_html(picture_name(point)), escape_html(point.name()));
    return html.empty() ? html : "<div class=\"pictures\">\n" + html + "</div>\n";
}

struct Column {
    const char* title;
    const char* unit;
    std::string (*cell)(const AccuracyPoint&);
};

std::string share_text(double share) { return fmt::format("{:.3f}", 100.0 * share); }

// What every form of the report shows of a point, the shares of shadows last.
std::vector<Column> columns_of(const Accuracy& accuracy) {
    std::vector<Column> columns{
        {"GPU time", "ms", [](const AccuracyPoint& point) { return fmt::format("{:.4f}", point.sim_ms); }},
        {"host time", "s", [](const AccuracyPoint& point) { return fmt::format("{:.2f}", point.host_s); }},
        {"RMSE", "", [](const AccuracyPoint& point) { return fmt::format("{:.5f}", point.error.rmse); }},
        {"mean", "", [](const AccuracyPoint& point) { return fmt::format("{:.5f}", point.error.mean); }},
        {"worst", "", [](const AccuracyPoint& point) { return fmt::format("{:.3f}", point.error.worst); }},
        {"wrong", "px", [](const AccuracyPoint& point) { return with_commas(point.wrong_pixels); }}};
    if (!accuracy.points.empty() && accuracy.points.front().error.shadows) {
        columns.push_back({"acne", "%", [](const AccuracyPoint& point) { return share_text(point.error.acne); }});
        columns.push_back(
            {"too dark", "%", [](const AccuracyPoint& point) { return share_text(point.error.too_dark); }});
        columns.push_back(
            {"too bright", "%", [](const AccuracyPoint& point) { return share_text(point.error.too_bright); }});
    }
    columns.push_back({"Pareto", "", [](const AccuracyPoint& point) {
                           return std::string(point.pareto        ? (point.pareto_host ? "GPU host" : "GPU")
                                              : point.pareto_host ? "host"
                                                                  : "");
                       }});
    return columns;
}

std::string beside_what(const Accuracy& accuracy) {
    if (!accuracy.against.empty()) return fmt::format("'{}' in submission order", accuracy.against);
    if (accuracy.rays > 0) return fmt::format("{} to the light from each point", counted(accuracy.rays, "ray"));
    return "all fragments of each pixel's ray";
}

std::string how_measured(const Accuracy& accuracy) {
    const ImageError& first = accuracy.points.front().error;
    std::string text =
        fmt::format("{}: {} x {}, {}, design {} on {}, beside {}", accuracy.scene.name, accuracy.width, accuracy.height,
                    accuracy.workload, fmt::join(accuracy.designs, ", "), accuracy.gpu, beside_what(accuracy));
    if (!accuracy.settings.empty()) text += fmt::format("; {}", fmt::join(accuracy.settings, ", "));
    return text + fmt::format(". {} compared, {} at silhouettes left out.", counted(first.compared, "pixel"),
                              with_commas(first.excluded));
}

// Along the front, the slowest point last.
Plot front_plot(const Accuracy& accuracy, bool host) {
    std::vector<const AccuracyPoint*> points;
    for (const AccuracyPoint& point : accuracy.points) points.push_back(&point);
    const auto time = [host](const AccuracyPoint& point) { return host ? point.host_s : point.sim_ms; };
    std::stable_sort(points.begin(), points.end(), [&](const auto* a, const auto* b) { return time(*a) < time(*b); });
    Plot plot;
    plot.title = host ? "Error over seconds of this machine" : "Error over milliseconds of the simulated GPU";
    plot.x_title = host ? "host time [s]" : "GPU time [ms]";
    plot.y_title = "RMSE";
    plot.lines = {{"all points", {}}, {"Pareto front", {}}};
    double best = INFINITY;
    for (const AccuracyPoint* point : points) {
        plot.labels.push_back(fmt::format("{:.4g}", time(*point)));
        best = std::min(best, point->error.rmse);
        plot.lines[0].values.push_back(point->error.rmse);
        plot.lines[1].values.push_back(best);
    }
    return plot;
}

} // namespace

nlohmann::ordered_json accuracy_json(const Accuracy& accuracy) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const AccuracyPoint& point : accuracy.points) {
        nlohmann::ordered_json knobs = nlohmann::ordered_json::object();
        for (const std::string& knob : point.knobs) {
            const std::size_t equals = knob.find('=');
            knobs[knob.substr(0, equals)] = knob.substr(equals + 1);
        }
        nlohmann::ordered_json json{{"workload", point.workload},       {"knobs", std::move(knobs)},
                                    {"sim_ms", point.sim_ms},           {"host_s", point.host_s},
                                    {"rmse", point.error.rmse},         {"mean", point.error.mean},
                                    {"worst", point.error.worst},       {"pareto", point.pareto},
                                    {"pareto_host", point.pareto_host}, {"compared", point.error.compared},
                                    {"excluded", point.error.excluded}, {"wrong_pixels", point.wrong_pixels}};
        if (!point.design.empty()) json["design"] = point.design;
        if (point.rival) json["rival"] = true;
        if (point.error.shadows) {
            json["acne"] = point.error.acne;
            json["too_dark"] = point.error.too_dark;
            json["too_bright"] = point.error.too_bright;
        }
        points.push_back(std::move(json));
    }
    nlohmann::ordered_json json{
        {"ropsim", {{"version", version_text()}, {"build", build_text()}}},
        {"scene",
         {{"name", accuracy.scene.name},
          {"hash", accuracy.scene.hash},
          {"width", accuracy.width},
          {"height", accuracy.height}}},
        {"workload", accuracy.workload},
        {"settings", accuracy.settings},
        {"designs", accuracy.designs},
        {"gpu", accuracy.gpu},
        {"rays", accuracy.rays},
        {"host", {{"truth_seconds", accuracy.truth_seconds}, {"truth_cached", accuracy.truth_cached}}},
        {"points", std::move(points)}};
    if (!accuracy.against.empty()) json["against"] = accuracy.against;
    return json;
}

std::string accuracy_text(const Accuracy& accuracy, TerminalStyle style) {
    const std::vector<Column> shown = columns_of(accuracy);
    std::vector<TextColumn> columns{{"knobs", "", true}};
    for (const Column& column : shown) columns.push_back({column.title, column.unit, false});
    std::vector<std::vector<std::string>> rows;
    for (const AccuracyPoint& point : accuracy.points) {
        rows.push_back({point.name()});
        for (const Column& column : shown) rows.back().push_back(column.cell(point));
    }
    return wrap(how_measured(accuracy), style.columns, 2) + "\n" + text_table(columns, rows, style);
}

Table accuracy_table(const Accuracy& accuracy) {
    const std::vector<Column> shown = columns_of(accuracy);
    Table table{"accuracy.csv", {"knobs"}, {}};
    for (const Column& column : shown)
        table.header.push_back(*column.unit == '\0' ? column.title : fmt::format("{} [{}]", column.title, column.unit));
    for (const AccuracyPoint& point : accuracy.points) {
        table.rows.push_back({point.name()});
        for (const Column& column : shown) table.rows.back().push_back(column.cell(point));
    }
    return table;
}

std::string accuracy_page(const Accuracy& accuracy) {
    const Table table = accuracy_table(accuracy);
    std::vector<std::vector<HtmlCell>> rows;
    for (const auto& row : table.rows) {
        rows.emplace_back();
        for (std::size_t i = 0; i < row.size(); ++i) rows.back().push_back({row[i], i == 0 ? "name" : "number"});
    }
    const std::string intro =
        fmt::format("<p>{}</p>\n<p class=\"note\">ropsim {} ({}). Wrong: pixels that hazards changed; the error "
                    "excuses none of them.{}</p>\n",
                    escape_html(how_measured(accuracy)), version_text(), escape_html(build_text()),
                    accuracy.points.front().error.shadows
                        ? " Acne: lit points that lost more than a quarter of the light. Too dark, too bright: further "
                          "points off by more than a tenth."
                        : "");
    std::vector<PageSection> sections{{"Points", html_table(table.header, rows)}};
    if (const std::string figures = figures_of(accuracy); !figures.empty())
        sections.push_back({"Beside the truth", figures});
    return plot_page("Error against run time", intro, {front_plot(accuracy, false), front_plot(accuracy, true)},
                     sections);
}

std::vector<std::string> write_accuracy_pictures(const Accuracy& accuracy, const std::filesystem::path& directory) {
    std::vector<std::string> names;
    for (const AccuracyPoint& point : accuracy.points) {
        if (point.picture.pixels.empty()) continue;
        names.push_back(picture_name(point));
        write_png(directory / names.back(), point.picture);
    }
    return names;
}

} // namespace reports
