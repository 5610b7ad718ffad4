// The shaders that run the functions of a modify program in GLSL: each reads and writes a pixel as its render targets
// hold it, in arrays of four floats.
#pragma once

#include "traces/shader_programs/declaration.hpp"

namespace traces::shader_programs {

enum class Task : std::uint8_t {
    entry,  ///< fragment to entry
    clear,  ///< pixel that no fragment has reached
    copy,   ///< the pixel as it is: what reading and writing it takes
    modify, ///< by one entry
    drain
};

/// Names of the shaders' variables: the pixel before and after; of `entry`: the fragment, and the entry after.
inline constexpr const char* before_name = "kbuffer_before";
inline constexpr const char* after_name = "kbuffer_after";
/// An entry; of `entry`: colour, then depth and draw.
inline constexpr const char* fragment_name = "kbuffer_fragment";

/// GLSL 4.50, a fragment shader. Lines count as in the program's own text, and a call of a function that does not fit
/// has the line of the function. `opacity` is what the workload wants.
std::string task_text(const Declaration& program, Task task, std::uint32_t k, float opacity);

} // namespace traces::shader_programs
