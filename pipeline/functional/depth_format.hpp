// Depth surfaces: D16, D24 and D32F as codes that compare like the format does.
#pragma once

#include "pipeline/frame.hpp"

#include <bit>
#include <cstdint>

namespace pipeline {

/// A stored depth. Codes of one format order as their depths do, so a depth test is an integer comparison.
using DepthCode = std::uint32_t;

constexpr std::uint32_t depth_bytes(DepthFormat format) { return format == DepthFormat::d16 ? 2 : 4; }

/// What the surface stores for window depth `depth`: round(depth * (2^bits - 1)) to nearest even, or the float's own
/// bits. Depths outside [0,1] are clamped; NaN counts as 0.
DepthCode depth_code(DepthFormat format, float depth);

/// The depth that a code stands for, in [0,1].
float depth_value(DepthFormat format, DepthCode code);

/// The code of depth 1, to which a depth surface is cleared.
DepthCode farthest_depth(DepthFormat format);

/// The fixed-function depth test. Strict: the first of equal depths stays.
constexpr bool depth_less(DepthCode incoming, DepthCode stored) { return incoming < stored; }

} // namespace pipeline
