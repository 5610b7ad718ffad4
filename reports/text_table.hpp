// Tables of text for the terminal: titles, units below them, rows.
#pragma once

#include <string>
#include <vector>

namespace reports {

struct TextColumn {
    std::string title, unit;
    bool is_text = false; ///< to the left; numbers stand to the right
};

/// Columns as wide as their widest cell, two blanks between them; every row has one cell per column.
std::string text_table(const std::vector<TextColumn>& columns, const std::vector<std::vector<std::string>>& rows,
                       bool colour);

} // namespace reports
