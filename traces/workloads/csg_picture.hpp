// The picture of a solid made of drawn objects (specification 004, A13): the base colour of the draw whose fragment
// lies on the surface, lit by a lamp at the eye; normals are differences of depths.
#pragma once

#include "traces/workloads/csg_surface.hpp"

#include <vector>

namespace traces {

/// Of `frame`, which is complete but for its passes.
models::MakePicture csg_picture(const pipeline::Frame& frame, const CsgExpression& expression);

/// The same of a surface however found: RGBA floats per pixel.
std::vector<float> shaded(const pipeline::Frame& frame, const CsgSurface& surface);

} // namespace traces
