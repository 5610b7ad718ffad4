// All stiff and extreme cases. A new one is an entry in the list of its group's file; a new group is a file and a line
// in catalogue.cpp.
#pragma once

#include "reports/stability/case.hpp"

#include <atomic>
#include <string>
#include <vector>

namespace reports::stability {

/// In the order of the groups; every id once.
const std::vector<Case>& catalogue();

/// Cases whose id matches one of the patterns, which are separated by commas: `*` stands for any characters, `?` for
/// one. All for "". Throws sim::InputError when a pattern matches none.
std::vector<const Case*> cases_matching(const std::string& patterns);

/// Runs them on the machine's cores; outcomes in the order of `cases`.
/// @param stop when it becomes true, sim::Interrupted is thrown
std::vector<Outcome> run(const std::vector<const Case*>& cases, const std::atomic<bool>* stop = nullptr);

// The groups, one per file.
std::vector<Case> depth_format_cases();
std::vector<Case> peeling_cases();
std::vector<Case> kbuffer_cases();
std::vector<Case> rasterization_cases();
std::vector<Case> blending_cases();
std::vector<Case> half_cases();
std::vector<Case> shadow_cases();
std::vector<Case> shadow_search_cases();
std::vector<Case> field_cases();
std::vector<Case> distance_cases();
std::vector<Case> geometry_cases();
std::vector<Case> door_cases();
std::vector<Case> frame_cases();
std::vector<Case> hardware_cases();

} // namespace reports::stability
