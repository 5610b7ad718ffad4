#include "reports/counter_text.hpp"

#include "reports/counter_reference.hpp"
#include "reports/flatten.hpp"
#include "reports/numbers.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

struct CounterLine {
    std::string name, value, unit, text;
};

std::string value_text(const ordered_json& value) {
    if (value.is_number_unsigned()) return with_commas(value.get<std::uint64_t>());
    return value.is_number_float() ? fmt::format("{:.4g}", value.get<double>()) : cell_text(value);
}

bool is_zero(const ordered_json& value) { return value.is_number() && value.get<double>() == 0.0; }

std::string activity_text(const ordered_json& fractions) {
    std::string text;
    for (const auto& activity : fractions.items())
        if (activity.value().get<double>() >= 0.0005)
            text += fmt::format("{}{} {:.1f} %", text.empty() ? "" : ", ", activity.key(),
                                100.0 * activity.value().get<double>());
    return text;
}

std::string lines_text(const std::vector<CounterLine>& lines, TerminalStyle style) {
    std::size_t name = 0, value = 0, unit = 0;
    for (const CounterLine& line : lines) {
        name = std::max(name, line.name.size());
        value = std::max(value, line.value.size());
        unit = std::max(unit, line.unit.size());
    }
    std::string text;
    for (const CounterLine& line : lines)
        text += wrap(
            fmt::format("  {:<{}}  {:>{}} {:<{}}  {}", line.name, name, line.value, value, line.unit, unit, line.text),
            style.columns, name + value + unit + 7);
    return text;
}

std::string stage_text(const std::string& stage, const ordered_json& report, const ordered_json& fractions,
                       TerminalStyle style) {
    std::vector<CounterLine> lines;
    std::string zeros;
    for (const auto& [path, value] : flatten(report.value("counters", ordered_json::object()))) {
        const sim::FieldInfo* info = find_counter(stage, path);
        if (is_zero(value))
            zeros += (zeros.empty() ? "" : ", ") + counter_name(stage, path);
        else
            lines.push_back(
                {path, value_text(value), info == nullptr ? "" : info->unit, info == nullptr ? "" : info->text});
    }
    const std::size_t units = report.value("units", std::size_t{1});
    std::string title = units == 1 ? stage : fmt::format("{} ({})", stage, counted(units, "unit"));
    if (style.colour) title = fmt::format("\033[1m{}\033[0m", title);
    std::string text = wrap(fmt::format("{}: {}", title, activity_text(fractions)), style.columns, 2);
    text += lines_text(lines, style);
    if (!zeros.empty()) text += wrap("  zero: " + zeros, style.columns, 8);
    return text;
}

std::string named_numbers(std::string_view title, const ordered_json& numbers, TerminalStyle style) {
    std::vector<CounterLine> lines;
    for (const auto& item : numbers.items())
        for (const auto& [path, value] : flatten(item.value()))
            lines.push_back({path.empty() ? item.key() : item.key() + "." + path, value_text(value), "", ""});
    return lines.empty() ? "" : fmt::format("{}\n{}\n", title, lines_text(lines, style));
}

} // namespace

std::string counters_text(const pipeline::RunResult& run, TerminalStyle style) {
    std::string text;
    for (const auto& stage : run.stages->items())
        text += stage_text(stage.key(), stage.value(), run.stalls->value(stage.key(), ordered_json::object()), style) +
                "\n";
    text += named_numbers("caches", run.caches, style);
    text += named_numbers("bytes over links", run.bytes, style);
    text += named_numbers("on chip", run.area, style);
    return text;
}

} // namespace reports
