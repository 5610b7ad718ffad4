// A draw trace in a few lines: of what it is, what it draws, what of the file is what.
#pragma once

#include "reports/text_table.hpp"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace reports {

/// Throws sim::InputError for anything that is not a trace with a frame.
nlohmann::ordered_json trace_info(const std::filesystem::path& path);

/// In one line.
std::string trace_summary(const nlohmann::ordered_json& info);

std::string trace_info_text(const nlohmann::ordered_json& info, TerminalStyle style);

} // namespace reports
