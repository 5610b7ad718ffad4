// A fixed-function state given to the OpenGL context that is current.
#pragma once

#include "traces/recording/fixed_function.hpp"

#include <cstdint>

namespace tests {

/// All of it but the contents of textures.
void set_fixed_function(const traces::FixedFunctionState& state);
/// What shaders leave to the pipeline: which clip distances cut, points, clamping.
void set_around_shaders(const traces::FixedFunctionState& state);

/// Of glBindTexture.
std::uint32_t texture_target(traces::UnitTarget target);

} // namespace tests
