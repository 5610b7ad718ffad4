// "did you mean": the known name that is nearest to a mistyped one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// "; did you mean 'NAME'?" for the nearest of `known`, or "" when none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

/// Edits (insert, remove, replace, swap of neighbours) that turn one word into the other.
std::size_t edit_distance(std::string_view from, std::string_view to);

} // namespace sim
