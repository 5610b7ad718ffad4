// Blur of a layer by circles of confusion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <vector>

namespace traces {

/// A thin lens that is focused on one distance; the picture plane spans the field of view at the focal length.
struct Lens {
    double aperture = 0;         ///< diameter; scene units, as all lengths
    double focal_length = 0;     ///< less than `focus`
    double focus = 0;            ///< distance that is sharp
    double pixels_per_slope = 0; ///< of a pixel's place per x / z or y / z in eye space

    /// Diameter in pixels of the circle that a point at this distance becomes: A f |z - z_f| / (z (z_f - f)) on the
    /// picture plane (specification 004, A14).
    double circle_of_confusion(double distance) const;
};

/// Spreads points evenly over discs and adds them up. What a disc loses at the border of the picture is lost.
class DiscAccumulator {
  public:
    DiscAccumulator(std::uint32_t width, std::uint32_t height);

    /// A point of pixel (x, y). Discs have borders of one pixel in which their weight falls off; a disc of diameter 1
    /// or less is its pixel.
    void add(std::uint32_t x, std::uint32_t y, double diameter, const glm::vec3& colour);

    /// Per pixel the mean colour of the discs over it, and how much of it they cover together, at most 1.
    std::vector<glm::vec4> picture() const;

  private:
    struct Run {
        int row, first, last; ///< relative to the pixel; both ends included
        double weight;
    };
    const std::vector<Run>& disc(double diameter);

    std::uint32_t width_, height_;
    std::vector<glm::dvec4> steps_;         ///< by row: what is added to a sum that runs along it
    std::map<int, std::vector<Run>> discs_; ///< by diameter, in quarters of a pixel
};

} // namespace traces
