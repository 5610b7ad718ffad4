// The validation of depth peeling for people, for programs, as a table and as a page.
#pragma once

#include "reports/csv.hpp"
#include "reports/peeling/validation.hpp"
#include "reports/terminal_table.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace reports {

std::string peeling_text(const PeelingValidation& validation, TerminalStyle style);
nlohmann::ordered_json peeling_json(const PeelingValidation& validation);
/// validation.csv: one row per number; summary.csv.
std::vector<Table> peeling_tables(const PeelingValidation& validation);
std::string peeling_page(const PeelingValidation& validation);

} // namespace reports
