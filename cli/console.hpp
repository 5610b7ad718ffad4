// The terminal: results go to standard output, everything else to standard error.
#pragma once

#include "reports/terminal_table.hpp"

#include <string_view>

namespace cli {

/// Throws sim::InputError when it cannot be written (a full disk behind a redirection).
void print(std::string_view text);

/// One line on standard error, "ropsim: TEXT".
void complain(std::string_view text);

/// Colours when standard output is a terminal and NO_COLOR is not set (no-color.org); the terminal's width, at most
/// 120.
reports::TerminalStyle terminal_style();

} // namespace cli
