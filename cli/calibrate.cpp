// ropsim calibrate: numbers of GPU files from published measurements.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/measuring.hpp"
#include "reports/geometry/json.hpp"
#include "reports/geometry/text.hpp"
#include "reports/result.hpp"
#include "sim/check.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace cli {

void calibrate(const CalibrateCommand& command) {
    expect_geometry("calibrate", command.target);
    // Known before minutes of runs, not after them.
    if (!command.directory.empty() && !std::filesystem::is_directory(command.directory))
        throw sim::InputError(fmt::format("--write: {}: expected a folder of GPU files", command.directory));
    Measuring measuring(command.fidelity, command.threads);
    const auto calibrations = reports::calibrate_geometry(list_of(command.gpus), measuring.options());
    measuring.end();
    std::string written;
    if (!command.directory.empty()) {
        const FilesInProgress keep_alive;
        written = fmt::format("\nWritten: {}\n",
                              fmt::join(reports::write_calibration(calibrations, command.directory), ", "));
    }
    print(command.json ? reports::result_text(reports::calibration_json(calibrations))
                       : reports::calibration_text(calibrations, terminal_style()) + written);
}

} // namespace cli
