// ropsim run: one design, every counter.
#include "cli/commands.hpp"
#include "cli/simulate.hpp"
#include "reports/counter_text.hpp"
#include "reports/hazard_text.hpp"
#include "reports/surface_text.hpp"
#include "reports/terminal_table.hpp"

namespace cli {

void run(const RunCommand& command) {
    const auto present = [](const reports::Comparison& comparison, reports::TerminalStyle style) {
        const std::string hazards = reports::hazards_text(comparison, style);
        return reports::heading(comparison, style) + "\n" + reports::designs_text(comparison, style) + "\n" + hazards +
               (hazards.empty() ? "" : "\n") + reports::counters_text(comparison.runs.front(), style) +
               reports::surfaces_text(comparison, style) + "\n" + reports::left_out_text(comparison, style);
    };
    simulate(request_of(command.frame, command.design), command.output, present);
}

} // namespace cli
