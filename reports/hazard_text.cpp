#include "reports/hazard_text.hpp"

#include "reports/numbers.hpp"
#include "reports/run_numbers.hpp"
#include "reports/text_table.hpp"

namespace reports {

using pipeline::HazardKind;

namespace {

std::vector<std::string> kind_row(const std::string& name, const pipeline::RunResult& run, HazardKind kind) {
    std::vector<std::string> row{name, std::string(hazard_name(kind))};
    for (const auto& cells : run.hazards.by) row.push_back(with_commas(cells[static_cast<std::size_t>(kind)]));
    row.push_back(with_commas(run.hazards.of(kind)));
    row.push_back(short_number(hazards_per_million(run, kind)));
    return row;
}

} // namespace

std::string_view hazard_name(pipeline::HazardClass cause) {
    return hazard_class_names[static_cast<std::size_t>(cause)];
}

std::string_view hazard_name(HazardKind kind) { return hazard_kind_names[static_cast<std::size_t>(kind)]; }

std::string hazards_text(const Comparison& comparison, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
        const pipeline::RunResult& run = comparison.runs[i];
        if (run.hazards.total() == 0) continue;
        rows.push_back(kind_row(comparison.variants.at(i).label, run, HazardKind::concurrency));
        rows.push_back(kind_row("", run, HazardKind::incoherence));
    }
    if (rows.empty()) return "";
    return text_table({{"hazards", "", true},
                       {"", "", true},
                       {"H1", "in flight"},
                       {"H2", "write path"},
                       {"H3", "stale line"},
                       {"H4", "torn read"},
                       {"total", "fragments"},
                       {"per million", "fragments"}},
                      rows, style) +
           wrap(std::string(hazard_kinds_explained), style.columns, 2);
}

} // namespace reports
