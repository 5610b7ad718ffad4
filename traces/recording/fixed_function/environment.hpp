// Texture environments as combiners, section 3.8.13: what becomes of the colour so far and a texel.
#pragma once

#include "traces/recording/fixed_function.hpp"

namespace traces::fixed_function {

struct Environment {
    Combiner colour, alpha;
};

/// What the unit's environment does, for the channels that its texture has.
Environment environment_of(const FixedTextureUnit& unit);

/// How many arguments a function takes.
std::uint32_t arguments_of(CombineFunction function);

/// Whether the result depends on the colour of the units before.
bool reads_previous(const Environment& environment);

/// Whether one operation on all four channels does what both combiners do.
bool same_for_all_channels(const Environment& environment);

} // namespace traces::fixed_function
