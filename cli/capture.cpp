// ropsim capture: a frame with all that it draws as one file.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "reports/remarks.hpp"
#include "reports/result.hpp"
#include "reports/trace_info.hpp"

#include <nlohmann/json.hpp>

namespace cli {

void capture(const CaptureCommand& command) {
    const traces::Trace trace = traces::capture(request_of(command));
    traces::write_trace(trace, command.file);
    std::vector<std::string> notes = trace.scene.notes;
    notes.insert(notes.end(), trace.frame.notes.begin(), trace.frame.notes.end());
    const auto info = reports::trace_info(command.file);
    print_result(command.json, reports::result_text(info), reports::trace_summary(info), reports::each_once(notes));
}

} // namespace cli
