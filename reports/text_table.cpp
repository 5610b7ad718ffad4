#include "reports/text_table.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports {

namespace {

std::string line_of(const std::vector<std::string>& cells, const std::vector<TextColumn>& columns,
                    const std::vector<std::size_t>& widths, const std::vector<std::size_t>& block) {
    std::string line;
    for (const std::size_t i : block) {
        if (i != block.front()) line += "  ";
        const std::string cell = cells[i].size() > widths[i] ? cells[i].substr(0, widths[i] - 1) + "~" : cells[i];
        line += columns[i].is_text ? fmt::format("{:<{}}", cell, widths[i]) : fmt::format("{:>{}}", cell, widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return line;
}

} // namespace

std::vector<std::vector<std::size_t>> folded(const std::vector<std::size_t>& widths, TerminalStyle style) {
    std::vector<std::vector<std::size_t>> blocks(1);
    std::size_t width = 0;
    for (std::size_t i = 0; i < widths.size(); ++i) {
        const bool fits = blocks.back().empty() || width + 2 + widths[i] <= style.columns;
        if (!fits && blocks.back().size() > 1 && style.columns < TerminalStyle::widest) {
            blocks.push_back({0});
            width = widths[0];
        }
        width += (blocks.back().empty() ? 0 : 2) + widths[i];
        blocks.back().push_back(i);
    }
    return blocks;
}

std::string text_table(const std::vector<TextColumn>& columns, const std::vector<std::vector<std::string>>& rows,
                       TerminalStyle style) {
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
    if (style.columns < TerminalStyle::widest && widths.size() > 1) {
        // The first column stands beside every other one: it has the room that the widest of them leaves.
        constexpr std::size_t least = 8;
        const std::size_t other = *std::max_element(widths.begin() + 1, widths.end());
        const auto room_beside = [&](std::size_t width) {
            return std::max(least, style.columns - std::min(style.columns, width + 2));
        };
        widths[0] = std::min(widths[0], room_beside(other));
        for (std::size_t i = 1; i < widths.size(); ++i)
            if (columns[i].is_text) widths[i] = std::min(widths[i], room_beside(widths[0]));
    }
    const bool with_units =
        std::any_of(units.begin(), units.end(), [](const std::string& unit) { return !unit.empty(); });
    std::string text;
    for (const auto& block : folded(widths, style)) {
        const std::string head = line_of(titles, columns, widths, block);
        text += (text.empty() ? "" : "\n") + (style.colour ? fmt::format("\033[1m{}\033[0m", head) : head) + "\n";
        if (with_units) text += line_of(units, columns, widths, block) + "\n";
        for (const auto& row : rows) text += line_of(row, columns, widths, block) + "\n";
    }
    return text;
}

} // namespace reports
