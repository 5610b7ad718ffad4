// A checker for the part of JSON Schema (draft 2020-12) that the project's schemas use.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace ropsim_test {

/// One line per violation, "/designs/0/cycles: expected integer"; empty when `document` follows `schema`. Knows type,
/// required, properties, additionalProperties, items, enum, minimum and $ref within the schema; any other keyword that
/// would restrict the document is reported as well.
std::vector<std::string> schema_violations(const nlohmann::json& schema, const nlohmann::json& document);

} // namespace ropsim_test
