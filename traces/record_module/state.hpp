// Reading the state that draws and clears depend on.
#pragma once

#include "traces/record_module/stream.hpp"

namespace record {

record_stream::State current_state();
/// For draws without a program, and for programs that read old built-in uniforms. In compatibility profiles alone.
record_stream::FixedFunction current_fixed_function();

/// The target of a fixed-function unit that counts: the enabled one with the most dimensions; 0: none.
std::uint32_t enabled_target(std::uint32_t unit);

} // namespace record
