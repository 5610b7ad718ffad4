// Runs a request, writes its report and prints it.
#pragma once

#include "cli/options.hpp"
#include "reports/terminal_table.hpp"

#include <functional>
#include <string>

namespace cli {

using Presentation = std::function<std::string(const reports::Comparison&, reports::TerminalStyle)>;

/// Table of designs and hazards, what was left out.
std::string comparison_text(const reports::Comparison& comparison, reports::TerminalStyle style);

/// `present` makes the text for the terminal; with --json, result.json takes its place.
void simulate(const reports::ComparisonRequest& request, const OutputOptions& output, const Presentation& present);

} // namespace cli
