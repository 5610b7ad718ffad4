// ropsim sensitivity: how much the answers of a comparison depend on its assumptions.
#include "reports/sensitivity/sensitivity.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "cli/measuring.hpp"
#include "cli/progress_line.hpp"
#include "reports/result.hpp"

#include <nlohmann/json.hpp>

namespace cli {

namespace {

reports::Sensitivity measure_with_progress(const reports::SensitivityRequest& request) {
    ProgressLine line;
    return reports::measure_sensitivity(request, {&stop_requested(), line.progress(), nullptr});
}

} // namespace

void sensitivity(const SensitivityCommand& command) {
    const reports::Sensitivity result = measure_with_progress(request_of(command));
    const auto document = reports::sensitivity_json(result);
    std::string written;
    if (!command.directory.empty())
        written = "\n" + write_tables(command.directory, "sensitivity.json", document,
                                      {reports::sensitivity_table(result), reports::conclusions_table(result)},
                                      reports::sensitivity_page(result));
    print_result(command.json, reports::result_text(document), reports::sensitivity_text(result, terminal_style()),
                 reports::remarks(result), written);
}

} // namespace cli
