// The terminal: results go to standard output, everything else to standard error.
#pragma once

#include "reports/text_table.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace cli {

/// Throws sim::InputError when it cannot be written (a full disk behind a redirection).
void print(std::string_view text);

/// On standard error, at once. Where that cannot be written, nobody is told.
void write_error(std::string_view text);

/// One line on standard error, "ropsim: TEXT".
void complain(std::string_view text);

/// A result, and what has to be said of it: with --json the document on standard output and the notes on standard
/// error, else the table with the notes below it, and what was written behind them. Throws as print() does.
void print_result(bool json, const std::string& document, const std::string& table,
                  const std::vector<std::string>& notes, const std::string& written = {});

/// Colours when standard output is a terminal that knows them (TERM is not "dumb") and NO_COLOR is not set
/// (no-color.org). The width is that of COLUMNS, else of the terminal, at most 120.
reports::TerminalStyle terminal_style();

/// Whether TERM names a terminal that can move its cursor and show colours.
bool terminal_is_able();

} // namespace cli
