#include "reports/html/markup.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

std::string escape_html(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        case '\'':
            result += "&#39;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

std::string script_json(const nlohmann::ordered_json& json) {
    std::string result;
    for (const char c : json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace))
        if (c == '<')
            result += "\\u003c";
        else
            result += c;
    return result;
}

std::string html_table(const std::vector<std::string>& header, const std::vector<std::vector<HtmlCell>>& rows) {
    constexpr std::size_t many = 12; // columns that a page has room for in its usual letters
    std::string html =
        fmt::format("<div class=\"scroll\"><table{}><thead><tr>", header.size() > many ? " class=\"many\"" : "");
    for (std::size_t i = 0; i < header.size(); ++i) {
        const bool numbers = !rows.empty() && rows.front().at(i).kind.starts_with("number");
        html += fmt::format("<th{}>{}</th>", numbers ? " class=\"number\"" : "", escape_html(header[i]));
    }
    html += "</tr></thead><tbody>\n";
    for (const auto& row : rows) {
        html += "<tr>";
        for (const HtmlCell& cell : row)
            html += fmt::format("<td{}>{}</td>", cell.kind.empty() ? "" : fmt::format(" class=\"{}\"", cell.kind),
                                escape_html(cell.text));
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string html_details(std::string_view summary, std::string_view body) {
    return fmt::format("<details><summary>{}</summary>\n{}</details>\n", escape_html(summary), body);
}

} // namespace reports
