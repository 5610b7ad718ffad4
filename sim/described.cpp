#include "sim/described.hpp"

#include <fmt/format.h>

namespace sim {

std::string number_text(double number) { return fmt::format("{}", number); }

std::string number_text(float number) { return fmt::format("{}", number); }

std::string csv_line(const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i != 0) line += ',';
        if (cells[i].find_first_of(",\"\r\n") == std::string::npos) {
            line += cells[i];
            continue;
        }
        line += '"';
        for (const char c : cells[i]) line.append(c == '"' ? 2 : 1, c);
        line += '"';
    }
    return line + '\n';
}

namespace detail {

std::string join_path(std::string_view prefix, std::string_view name) {
    return prefix.empty() ? std::string(name) : fmt::format("{}.{}", prefix, name);
}

std::string with_unit(std::string path, std::string_view unit) {
    return unit.empty() ? path : fmt::format("{} [{}]", path, unit);
}

} // namespace detail
} // namespace sim
