// Nested JSON as a list of paths and values.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace reports {

using FlatValues = std::vector<std::pair<std::string, nlohmann::ordered_json>>;

/// The leaves of `json` in their order: {"cache": {"hits": 3}} -> "cache.hits", 3. Of a histogram only count, mean, min
/// and max; elements of an array have their number as name.
FlatValues flatten(const nlohmann::ordered_json& json);

/// A leaf as the text of a table cell: text without quotes, numbers in their shortest form.
std::string cell_text(const nlohmann::ordered_json& leaf);

} // namespace reports
