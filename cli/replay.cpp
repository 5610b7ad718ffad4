// ropsim replay: designs on the frame of a draw trace.
#include "cli/commands.hpp"
#include "cli/simulate.hpp"

namespace cli {

void replay(const ReplayCommand& command) { simulate(request_of(command), command.output, comparison_text); }

} // namespace cli
