#include "reports/geometry/measurements.hpp"

#include "pipeline/geometry/host.hpp"
#include "reports/toml_reader.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace reports {

namespace {

constexpr std::array<std::string_view, 2> kinds{"calibrated", "penalty"};
constexpr std::array<std::string_view, 2> scalings{"vertex_units", "memory"};

PublishedRow row_of(TomlTable& table) {
    PublishedRow row;
    row.table = table.text("table");
    row.row = table.text("row");
    row.experiment.scene = table.text("scene");
    row.experiment.prepare = table.texts("prepare");
    row.experiment.submission =
        choice<pipeline::Submission>(table, "submission", sim::EnumNames<pipeline::Submission>::names);
    table.entries("fps", [&](const std::string& gpu, const toml::node& value) {
        if (!value.is_string()) table.expected("fps", "texts, as they were printed");
        row.fps[gpu] = printed_number(text_of_node(value), "reports/published/geometry.toml");
    });
    table.entries("explanations", [&](const std::string& gpu, const toml::node& value) {
        row.explanations[gpu] = text_of_node(value);
    });
    return row;
}

CalibrationStep step_of(TomlTable& table) {
    CalibrationStep step;
    step.gpu = table.text("gpu");
    step.parameter = table.text("parameter");
    step.row = table.text("row");
    step.kind = choice<CalibrationKind>(table, "kind", kinds);
    step.low = table.number("low");
    step.high = table.number("high");
    step.reason = table.text("reason");
    step.alternatives = table.texts("alternatives");
    return step;
}

} // namespace

std::vector<PublishedRow> load_published_geometry() {
    std::vector<PublishedRow> rows;
    read_data_file("reports/published/geometry.toml", [&](TomlTable& root) {
        root.text("source");
        root.tables("rows", [&](TomlTable& table) { rows.push_back(row_of(table)); });
    });
    return rows;
}

CalibrationPlan load_calibration_plan() {
    CalibrationPlan plan;
    read_data_file("reports/published/calibration.toml", [&](TomlTable& root) {
        root.tables("steps", [&](TomlTable& table) { plan.steps.push_back(step_of(table)); });
        root.tables("shared", [&](TomlTable& table) {
            plan.shared.push_back({table.text("gpu"), table.text("row"), table.text("parameter"),
                                   choice<CalibrationKind>(table, "kind", kinds), table.text("reason")});
        });
        root.tables("scaled", [&](TomlTable& table) {
            plan.scaled.push_back({table.text("gpu"), table.text("from"), table.text("parameter"),
                                   choice<Scaling>(table, "by", scalings)});
        });
    });
    plan.choices = load_choices("geometry");
    return plan;
}

std::string CalibrationPlan::parameter_of(const std::string& gpu, const std::string& row, CalibrationKind& kind) const {
    for (const CalibrationStep& step : steps) {
        const std::vector<std::string> used = rows_in(step.row);
        if (step.gpu == gpu && std::find(used.begin(), used.end(), row) != used.end()) {
            kind = step.kind;
            return step.parameter;
        }
    }
    for (const SharedNumber& number : shared)
        if (number.gpu == gpu && number.row == row) {
            kind = number.kind;
            return number.parameter;
        }
    return {};
}

std::vector<std::string> rows_in(const std::string& expression) {
    constexpr std::string_view minus = " minus ";
    const std::size_t at = expression.find(minus);
    if (at == std::string::npos) return {expression};
    return {expression.substr(0, at), expression.substr(at + minus.size())};
}

std::vector<std::string> measured_gpus(const std::vector<PublishedRow>& rows) {
    std::set<std::string> gpus;
    for (const PublishedRow& row : rows)
        for (const auto& [gpu, fps] : row.fps) gpus.insert(gpu);
    return {gpus.begin(), gpus.end()};
}

const PublishedRow& find_row(const std::vector<PublishedRow>& rows, const std::string& key) {
    for (const PublishedRow& row : rows)
        if (row.key() == key) return row;
    throw sim::InputError(fmt::format("reports/published/calibration.toml: no published row is called '{}'", key));
}

} // namespace reports
