// ropsim calibrate: numbers of GPU files from published measurements, and how well rows are predicted that had no part.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/measuring.hpp"
#include "reports/geometry/folds.hpp"
#include "reports/geometry/json.hpp"
#include "reports/geometry/tables.hpp"
#include "reports/geometry/text.hpp"
#include "reports/peeling/folds.hpp"
#include "reports/result.hpp"
#include "reports/validation/folds_report.hpp"
#include "sim/check.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cli {

namespace {

// Known before minutes of runs, not after them.
void check_calibrate(const CalibrateCommand& command) {
    if (command.target != "geometry" && command.target != "peeling")
        throw sim::InputError(fmt::format("calibrate: expected geometry or peeling, got '{}'", command.target));
    if (!command.directory.empty() && !std::filesystem::is_directory(command.directory))
        throw sim::InputError(fmt::format("--write: {}: expected a folder of GPU files", command.directory));
    if (!command.folds.empty() && !command.directory.empty())
        throw sim::InputError("--folds: what folds find is not written: omit --write");
}

reports::PublishedPeeling published_peeling(const CalibrateCommand& command) {
    reports::PublishedPeeling published = reports::load_published_peeling();
    check_peeling_gpus(command.gpus, published.gpu);
    return published;
}

reports::PeelingOptions peeling_options(const CalibrateCommand& command, const Measuring& measuring) {
    reports::PeelingOptions options;
    options.fidelity = peeling_fidelity_of(command.fidelity);
    options.threads = measuring.options().threads;
    options.stop = measuring.options().stop;
    options.progress = measuring.options().progress;
    return options;
}

std::string written_tables(const CalibrateCommand& command, const nlohmann::ordered_json& document,
                           const std::vector<reports::Table>& tables) {
    if (command.out.empty()) return {};
    return "\n" + write_tables(command.out, "calibration.json", document, tables, {});
}

std::vector<reports::GpuFolds> folds_found(const CalibrateCommand& command) {
    const unsigned folds = folds_of(command.folds);
    const std::uint64_t seed = seed_of(command.seed);
    const Measuring measuring("estimate", command.threads);
    if (command.target == "geometry")
        return reports::fold_geometry(list_of(command.gpus), folds, seed, measuring.options());
    return {reports::fold_peeling(published_peeling(command), folds, seed, peeling_options(command, measuring))};
}

void fold(const CalibrateCommand& command) {
    const auto cards = folds_found(command);
    const auto document = reports::folds_json(cards);
    const std::string written = written_tables(command, document, reports::folds_tables(cards));
    print(command.json ? reports::result_text(document) : reports::folds_text(cards, terminal_style()) + written);
}

std::vector<reports::GpuCalibration> calibrations_of(const CalibrateCommand& command) {
    if (command.target == "peeling") {
        const Measuring measuring("detailed", command.threads);
        return {reports::calibrate_peeling(published_peeling(command), peeling_options(command, measuring))};
    }
    const Measuring measuring(command.fidelity.empty() ? "detailed" : command.fidelity, command.threads);
    return reports::calibrate_geometry(list_of(command.gpus), measuring.options());
}

} // namespace

void calibrate(const CalibrateCommand& command) {
    check_calibrate(command);
    if (!command.folds.empty()) return fold(command);
    const auto calibrations = calibrations_of(command);
    std::string written;
    if (!command.directory.empty()) {
        written = fmt::format("\nWritten: {}\n",
                              fmt::join(reports::write_calibration(calibrations, command.directory), ", "));
    }
    const auto document = reports::calibration_json(calibrations);
    written += written_tables(command, document, {reports::calibration_table(calibrations)});
    print(command.json ? reports::result_text(document)
                       : reports::calibration_text(calibrations, terminal_style()) + written);
}

} // namespace cli
