// Rows that the model misses by more than 25 %, by the reason that the data file gives.
#pragma once

#include "reports/text_table.hpp"
#include "reports/validation/validation_row.hpp"

#include <string>
#include <vector>

namespace reports {

/// Numbers that are missed for one reason.
struct Misses {
    std::string numbers, reason;
};

/// In the order in which the reasons occur; without one they are "not explained". `named` gives a row's name.
std::vector<Misses> large_misses(const std::vector<ValidationRow>& rows, std::string (*named)(const ValidationRow&));

/// A paragraph for each; "" and "None." without any.
std::string misses_text(const std::vector<Misses>& misses, TerminalStyle style);
std::string misses_html(const std::vector<Misses>& misses);

} // namespace reports
