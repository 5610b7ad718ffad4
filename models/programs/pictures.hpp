// Pictures of programs whose result is not k layers of one opacity.
#pragma once

#include "pipeline/resolve.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace models {

/// Where red, green, blue (premultiplied) and transmittance lie in an entry or in a state.
using ColourSlots = std::array<std::uint32_t, 4>;

/// The state's colour before the background: C + T * background.
std::shared_ptr<const pipeline::Resolve> state_picture(const ColourSlots& slots);

/// The entries' colours composited in stored order before the background.
std::shared_ptr<const pipeline::Resolve> node_picture(const ColourSlots& slots);

} // namespace models
