#include "pipeline/functional/eye_depth.hpp"

#include <algorithm>
#include <limits>

namespace pipeline {

namespace {

constexpr double largest = std::numeric_limits<float>::max();

double finite_ratio(double over, double under) {
    const double ratio = over / under;
    if (ratio != ratio) return 0.0;
    return std::clamp(ratio, -largest, largest);
}

} // namespace

// z_clip = z_slope * d + z_offset and w_clip = w_slope * d + w_offset, where d = -z_eye.
EyeDepth::EyeDepth(const glm::mat4& projection)
    : z_slope_(-static_cast<double>(projection[2][2])),
      z_offset_(static_cast<double>(projection[3][2])),
      w_slope_(-static_cast<double>(projection[2][3])),
      w_offset_(static_cast<double>(projection[3][3])) {}

// With n = 2 window - 1 solved for d. A perspective has w_slope = 1 and w_offset = 0, a parallel projection the
// reverse; n - z_slope or n - z_offset then loses digits near the far plane unless the whole numbers in it are joined
// first, which a double does exactly for floats.
double EyeDepth::distance(float window) const {
    const double beyond = window < 1.0F ? static_cast<double>(std::max(window, 0.0F)) - 1.0 : 0.0; // from the far plane
    const double over = (z_offset_ - w_offset_) - 2.0 * beyond * w_offset_;
    const double under = (w_slope_ - z_slope_) + 2.0 * beyond * w_slope_;
    // At the far plane of a perspective that has none, the denominator is a zero that a distance approaches from above.
    if (under == 0.0) return largest;
    return finite_ratio(over, under);
}

float EyeDepth::window(double distance) const {
    const double z = z_offset_ + z_slope_ * distance, w = w_offset_ + w_slope_ * distance;
    if (perspective() && w <= 0.0) return 0.0F; // at the eye or behind it
    return static_cast<float>(std::clamp(0.5 + 0.5 * finite_ratio(z, w), 0.0, 1.0));
}

} // namespace pipeline
