// Where the ray through a pixel enters and leaves a box or a sphere: known answers for pictures of simple scenes.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/view_rays.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace support {

/// Distances along the view axis; empty when `enter` is not less than `leave`.
struct Interval {
    double enter = 0.0, leave = 0.0;
    bool empty() const { return !(enter < leave); }
};

/// The ray through the centre of a pixel in world space: points origin + distance * step.
class PixelRay {
  public:
    PixelRay(const pipeline::View& view, std::uint32_t x, std::uint32_t y) {
        const glm::dmat4 to_world = glm::inverse(glm::dmat4(view.view));
        const traces::ViewRays rays(view);
        const glm::dvec3 near = rays.place(x, y, 1.0), far = rays.place(x, y, 2.0);
        step_ = glm::dvec3(to_world * glm::dvec4(far - near, 0.0));
        origin_ = glm::dvec3(to_world * glm::dvec4(near, 1.0)) - step_;
    }

    /// Length of the ray for each unit of distance along the view axis.
    double stretch() const { return glm::length(step_); }
    glm::dvec3 at(double distance) const { return origin_ + distance * step_; }
    const glm::dvec3& step() const { return step_; }

    Interval in_box(const glm::dvec3& lo, const glm::dvec3& hi) const {
        Interval inside{-INFINITY, INFINITY};
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (lo[axis] - origin_[axis]) / step_[axis], b = (hi[axis] - origin_[axis]) / step_[axis];
            inside.enter = std::max(inside.enter, std::min(a, b));
            inside.leave = std::min(inside.leave, std::max(a, b));
        }
        return inside;
    }

    /// Round the origin.
    Interval in_sphere(double radius) const {
        const double a = glm::dot(step_, step_), b = glm::dot(origin_, step_);
        const double root = b * b - a * (glm::dot(origin_, origin_) - radius * radius);
        if (root <= 0.0) return {};
        return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
    }

  private:
    glm::dvec3 origin_{0.0}, step_{0.0};
};

} // namespace support
