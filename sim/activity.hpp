// What one tick of a component amounted to. This one value decides sleeping, books the stall table and draws the
// timeline slice.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace sim {

enum class Activity : std::uint8_t {
    idle,    ///< nothing to do and nothing expected
    busy,    ///< made progress; ticks again at the next edge
    starved, ///< holds nothing and waits for input
    blocked, ///< has output and waits for room downstream
    hazard,  ///< waits for other work on the same data
    memory,  ///< waits for memory, or for latency inside the unit
};

inline constexpr std::size_t activity_count = 6;
inline constexpr std::array<std::string_view, activity_count> activity_names = {"idle",    "busy",   "starved",
                                                                                "blocked", "hazard", "memory"};

constexpr std::string_view to_string(Activity activity) { return activity_names[static_cast<std::size_t>(activity)]; }

} // namespace sim
