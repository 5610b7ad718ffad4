// What has to hold between the parts of a recording before anything relies on it: numbers name what is there, sizes and
// bytes agree, rectangles lie inside. SPIR-V modules are checked by who runs them (module_faults()).
#pragma once

#include "traces/recording/recording.hpp"

namespace traces {

namespace limits {

inline constexpr std::uint32_t largest_surface = 16384;   ///< texels along a side
inline constexpr std::uint32_t most_layers = 2048;        ///< or slices (OpenGL 4.5, table 23.53)
inline constexpr std::uint32_t longest_buffer = 1U << 27; ///< texels
inline constexpr std::uint32_t largest_blit = 1U << 16;   ///< texels along a side, or away, of either rectangle
inline constexpr std::uint32_t most_module_words = 1U << 20;
inline constexpr std::uint32_t most_commands = 1U << 20; ///< of all frames
inline constexpr std::uint32_t most_instances = 1U << 20;
inline constexpr std::uint32_t most_vertices = 1U << 24; ///< where no buffer bounds them

} // namespace limits

/// Throws sim::InputError "WHERE: PART: expected ..." for the first thing that is wrong.
void check_recording(const Recording& recording, const std::string& where);

/// A line for each shader that the interpreter does not take.
std::vector<std::string> module_faults(const Recording& recording, const std::string& where);

} // namespace traces
