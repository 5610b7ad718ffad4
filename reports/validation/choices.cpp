#include "reports/validation/choices.hpp"

#include "reports/toml_reader.hpp"

#include <algorithm>

namespace reports {

namespace {

constexpr std::array<std::string_view, 2> targets{"geometry", "peeling"};

Choice choice_of(TomlTable& table) {
    enum class Target : std::uint8_t { geometry, peeling };
    Choice one;
    one.target = targets[static_cast<std::size_t>(choice<Target>(table, "target", targets))];
    one.what = table.text("what");
    one.parameter = table.text_or("parameter", "");
    if (!one.parameter.empty()) one.value = table.number("value");
    one.gpus = table.texts("gpus");
    one.rows = table.texts("rows");
    if (one.rows.empty()) table.expected("rows", "the rows that were in view");
    one.penalty = table.flag_or("penalty", false);
    one.reason = table.text("reason");
    return one;
}

bool holds(const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

} // namespace

bool Choice::concerns(const ValidationRow& row) const { return holds(gpus, row.gpu) && holds(rows, row.key()); }

std::vector<Choice> load_choices(const std::string& target) {
    std::vector<Choice> choices;
    read_data_file("reports/published/choices.toml", [&](TomlTable& root) {
        root.tables("choices", [&](TomlTable& table) { choices.push_back(choice_of(table)); });
    });
    std::erase_if(choices, [&target](const Choice& one) { return one.target != target; });
    return choices;
}

void apply_choices(ValidationRow& row, const std::vector<Choice>& choices) {
    for (const Choice& one : choices) {
        if (!one.concerns(row)) continue;
        if (row.parameter.empty()) row.parameter = one.what;
        if (row.status == RowStatus::predicted) row.status = one.penalty ? RowStatus::penalty : RowStatus::calibrated;
    }
}

} // namespace reports
