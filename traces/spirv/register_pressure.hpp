// How many 128-bit registers a shader needs at once: what limits the quads in flight.
#pragma once

#include "traces/spirv/module.hpp"

#include <cstdint>

namespace traces::spirv {

/// Most scalars that are live at one instruction, four to a register, at least 1. A value lives from where it is made
/// to its last use in the order of the module, one from before a loop that is used in it to the loop's end; variables
/// of functions and outputs live all the time. Constants, uniforms and inputs before they are read take none. A
/// compiler that orders instructions anew can do with fewer.
std::uint32_t register_pressure(const Module& module);

} // namespace traces::spirv
