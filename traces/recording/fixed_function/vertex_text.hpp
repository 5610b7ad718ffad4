// The vertex shader of a fixed-function state.
#pragma once

#include "traces/recording/fixed_function.hpp"
#include "traces/recording/fixed_function/shader_text.hpp"

namespace traces::fixed_function {

/// Writes what `fragment` reads.
ShaderText vertex_text(const FixedFunctionState& state, const ShaderText& fragment);

/// Whether a vertex says how large its point is.
bool sizes_points(const FixedFunctionState& state);

} // namespace traces::fixed_function
