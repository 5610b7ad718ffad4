// result.json: everything a comparison found, for programs. reports/result.schema.json states what each number means.
#pragma once

#include "reports/comparison_result.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace reports {

/// Two runs of one comparison differ below "host" only.
nlohmann::ordered_json result_json(const Comparison& comparison);

/// The text of result.json: indented, a line feed at the end.
std::string result_text(const nlohmann::ordered_json& result);

/// "0.1.0", and compiler, build type and commit.
std::string version_text();
std::string build_text();

} // namespace reports
