// The fragment shader of a fixed-function state.
#pragma once

#include "traces/recording/fixed_function.hpp"
#include "traces/recording/fixed_function/shader_text.hpp"

namespace traces::fixed_function {

struct FragmentText {
    ShaderText text; ///< its inputs are what the vertex shader has to write
    std::vector<std::uint32_t> units;
};

FragmentText fragment_text(const FixedFunctionState& state);

/// Names of what vertex shaders hand to fragment shaders: front_colour, coordinate3.
std::string colour_name(bool front, bool secondary);
std::string coordinate_name(std::uint32_t unit);

/// Whether colours of both sides reach the fragments.
bool two_sided(const FixedFunctionState& state);
bool adds_secondary(const FixedFunctionState& state);
/// Whether fragments take the unit's coordinates from their place in the point.
bool takes_sprite_place(const FixedFunctionState& state, std::uint32_t unit);
bool fades(const FixedPoints& points);

} // namespace traces::fixed_function
