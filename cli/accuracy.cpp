// ropsim accuracy: a rendering method's error beside its run time, as its quality knobs turn.
#include "reports/accuracy/accuracy.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "cli/measuring.hpp"
#include "cli/progress_line.hpp"
#include "reports/atomic_file.hpp"
#include "reports/images.hpp"
#include "reports/result.hpp"

#include <nlohmann/json.hpp>

namespace cli {

namespace {

reports::Accuracy measure(const reports::AccuracyRequest& request) {
    ProgressLine line;
    return reports::measure_accuracy(request, {&stop_requested(), line.progress(), nullptr});
}

} // namespace

void accuracy(const AccuracyCommand& command) {
    const reports::AccuracyRequest request = request_of(command);
    if (request.pictures) reports::require_images();
    const reports::Accuracy result = measure(request);
    const auto document = reports::accuracy_json(result);
    std::string written;
    if (!command.output.directory.empty()) {
        reports::begin_report_folder(command.output.directory);
        reports::write_accuracy_pictures(result, command.output.directory);
        written = "\n" + write_tables(command.output.directory, "accuracy.json", document,
                                      {reports::accuracy_table(result)}, reports::accuracy_page(result), true);
    }
    print_result(command.output.json, reports::result_text(document), reports::accuracy_text(result, terminal_style()),
                 reports::remarks(result), written);
}

} // namespace cli
