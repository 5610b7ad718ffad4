// The picture of a solid made of drawn objects (specification 004, A13): the base colour of the draw whose fragment
// lies on the surface, lit by a lamp at the eye; normals are differences of depths.
#pragma once

#include "traces/workloads/csg_surface.hpp"

#include <span>
#include <utility>
#include <vector>

namespace traces {

class CsgPicture final : public pipeline::Resolve {
  public:
    explicit CsgPicture(CsgExpression expression) : expression_(std::move(expression)) {}

    const CsgExpression& expression() const { return expression_; }

    std::vector<float> picture(const pipeline::Frame& frame, const pipeline::FinishedSurfaces& surfaces) const override;

    /// The same of a surface however found: RGBA floats per pixel.
    static std::vector<float> shaded(const pipeline::Frame& frame, const CsgSurface& surface);

  private:
    CsgExpression expression_;
};

} // namespace traces
