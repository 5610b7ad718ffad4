// The surface of a solid made of drawn objects (specification 004, A13).
#pragma once

#include "pipeline/frame.hpp"
#include "traces/workloads/csg_expression.hpp"
#include "traces/workloads/surface_shader.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace traces {

struct CsgSurface {
    SurfaceImage image;
    std::vector<std::uint32_t> objects; ///< by pixel: the draw whose fragment lies on the surface
};

/// The way of one ray through the objects. What holds before the first surface (of `!A`, say) is not looked at.
class CsgWalk {
  public:
    /// The expression outlives it.
    CsgWalk(const CsgExpression& expression, std::size_t objects) : expression_(expression), inside_(objects) {}

    /// Outside of everything.
    void begin() { std::fill(inside_.begin(), inside_.end(), std::uint8_t{0}); }
    /// Through a surface of an object, into it or out of it; true when the expression holds behind it.
    bool cross(std::uint32_t object) {
        inside_[object] ^= 1U;
        return expression_(inside_);
    }

  private:
    const CsgExpression& expression_;
    std::vector<std::uint8_t> inside_; ///< by object
};

/// The first fragment of a pixel behind which the expression holds, and its draw, which is less than `draws`.
PixelSurface csg_of_pixel(const pipeline::ModifyProgram& program, const float* pixel, const pipeline::EyeDepth& depth,
                          CsgWalk& walk, std::size_t draws);

/// Per pixel, from front to back, the first fragment behind which the expression holds is the surface. `kbuffer` has
/// entries `zo` of the frame's program.
CsgSurface csg_surface(const pipeline::Frame& frame, std::span<const float> kbuffer, const CsgExpression& expression);

} // namespace traces
