// The outcomes of stiff and extreme cases as text, JSON, a table and a page.
#pragma once

#include "reports/csv.hpp"
#include "reports/html/plot_page.hpp"
#include "reports/stability/case.hpp"
#include "reports/terminal_table.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace reports::stability {

/// How many digits a formula loses over the range of its input.
struct Curve {
    std::string id, formula;
    std::string guard; ///< what keeps the digits, or what becomes of those that are lost
    Plot plot;         ///< y: decimal digits that are right
    double worst_input = 0, fewest_digits = 0;
};

/// One row per case, the failed ones again at the end.
std::string text_of(const std::vector<Outcome>& outcomes, TerminalStyle style);
/// `cases` and, of a run with curves, `conditioning`.
nlohmann::ordered_json json_of(const std::vector<Outcome>& outcomes, const std::vector<Curve>& curves);
Table table_of(const std::vector<Outcome>& outcomes);
Table curves_table(const std::vector<Curve>& curves);
/// Pictures of cases that have one: the names of the files that the page shows.
std::vector<std::pair<std::string, const Picture*>> pictures_of(const std::vector<Outcome>& outcomes);
std::string page_of(const std::vector<Outcome>& outcomes, const std::vector<Curve>& curves, bool with_pictures);

std::size_t failures(const std::vector<Outcome>& outcomes);

} // namespace reports::stability
