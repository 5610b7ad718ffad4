// A comparison on the terminal.
#pragma once

#include "reports/comparison_result.hpp"
#include "reports/text_table.hpp"

#include <string>

namespace reports {

/// One line on what was drawn on what.
std::string heading(const Comparison& comparison, TerminalStyle style);

/// One row per design: what concurrency and incoherence break, and what protection costs in time and on chip. Numbers
/// are shortened (12.3M) where the exact ones do not fit.
std::string designs_text(const Comparison& comparison, TerminalStyle style);

/// What was left out and why, each once, with the designs it concerns unless it concerns all.
std::string left_out_text(const Comparison& comparison, TerminalStyle style);

/// `text` in lines of at most `columns` characters, all but the first indented.
std::string wrap(const std::string& text, std::size_t columns, std::size_t indent);

} // namespace reports
