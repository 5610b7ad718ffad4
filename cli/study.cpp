// ropsim study: one question, a sweep, a table and a plot.
#include "reports/study.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/measuring.hpp"
#include "reports/result.hpp"
#include "reports/study_points.hpp"
#include "sim/counted.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cli {

namespace {

std::size_t points_of(const reports::StudyResult& result) {
    return result.study.points.size() * result.study.series.size();
}

} // namespace

void study(const StudyCommand& command) {
    if (command.target.empty()) return print(reports::studies_text(reports::study_names(), terminal_style()));
    const reports::Study study = reports::load_study(command.target);
    Measuring measuring(command.fidelity, command.threads);
    std::optional<reports::StudyPoints> points;
    if (!command.directory.empty()) points.emplace(command.directory, command.resume);
    const reports::StudyResult result =
        reports::run_study(study, list_of(command.gpus), measuring.options(), points ? &*points : nullptr);
    measuring.end();
    const auto document = reports::study_json(result);
    std::string written;
    if (!command.directory.empty())
        written = "\n" + write_tables(command.directory, "study.json", document, {reports::study_table(result)},
                                      reports::study_page(result));
    std::vector<std::string> notes;
    if (const std::string remark = reports::nothing_drawn(result); !remark.empty()) notes.push_back(remark);
    if (result.found != 0)
        notes.push_back(fmt::format("{} of {} had been finished before and {} not computed again (--no-resume does)",
                                    result.found, sim::counted(points_of(result), "point"),
                                    result.found == 1 ? "was" : "were"));
    print_result(command.json, reports::result_text(document), reports::study_text(result, terminal_style()), notes,
                 written);
}

} // namespace cli
