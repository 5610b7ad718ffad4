// ropsim validate: the model beside published measurements.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/measuring.hpp"
#include "reports/deferred/report.hpp"
#include "reports/geometry/json.hpp"
#include "reports/geometry/page.hpp"
#include "reports/geometry/tables.hpp"
#include "reports/geometry/text.hpp"
#include "reports/peeling/report.hpp"
#include "reports/result.hpp"
#include "sim/check.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cli {

namespace {

void validate_geometry(const ValidateCommand& command) {
    Measuring measuring(command.fidelity.empty() ? "detailed" : command.fidelity, command.threads);
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

void validate_peeling(const ValidateCommand& command) {
    const reports::PublishedPeeling published = reports::load_published_peeling();
    check_peeling_gpus(command.gpus, published.gpu);
    if (command.leave_one_out)
        throw sim::InputError("--leave-one-out: no other row could determine what peeling calibrates");
    reports::PeelingOptions options;
    options.fidelity = peeling_fidelity_of(command.fidelity);
    Measuring measuring("detailed", command.threads);
    options.threads = measuring.options().threads;
    options.stop = measuring.options().stop;
    options.progress = measuring.options().progress;
    const auto validation = reports::validate_peeling(published, options);
    measuring.end();
    const auto document = reports::peeling_json(validation);
    std::string written;
    if (!command.directory.empty())
        written = "\n" + write_tables(command.directory, "validation.json", document,
                                      reports::peeling_tables(validation), reports::peeling_page(validation));
    print(command.json ? reports::result_text(document)
                       : reports::peeling_text(validation, terminal_style()) + written);
}

void validate_deferred(const ValidateCommand& command) {
    if (command.leave_one_out)
        throw sim::InputError("--leave-one-out: no other row could determine what deferred shading calibrates");
    if (!command.fidelity.empty() && command.fidelity != "detailed")
        throw sim::InputError(fmt::format("--fidelity: expected detailed, got '{}'", command.fidelity));
    const reports::PublishedDeferred published = reports::load_published_deferred();
    reports::DeferredOptions options;
    options.gpus = list_of(command.gpus);
    options.lights = lights_of(command.lights);
    if (!command.size.empty()) options.size = size_of(command.size);
    reports::check_deferred_options(published, options);
    Measuring measuring("detailed", command.threads);
    options.threads = measuring.options().threads;
    options.stop = measuring.options().stop;
    options.progress = measuring.options().progress;
    const auto validation = reports::validate_deferred(published, options);
    measuring.end();
    const auto document = reports::deferred_json(validation);
    std::string written;
    if (!command.directory.empty())
        written = "\n" + write_tables(command.directory, "validation.json", document,
                                      reports::deferred_tables(validation), reports::deferred_page(validation));
    print(command.json ? reports::result_text(document)
                       : reports::deferred_text(validation, terminal_style()) + written);
}

} // namespace

void validate(const ValidateCommand& command) {
    if (command.target == "deferred") return validate_deferred(command);
    if (!command.lights.empty() || !command.size.empty())
        throw sim::InputError(fmt::format("--lights, --size: validate {} has neither", command.target));
    if (command.target == "geometry") return validate_geometry(command);
    if (command.target == "peeling") return validate_peeling(command);
    throw sim::InputError(fmt::format("validate: expected geometry, peeling or deferred, got '{}'", command.target));
}

} // namespace cli
