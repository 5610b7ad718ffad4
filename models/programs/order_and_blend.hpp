// Modify program A7, order-and-blend (Bavoil 2007, section 6.3): sorts a nearly sorted stream and composites it.
//
// Of the k entries and the fragment, the nearest is composited front to back into the pixel's state and dropped; the
// others stay, sorted. That sorts every stream in which no fragment is more than k places from its sorted place. Empty
// entries are nearer than every fragment and contribute nothing, so the first k pops are neutral; the drain pops the
// last k. Of equal depths the first arrival is popped first.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <cstdint>
#include <limits>
#include <memory>

namespace models {

/// Depth of an entry that holds no fragment yet: nearer than every window depth and every distance, and finite.
inline constexpr float sentinel_depth = std::numeric_limits<float>::lowest();

/// Entries `rgbz`; state: red, green and blue so far, weighted by what they were seen through, and the transmittance
/// left.
/// @param k       entries, 1 to 63: with the state they are at most 64 render targets
/// @param opacity of every fragment, 0 to 1
std::shared_ptr<const pipeline::ModifyProgram> make_order_and_blend(std::uint32_t k, float opacity);

} // namespace models
