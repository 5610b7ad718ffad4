// Tables of text for the terminal: titles, units below them, rows.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace reports {

struct TerminalStyle {
    static constexpr std::size_t widest = 120;

    bool colour = false;          ///< ANSI colours
    std::size_t columns = widest; ///< characters a line may have
};

struct TextColumn {
    std::string title, unit;
    bool is_text = false; ///< to the left; numbers stand to the right
};

/// Columns as wide as their widest cell, two blanks between them; every row has one cell per column. On terminals
/// narrower than usual a table that is too wide continues below, with its first column again, and cut ("~") where it
/// must.
std::string text_table(const std::vector<TextColumn>& columns, const std::vector<std::vector<std::string>>& rows,
                       TerminalStyle style);

/// Numbers of the columns that stand side by side, block by block; all but the first block repeat column 0.
std::vector<std::vector<std::size_t>> folded(const std::vector<std::size_t>& widths, TerminalStyle style);

} // namespace reports
