#include "reports/counter_rows.hpp"

#include "reports/counter_reference.hpp"
#include "reports/flatten.hpp"

#include <nlohmann/json.hpp>

namespace reports {

namespace {

CounterRow row_of(const std::string& stage, const std::string& kind, const std::string& name, std::string value) {
    CounterRow row{stage, kind, name.empty() ? kind : counter_name(stage, name), std::move(value), {}, {}};
    if (kind == "activity") row.unit = "cycles";
    if (kind != "counters") return row;
    if (const sim::FieldInfo* info = find_counter(stage, name)) {
        row.unit = info->unit;
        row.meaning = info->text;
    }
    return row;
}

} // namespace

std::vector<CounterRow> counter_rows(const pipeline::RunResult& run) {
    std::vector<CounterRow> rows;
    for (const auto& stage : run.stages->items())
        for (const auto& kind : stage.value().items())
            for (const auto& [name, value] : flatten(kind.value()))
                rows.push_back(row_of(stage.key(), kind.key(), name, cell_text(value)));
    return rows;
}

} // namespace reports
