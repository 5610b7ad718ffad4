// Blur of a layer by circles of confusion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <mutex>
#include <span>
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

/// Discs around a pixel, of diameters in quarters of a pixel. Their borders are one pixel wide, and their weight falls
/// off there; a disc of diameter 1 or less is its pixel. Each is made when it is first asked for, by whatever thread.
class Discs {
  public:
    /// Pixels of equal weight in a row.
    struct Run {
        int row, first, last; ///< relative to the pixel; both ends included
        double weight;        ///< of each; those of a disc are 1 together
    };

    explicit Discs(double largest_diameter);

    /// Row by row, from left to right.
    std::span<const Run> disc(double diameter) const;
    /// Rows of the largest disc above its pixel, and below it.
    std::uint32_t reach() const;

  private:
    struct Disc {
        std::once_flag made;
        std::vector<Run> runs;
    };
    mutable std::vector<Disc> discs_; ///< by diameter
};

/// Spreads points evenly over discs and adds them up, in a few rows of a picture. What a disc loses at their border is
/// lost.
class DiscAccumulator {
  public:
    /// `discs` outlives it.
    DiscAccumulator(const Discs& discs, std::uint32_t width, std::uint32_t first_row, std::uint32_t rows);

    /// A point of pixel (x, y) of the picture. Each of the rows becomes the same, bit for bit, whichever others there
    /// are.
    void add(std::uint32_t x, std::uint32_t y, double diameter, const glm::vec3& colour);

    /// Per pixel of the rows the mean colour of the discs over it, and how much of it they cover together, at most 1.
    std::vector<glm::vec4> picture() const;

  private:
    const Discs* discs_;
    std::uint32_t width_, first_row_, rows_;
    std::vector<glm::dvec4> steps_; ///< by row: what is added to a sum that runs along it
};

} // namespace traces
