// Recorded frames in a few lines: what is drawn, with what, and what was not recorded.
#pragma once

#include "traces/recording/recording.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace reports {

nlohmann::ordered_json recording_info(const traces::Recording& recording);

/// In one line, of what recording_info() says.
std::string recording_summary(const nlohmann::ordered_json& info);

std::string recording_info_text(const nlohmann::ordered_json& info);

} // namespace reports
