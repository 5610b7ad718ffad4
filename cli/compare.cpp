// ropsim compare, and what ropsim run shares with it.
#include "cli/simulate.hpp"

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "cli/progress_line.hpp"
#include "reports/hazard_text.hpp"
#include "reports/remarks.hpp"
#include "reports/report_files.hpp"
#include "reports/result.hpp"
#include "reports/terminal_table.hpp"
#include "reports/timeline.hpp"
#include "sim/counted.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cli {

namespace {

reports::Comparison compute(const reports::ComparisonRequest& request, sim::Observer* observer) {
    ProgressLine line;
    const reports::Supervision supervision{&stop_requested(), line.progress(), observer};
    return reports::compare(reports::prepare(request, supervision), supervision);
}

std::string write(const reports::Comparison& comparison, const OutputOptions& output) {
    return reports::write_report(comparison, output.directory, {!output.no_images, &stop_requested()});
}

std::string write_timeline(const reports::Timeline& timeline, const OutputOptions& output) {
    const std::filesystem::path path = std::filesystem::path(output.directory) / "timeline.json";
    timeline.write(path);
    const std::uint64_t left_out = timeline.slices_left_out();
    return fmt::format("The timeline is {}{}\n", path.string(),
                       left_out == 0 ? ""
                                     : fmt::format("; its last {} {} left out", sim::counted(left_out, "slice"),
                                                   left_out == 1 ? "is" : "are"));
}

std::string blank_behind(const std::string& text) { return text.empty() ? text : text + "\n"; }

} // namespace

void simulate(const reports::ComparisonRequest& request, const OutputOptions& output, const Presentation& present) {
    if (!output.directory.empty()) reports::check_report_folder(output.directory, {!output.no_images, nullptr});
    std::optional<reports::Timeline> timeline;
    if (output.timeline) timeline.emplace();
    const reports::Comparison comparison = compute(request, timeline ? &*timeline : nullptr);
    std::string written;
    if (!output.directory.empty()) written = write(comparison, output) + "\n";
    if (timeline) written += write_timeline(*timeline, output);
    print_result(output.json, output.json ? reports::result_text(reports::result_json(comparison)) : "",
                 output.json ? "" : present(comparison, terminal_style()), reports::remarks(comparison), written);
}

std::string comparison_text(const reports::Comparison& comparison, reports::TerminalStyle style) {
    return reports::heading(comparison, style) + "\n" + reports::designs_text(comparison, style) + "\n" +
           blank_behind(reports::hazards_text(comparison, style)) + reports::left_out_text(comparison, style);
}

void compare(const CompareCommand& command) { simulate(request_of(command), command.output, comparison_text); }

} // namespace cli
