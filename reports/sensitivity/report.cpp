// A sensitivity analysis as text, JSON, tables and a page.
#include "reports/hazard_text.hpp"
#include "reports/html/markup.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/numbers.hpp"
#include "reports/result.hpp"
#include "reports/sensitivity/sensitivity.hpp"
#include "reports/text_table.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;
using pipeline::HazardKind;

namespace {

constexpr std::array<HazardKind, pipeline::hazard_kinds> both_kinds{HazardKind::concurrency, HazardKind::incoherence};

std::string percent(double share) { return fmt::format("{:+.1f} %", 100 * share); }

double change_of(const SensitivityRun& run, const SensitivityRun& base) {
    return run.milliseconds / base.milliseconds - 1;
}

std::string conditions(const Sensitivity& result) {
    return fmt::format("{}, {} at {} x {}; GPU {}; one parameter at a time over and times {:g}; seed {}",
                       result.scene.name, result.workload, result.width, result.height, result.gpu, result.factor,
                       result.seed);
}

std::string tried(const SensitivityParameter& parameter) {
    std::string text;
    for (const SensitivityStep& step : parameter.steps)
        text += (text.empty() ? "" : ", ") + step.value + (step.refused.empty() ? "" : " (refused)");
    return text;
}

/// Of all designs and values: the lowest and highest change of time, the most that a count grew or shrank.
struct Effect {
    double low = 0, high = 0;
    std::array<double, pipeline::hazard_kinds> hazards{}; ///< largest change, as a share of the base's
    double wrong = 0;
    bool ranks = false;
};

double stronger(double known, double next) { return std::abs(next) > std::abs(known) ? next : known; }

double relative(std::uint64_t now, std::uint64_t before) {
    if (before == 0) return now == 0 ? 0.0 : std::numeric_limits<double>::infinity();
    return static_cast<double>(now) / static_cast<double>(before) - 1;
}

Effect effect_of(const Sensitivity& result, const SensitivityParameter& parameter) {
    Effect effect;
    for (const SensitivityStep& step : parameter.steps)
        for (std::size_t i = 0; i < step.runs.size(); ++i) {
            const SensitivityRun &run = step.runs[i], &base = result.base[i];
            effect.low = std::min(effect.low, change_of(run, base));
            effect.high = std::max(effect.high, change_of(run, base));
            for (const HazardKind kind : both_kinds) {
                double& known = effect.hazards[static_cast<std::size_t>(kind)];
                known = stronger(known, relative(run.hazards.of(kind), base.hazards.of(kind)));
            }
            effect.wrong = stronger(effect.wrong, relative(run.wrong_pixels, base.wrong_pixels));
            effect.ranks = effect.ranks || run.rank != base.rank;
        }
    return effect;
}

std::string share_text(double share) {
    if (share == 0) return "";
    return std::isinf(share) ? "from 0" : percent(share);
}

const std::vector<std::string>& base_header() {
    static const std::vector<std::string> header{"design",      "rank",        "cycles",
                                                 "concurrency", "incoherence", "wrong pixels"};
    return header;
}

std::vector<std::vector<std::string>> base_rows(const Sensitivity& result) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < result.base.size(); ++i) {
        const SensitivityRun& run = result.base[i];
        rows.push_back({result.designs[i].label, std::to_string(run.rank), with_commas(run.cycles),
                        with_commas(run.hazards.of(HazardKind::concurrency)),
                        with_commas(run.hazards.of(HazardKind::incoherence)), with_commas(run.wrong_pixels)});
    }
    return rows;
}

const std::vector<std::string>& effect_header() {
    static const std::vector<std::string> header{
        "parameter", "value", "tried", "least time", "most time", "concurrency", "incoherence", "wrong pixels", "rank"};
    return header;
}

std::vector<std::vector<std::string>> effect_rows(const Sensitivity& result) {
    std::vector<std::vector<std::string>> rows;
    for (const std::size_t number : result.by_effect()) {
        const SensitivityParameter& parameter = result.parameters[number];
        const Effect effect = effect_of(result, parameter);
        rows.push_back({parameter.path, parameter.value, tried(parameter), percent(effect.low), percent(effect.high),
                        share_text(effect.hazards[0]), share_text(effect.hazards[1]), share_text(effect.wrong),
                        effect.ranks ? "changes" : ""});
    }
    return rows;
}

const std::vector<std::string>& conclusion_header() {
    static const std::vector<std::string> header{"faster", "slower", "times as long", "least", "at", "conclusion"};
    return header;
}

std::vector<std::vector<std::string>> conclusion_rows(const Sensitivity& result) {
    std::vector<std::vector<std::string>> rows;
    for (const Conclusion& one : result.conclusions)
        rows.push_back({result.designs[one.faster].label, result.designs[one.slower].label,
                        fmt::format("{:.3f}", one.ratio), fmt::format("{:.3f}", one.worst_ratio),
                        one.worst_parameter.empty() ? "" : one.worst_parameter + "=" + one.worst_value,
                        one.survives() ? "survives" : "does not survive"});
    return rows;
}

std::vector<TextColumn> text_columns(const std::vector<std::string>& header, std::size_t texts) {
    std::vector<TextColumn> columns;
    for (std::size_t i = 0; i < header.size(); ++i) columns.push_back({header[i], "", i < texts});
    return columns;
}

std::string html_of(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::vector<HtmlCell>> cells;
    for (const auto& row : rows) {
        cells.emplace_back();
        for (std::size_t i = 0; i < row.size(); ++i)
            cells.back().push_back({row[i], i == 0                         ? "name"
                                            : row[i] == "survives"         ? "good"
                                            : row[i] == "does not survive" ? "bad"
                                                                           : "number"});
    }
    return html_table(header, cells);
}

constexpr std::size_t bars = 15; // of a tornado; what follows changes next to nothing

Plot tornado_of(const Sensitivity& result, std::size_t design) {
    Plot plot;
    plot.title = "Time of " + result.designs[design].label;
    plot.x_title = "percent of its time";
    plot.tornado = true;
    plot.lines = {{"smaller value", {}}, {"larger or other value", {}}};
    for (const std::size_t number : result.by_effect()) {
        if (plot.labels.size() == bars) break;
        const SensitivityParameter& parameter = result.parameters[number];
        double down = 0, up = 0;
        for (const SensitivityStep& step : parameter.steps) {
            if (step.runs.empty()) continue;
            double& side = step.direction == Direction::down ? down : up;
            side = stronger(side, change_of(step.runs[design], result.base[design]));
        }
        if (down == 0 && up == 0) continue;
        plot.labels.push_back(parameter.path);
        plot.lines[0].values.push_back(100 * down);
        plot.lines[1].values.push_back(100 * up);
    }
    return plot;
}

ordered_json run_json(const VariantFacts& design, const SensitivityRun& run) {
    ordered_json hazards = {{"total", run.hazards.total()}};
    for (const HazardKind kind : both_kinds) hazards[std::string(hazard_name(kind))] = run.hazards.of(kind);
    for_each_hazard_cell(run.hazards,
                         [&hazards](const std::string& name, std::uint64_t count) { hazards[name] = count; });
    return {{"design", design.design},
            {"variant", design.text},
            {"cycles", run.cycles},
            {"milliseconds", run.milliseconds},
            {"fragments", run.fragments},
            {"hazards", std::move(hazards)},
            {"wrong_pixels", run.wrong_pixels},
            {"lost_fragments", run.lost_fragments},
            {"rank", run.rank}};
}

ordered_json runs_json(const Sensitivity& result, const std::vector<SensitivityRun>& runs) {
    ordered_json list = ordered_json::array();
    for (std::size_t i = 0; i < runs.size(); ++i) list.push_back(run_json(result.designs[i], runs[i]));
    return list;
}

ordered_json parameter_json(const Sensitivity& result, const SensitivityParameter& parameter) {
    ordered_json steps = ordered_json::array();
    for (const SensitivityStep& step : parameter.steps) {
        ordered_json json = {{"value", step.value}};
        if (!step.refused.empty())
            json["refused"] = step.refused;
        else
            json["designs"] = runs_json(result, step.runs);
        steps.push_back(std::move(json));
    }
    return {{"parameter", parameter.path},
            {"value", parameter.value},
            {"unit", parameter.unit},
            {"meaning", parameter.text},
            {"largest_change", parameter.largest_change(result.base)},
            {"steps", std::move(steps)}};
}

void add_sensitivity_rows(Table& table, const Sensitivity& result, const std::string& parameter,
                          const std::string& value, const std::vector<SensitivityRun>& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const SensitivityRun& run = runs[i];
        std::vector<std::string> row{parameter,
                                     value,
                                     result.designs[i].text,
                                     std::to_string(run.cycles),
                                     fmt::format("{:.6g}", run.milliseconds),
                                     std::to_string(run.rank)};
        for (const HazardKind kind : both_kinds) row.push_back(std::to_string(run.hazards.of(kind)));
        row.push_back(std::to_string(run.wrong_pixels));
        row.push_back(fmt::format("{:.6g}", change_of(run, result.base[i])));
        table.rows.push_back(std::move(row));
    }
}

} // namespace

std::string sensitivity_text(const Sensitivity& result, TerminalStyle style) {
    std::string text = wrap(conditions(result), style.columns, 2) + "\n";
    text += text_table(text_columns(base_header(), 1), base_rows(result), style) + "\n";
    text += text_table(text_columns(effect_header(), 3), effect_rows(result), style) + "\n";
    if (result.conclusions.empty()) return text + "No two designs are correct in every run.\n";
    text += text_table(text_columns(conclusion_header(), 2), conclusion_rows(result), style);
    return text + wrap(fmt::format("A conclusion survives if no run reverses it by more than {:.0f} %.",
                                   100 * order_tolerance),
                       style.columns, 2);
}

ordered_json sensitivity_json(const Sensitivity& result) {
    ordered_json parameters = ordered_json::array(), skipped = ordered_json::array(),
                 conclusions = ordered_json::array();
    for (const std::size_t number : result.by_effect())
        parameters.push_back(parameter_json(result, result.parameters[number]));
    for (const auto& [path, reason] : result.skipped) skipped.push_back({{"parameter", path}, {"reason", reason}});
    for (const Conclusion& one : result.conclusions)
        conclusions.push_back({{"faster", result.designs[one.faster].text},
                               {"slower", result.designs[one.slower].text},
                               {"ratio", one.ratio},
                               {"least_ratio", one.worst_ratio},
                               {"parameter", one.worst_parameter},
                               {"value", one.worst_value},
                               {"survives", one.survives()}});
    return {{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
            {"scene", result.scene.name},
            {"hash", result.scene.hash},
            {"workload", result.workload},
            {"width", result.width},
            {"height", result.height},
            {"gpu", result.gpu},
            {"factor", result.factor},
            {"seed", result.seed},
            {"base", runs_json(result, result.base)},
            {"parameters", std::move(parameters)},
            {"skipped", std::move(skipped)},
            {"conclusions", std::move(conclusions)}};
}

Table sensitivity_table(const Sensitivity& result) {
    Table table{"sensitivity.csv",
                {"parameter", "value", "variant", "cycles [core cycles]", "time [ms]", "rank",
                 "concurrency [fragments]", "incoherence [fragments]", "wrong pixels [pixels]", "change of time"},
                {}};
    add_sensitivity_rows(table, result, "", "", result.base);
    for (const SensitivityParameter& parameter : result.parameters)
        for (const SensitivityStep& step : parameter.steps)
            add_sensitivity_rows(table, result, parameter.path, step.value, step.runs);
    return table;
}

Table conclusions_table(const Sensitivity& result) {
    return {"conclusions.csv", conclusion_header(), conclusion_rows(result)};
}

std::string sensitivity_page(const Sensitivity& result) {
    std::vector<Plot> plots;
    for (std::size_t i = 0; i < result.designs.size(); ++i) plots.push_back(tornado_of(result, i));
    std::vector<std::vector<std::string>> skipped;
    for (const auto& [path, reason] : result.skipped) skipped.push_back({path, reason});
    const std::string intro = fmt::format("<p>{}.</p>\n<p class=\"note\">ropsim {} ({}).</p>\n",
                                          escape_html(conditions(result)), version_text(), escape_html(build_text()));
    const std::string conclusions =
        result.conclusions.empty()
            ? "<p>No two designs are correct in every run.</p>\n"
            : html_of(conclusion_header(), conclusion_rows(result)) +
                  fmt::format("<p class=\"note\">The order of two designs that are correct in every run survives if no "
                              "run reverses it by more than {:.0f} %.</p>\n",
                              100 * order_tolerance);
    return plot_page("Sensitivity", intro, plots,
                     {{"Conclusions", conclusions},
                      {"The GPU as it is", html_of(base_header(), base_rows(result))},
                      {"Parameters", html_of(effect_header(), effect_rows(result))},
                      {"Left as they are", html_of({"parameter", "because"}, skipped)}});
}

} // namespace reports
