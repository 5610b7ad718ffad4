// Small pieces of HTML.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace reports {

/// Text with &, <, > and quotes made harmless.
std::string escape_html(std::string_view text);

/// JSON as the content of a script element: no "</script>" can occur in it.
std::string script_json(const nlohmann::ordered_json& json);

struct HtmlCell {
    std::string text;
    std::string kind; ///< class of the cell: "", "number", "bad", "good"
};

/// A table; the cells are escaped here.
std::string html_table(const std::vector<std::string>& header, const std::vector<std::vector<HtmlCell>>& rows);

/// A part that is folded up until it is clicked; `body` is HTML.
std::string html_details(std::string_view summary, std::string_view body);

} // namespace reports
