// ropsim validate: the model beside published measurements.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/measuring.hpp"
#include "reports/geometry/json.hpp"
#include "reports/geometry/page.hpp"
#include "reports/geometry/tables.hpp"
#include "reports/geometry/text.hpp"
#include "reports/result.hpp"

namespace cli {

void validate(const ValidateCommand& command) {
    expect_geometry("validate", command.target);
    Measuring measuring(command.fidelity, command.threads);
    const auto validation = reports::validate_geometry(list_of(command.gpus), measuring.options());
    std::vector<reports::LeftOneOut> exchanged;
    if (command.leave_one_out) exchanged = reports::leave_one_out(list_of(command.gpus), measuring.options());
    measuring.end();
    const auto document = reports::validation_json(validation, exchanged);
    std::string written;
    if (!command.directory.empty())
        written = "\n" + write_tables(command.directory, "validation.json", document,
                                      reports::validation_tables(validation, exchanged),
                                      reports::validation_page(validation, exchanged));
    if (command.json) return print(reports::result_text(document));
    std::string text = reports::validation_text(validation, terminal_style());
    if (!exchanged.empty()) text += "\n" + reports::leave_one_out_text(exchanged, terminal_style());
    print(text + written);
}

} // namespace cli
