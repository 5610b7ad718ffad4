// ropsim study: one question, a sweep, a table and a plot.
#include "reports/study.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/measuring.hpp"
#include "reports/result.hpp"

namespace cli {

void study(const StudyCommand& command) {
    if (command.target.empty()) return print(reports::studies_text(reports::study_names(), terminal_style()));
    const reports::Study study = reports::load_study(command.target);
    Measuring measuring(command.fidelity, command.threads);
    const reports::StudyResult result = reports::run_study(study, list_of(command.gpus), measuring.options());
    measuring.end();
    const auto document = reports::study_json(result);
    std::string written;
    if (!command.directory.empty())
        written = "\n" + write_tables(command.directory, "study.json", document, {reports::study_table(result)},
                                      reports::study_page(result));
    print(command.json ? reports::result_text(document) : reports::study_text(result, terminal_style()) + written);
}

} // namespace cli
