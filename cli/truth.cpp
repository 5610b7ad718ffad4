// ropsim truth: a frame traced by rays, with no k-buffer and no limit to the fragments of a pixel.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "cli/progress_line.hpp"
#include "reports/atomic_file.hpp"
#include "reports/images.hpp"
#include "reports/result.hpp"

#include <nlohmann/json.hpp>

namespace cli {

namespace {

reports::TruthRun compute(const reports::TruthRequest& request) {
    ProgressLine line;
    return reports::run_truth(request, {&stop_requested(), line.progress(), nullptr});
}

} // namespace

int truth(const TruthCommand& command) {
    const reports::TruthRequest request = request_of(command);
    if (!command.directory.empty()) reports::make_directory(command.directory);
    if (!command.directory.empty() && !command.no_images) reports::require_images();
    const reports::TruthRun run = compute(request);
    std::string written;
    if (!command.directory.empty()) {
        written = "\n" + reports::write_truth(run, command.directory, !command.no_images);
    }
    print_result(command.json, reports::result_text(reports::truth_json(run)),
                 reports::truth_text(run, terminal_style()), reports::remarks(run), written);
    return command.check && !run.holds() ? status_no : status_good;
}

} // namespace cli
