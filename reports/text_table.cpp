#include "reports/text_table.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports {

namespace {

std::string line_of(const std::vector<std::string>& cells, const std::vector<TextColumn>& columns,
                    const std::vector<std::size_t>& widths) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i > 0) line += "  ";
        line += columns[i].is_text ? fmt::format("{:<{}}", cells[i], widths[i])
                                   : fmt::format("{:>{}}", cells[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return line;
}

} // namespace

std::string text_table(const std::vector<TextColumn>& columns, const std::vector<std::vector<std::string>>& rows,
                       bool colour) {
    std::vector<std::size_t> widths;
    std::vector<std::string> titles, units;
    for (const TextColumn& column : columns) {
        titles.push_back(column.title);
        units.push_back(column.unit);
        widths.push_back(std::max(column.title.size(), column.unit.size()));
    }
    for (const auto& row : rows) {
        CHECK(row.size() == columns.size());
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    const std::string head = line_of(titles, columns, widths);
    std::string text = (colour ? fmt::format("\033[1m{}\033[0m", head) : head) + "\n";
    if (std::any_of(units.begin(), units.end(), [](const std::string& unit) { return !unit.empty(); }))
        text += line_of(units, columns, widths) + "\n";
    for (const auto& row : rows) text += line_of(row, columns, widths) + "\n";
    return text;
}

} // namespace reports
