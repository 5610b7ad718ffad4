// Where in eye space a pixel's surfaces lie.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/functional/eye_depth.hpp"

#include <cstdint>
#include <glm/glm.hpp>

namespace traces {

/// The rays through the centres of the pixels of a view.
class ViewRays {
  public:
    explicit ViewRays(const pipeline::View& view);

    /// The point of the ray through pixel (x, y) at this distance along the view axis, in eye space.
    glm::dvec3 place(std::uint32_t x, std::uint32_t y, double distance) const;
    /// Distance along the view axis of a window depth.
    double distance(float window) const { return depth_.distance(window); }
    /// Length of the ray between two distances.
    double length(std::uint32_t x, std::uint32_t y, double from, double to) const {
        return glm::length(place(x, y, to) - place(x, y, from));
    }

  private:
    glm::dmat4 projection_;
    glm::dvec2 pixel_; ///< size of a pixel in normalised device coordinates
    pipeline::EyeDepth depth_;
};

} // namespace traces
