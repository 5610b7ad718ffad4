// Held-out errors for people, for programs and as tables.
#pragma once

#include "reports/csv.hpp"
#include "reports/terminal_table.hpp"
#include "reports/validation/folds.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace reports {

std::string folds_text(const std::vector<GpuFolds>& cards, TerminalStyle style);
nlohmann::ordered_json folds_json(const std::vector<GpuFolds>& cards);
/// held_out.csv: one row per row that was left out; fold_numbers.csv: one per fold and number.
std::vector<Table> folds_tables(const std::vector<GpuFolds>& cards);

} // namespace reports
