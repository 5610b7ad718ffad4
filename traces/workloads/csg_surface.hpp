// The surface of a solid made of drawn objects (specification 004, A13).
#pragma once

#include "pipeline/frame.hpp"
#include "traces/workloads/csg_expression.hpp"
#include "traces/workloads/surface_image.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace traces {

struct CsgSurface {
    SurfaceImage image;
    std::vector<std::uint32_t> objects; ///< by pixel: the draw whose fragment lies on the surface
};

/// Per pixel, from front to back, a fragment changes whether one is inside its draw; the first one behind which the
/// expression holds is the surface. What holds before the first fragment (of `!A`, say) is not looked at. `kbuffer` has
/// entries `zo` of the frame's program.
CsgSurface csg_surface(const pipeline::Frame& frame, std::span<const float> kbuffer, const CsgExpression& expression);

} // namespace traces
