// Lighting of vertices, section 2.14: the part of a vertex shader that makes colours.
#pragma once

#include "traces/recording/fixed_function.hpp"
#include "traces/recording/fixed_function/shader_text.hpp"

#include <functional>

namespace traces::fixed_function {

/// Position and normal in eye space, which a vertex shader computes when something asks for them.
struct EyeSpace {
    std::function<std::string()> position, normal;
};

/// Statements that leave a colour in the locals lit_front or lit_back, and what is added behind the textures in
/// shine_front or shine_back.
void light_side(const FixedFunctionState& state, bool front, const EyeSpace& eye, ShaderText& text);

} // namespace traces::fixed_function
