#include "traces/view_rays.hpp"

namespace traces {

ViewRays::ViewRays(const pipeline::View& view)
    : projection_(view.projection), pixel_(2.0 / view.width, 2.0 / view.height), depth_(view.projection) {}

// x_clip = p00 x + p20 z + p30 is solved for x, with x_clip = x_ndc * w_clip; y likewise. Row 0 is at the top.
glm::dvec3 ViewRays::place(std::uint32_t x, std::uint32_t y, double distance) const {
    const glm::dmat4& p = projection_;
    const double z = -distance, w = p[2][3] * z + p[3][3];
    const glm::dvec2 ndc((x + 0.5) * pixel_.x - 1.0, 1.0 - (y + 0.5) * pixel_.y);
    return {(ndc.x * w - p[2][0] * z - p[3][0]) / p[0][0], (ndc.y * w - p[2][1] * z - p[3][1]) / p[1][1], z};
}

} // namespace traces
