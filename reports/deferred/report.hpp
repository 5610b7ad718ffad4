// The validation of deferred shading for people, for programs, as a table and as a page.
#pragma once

#include "reports/csv.hpp"
#include "reports/deferred/validation.hpp"
#include "reports/text_table.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace reports {

std::string deferred_text(const DeferredValidation& validation, TerminalStyle style);
nlohmann::ordered_json deferred_json(const DeferredValidation& validation);
/// validation.csv: one row per number; summary.csv.
std::vector<Table> deferred_tables(const DeferredValidation& validation);
std::string deferred_page(const DeferredValidation& validation);

} // namespace reports
