// What has to be said behind a table: first what makes its numbers meaningless, then what of the input was not read as
// it stands.
#pragma once

#include "reports/comparison_result.hpp"
#include "reports/terminal_table.hpp"

#include <string>
#include <vector>

namespace reports {

/// Each once, in the order of their first appearance.
std::vector<std::string> each_once(const std::vector<std::string>& notes);

/// Of a comparison: where nothing was drawn, why; designs that did the same and were run once; the notes of the scene.
std::vector<std::string> remarks(const Comparison& comparison);

/// Why a frame without a fragment has none, from the counters of clipping and culling of a run; empty where it has any.
std::string nothing_drawn(const pipeline::RunResult& run);

/// "Notes:" and a line for each; empty without any.
std::string remarks_text(const std::vector<std::string>& remarks, TerminalStyle style);

} // namespace reports
