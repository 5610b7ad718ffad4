#include "reports/validation/misses.hpp"

#include "reports/html/markup.hpp"
#include "reports/terminal_table.hpp"
#include "reports/validation/error_report.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports {

std::vector<Misses> large_misses(const std::vector<ValidationRow>& rows, std::string (*named)(const ValidationRow&)) {
    std::vector<Misses> all;
    for (const ValidationRow& row : rows) {
        if (!row.missed()) continue;
        const std::string name = fmt::format("{} ({})", named(row), row_status_text(row));
        const std::string reason = row.explanation.empty() ? "not explained" : row.explanation;
        const auto same =
            std::find_if(all.begin(), all.end(), [&](const Misses& miss) { return miss.reason == reason; });
        if (same == all.end())
            all.push_back({name, reason});
        else
            same->numbers += "; " + name;
    }
    return all;
}

std::string misses_text(const std::vector<Misses>& misses, TerminalStyle style) {
    std::string text;
    for (const Misses& miss : misses)
        text += wrap(fmt::format("  {}: {}", miss.numbers, miss.reason), style.columns, 4);
    return text;
}

std::string misses_html(const std::vector<Misses>& misses) {
    std::string html;
    for (const Misses& miss : misses)
        html += fmt::format("<p><b>{}</b>: {}</p>\n", escape_html(miss.numbers), escape_html(miss.reason));
    return html.empty() ? "<p>None.</p>\n" : html;
}

} // namespace reports
