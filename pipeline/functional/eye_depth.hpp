// Window depth and distance from the eye along the view axis.
#pragma once

#include <glm/glm.hpp>

namespace pipeline {

/// Converts between window depths in [0,1] and distances along the view axis (the unit of the scene), for perspective
/// and parallel projections with a plane at each end, and for a perspective without a far plane. The differences in
/// which almost equal numbers cancel are formed exactly, so that distances near the far plane are as good as the
/// matrix.
class EyeDepth {
  public:
    explicit EyeDepth(const glm::mat4& projection);

    /// Distance of a window depth; what lies outside [0,1] counts as the nearer end. Finite: at most the largest float.
    double distance(float window) const;
    /// Window depth of a distance, in [0,1].
    float window(double distance) const;

    /// Distances grow faster towards the far plane.
    bool perspective() const { return w_slope_ != 0.0; }

  private:
    // With distance d and n = 2 * window - 1: n = (z_offset_ + z_slope_ * d) / (w_offset_ + w_slope_ * d).
    double z_slope_, z_offset_, w_slope_, w_offset_;
};

} // namespace pipeline
