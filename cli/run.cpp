// ropsim run: one design, every counter.
#include "cli/commands.hpp"
#include "cli/simulate.hpp"
#include "reports/counter_text.hpp"
#include "reports/terminal_table.hpp"

namespace cli {

void run(const RunCommand& command) {
    const auto present = [](const reports::Comparison& comparison, reports::TerminalStyle style) {
        return reports::heading(comparison, style) + "\n" + reports::designs_text(comparison, style) + "\n" +
               reports::counters_text(comparison.runs.front(), style) + reports::left_out_text(comparison, style);
    };
    simulate(request_of(command.frame, command.design), command.output, present);
}

} // namespace cli
