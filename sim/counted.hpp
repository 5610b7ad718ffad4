// Counts as people read them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sim {

std::string with_commas(std::uint64_t number); ///< 1234567 -> "1,234,567"

/// "1 message", "2,000 messages": the number, and what is counted in singular or plural. The last word of `noun`,
/// which is in the singular, takes the plural.
std::string counted(std::uint64_t number, std::string_view noun);

} // namespace sim
