// Numbers into the lines of GPU files.
#include "reports/atomic_file.hpp"
#include "reports/geometry/calibration.hpp"

#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sstream>

namespace reports {

namespace {

struct Entry {
    std::string section, key; ///< "host.convert.normal", "s8_ns"
    double value = 0;
    std::string origin, source;

    Entry(const std::string& parameter, double number, std::string where, std::string why)
        : value(number), origin(std::move(where)), source(std::move(why)) {
        const std::size_t dot = parameter.rfind('.');
        section = parameter.substr(0, dot);
        key = parameter.substr(dot + 1);
    }
    std::string line() const {
        std::string number = fmt::format("{:.4g}", value);
        if (number.find_first_of(".e") == std::string::npos) number += ".0";
        return fmt::format("{} = {{ value = {}, origin = \"{}\", source = \"{}\" }}", key, number, origin, source);
    }
};

std::vector<Entry> entries_of(const GpuCalibration& calibration) {
    std::vector<Entry> entries;
    for (const CalibratedNumber& number : calibration.numbers)
        entries.emplace_back(number.step.parameter, number.value, "calibrated",
                             fmt::format("{}{}; {}", number.step.row,
                                         number.step.kind == CalibrationKind::penalty ? " (driver penalty)" : "",
                                         calibration.command));
    for (const ScaledNumber& number : calibration.scaled)
        entries.emplace_back(number.rule.parameter, number.value, "calibrated",
                             fmt::format("that of {} by {}; {}", number.rule.from,
                                         number.rule.by == Scaling::memory ? "bandwidth of memory" : "vertex units",
                                         calibration.command));
    return entries;
}

// Replaces the line of the key in its section; adds it at the section's head, and the section at the end of the file,
// where they are missing.
void put(std::vector<std::string>& lines, const Entry& entry) {
    const std::string header = fmt::format("[{}]", entry.section);
    std::size_t i = 0;
    while (i < lines.size() && !lines[i].starts_with(header)) ++i;
    if (i == lines.size()) {
        lines.insert(lines.end(), {"", header, entry.line()});
        return;
    }
    const std::size_t head = i + 1;
    for (i = head; i < lines.size() && !lines[i].starts_with('['); ++i)
        if (lines[i].starts_with(entry.key + " ")) {
            lines[i] = entry.line();
            return;
        }
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(head), entry.line());
}

std::vector<std::string> lines_of(const std::string& path) {
    std::ifstream file(path);
    if (!file.is_open()) throw sim::InputError(fmt::format("{}: cannot be read", path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
}

} // namespace

std::vector<std::string> write_calibration(const std::vector<GpuCalibration>& calibrations,
                                           const std::string& directory) {
    std::vector<std::string> written;
    for (const GpuCalibration& calibration : calibrations) {
        const std::string path = fmt::format("{}/{}.toml", directory, calibration.gpu);
        std::vector<std::string> lines = lines_of(path);
        for (const Entry& entry : entries_of(calibration)) put(lines, entry);
        write_file(path, fmt::format("{}\n", fmt::join(lines, "\n")));
        written.push_back(path);
    }
    return written;
}

} // namespace reports
