// Every counter of a run on the terminal, with unit and meaning.
#pragma once

#include "pipeline/run_result.hpp"
#include "reports/terminal_table.hpp"

#include <string>

namespace reports {

/// Stage by stage: how its time was spent, then one line per counter. Counters that are 0 are listed together.
std::string counters_text(const pipeline::RunResult& run, TerminalStyle style);

} // namespace reports
