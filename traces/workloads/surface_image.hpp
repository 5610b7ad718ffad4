// The one surface that every pixel sees, known by its distance only, and its shading from differences of distances.
#pragma once

#include "traces/view_rays.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace traces {

class SurfaceShape {
  public:
    static constexpr double none = std::numeric_limits<double>::infinity();

    SurfaceShape(std::shared_ptr<const ViewRays> rays, std::uint32_t width, std::uint32_t height)
        : rays_(std::move(rays)), width_(width), height_(height) {}
    virtual ~SurfaceShape() = default;

    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }

    /// Distance along the view axis; `none` where there is no surface. Asked for a pixel that is shaded and for its
    /// four neighbours.
    virtual double distance(std::uint32_t x, std::uint32_t y) const = 0;
    bool sees(std::uint32_t x, std::uint32_t y) const { return distance(x, y) != none; }

    /// Unit normal in eye space from central differences of the places that neighbouring pixels see. Where a neighbour
    /// sees nothing, or the surface is broken between it and the pixel, from one-sided ones.
    glm::dvec3 normal(std::uint32_t x, std::uint32_t y) const;

    /// Light of a lamp at the eye, as the fragment shader has it: ambient + (1 - ambient) * |n.z|.
    double lambert(std::uint32_t x, std::uint32_t y) const;

    /// A neighbour sees nothing, or something much farther than the slope of a surface explains.
    bool is_silhouette(std::uint32_t x, std::uint32_t y) const;

  private:
    struct Neighbour {
        bool seen = false;
        glm::dvec3 place{0.0};
    };
    Neighbour neighbour(std::uint32_t x, std::uint32_t y, int dx, int dy) const;
    glm::dvec3 step(std::uint32_t x, std::uint32_t y, int dx, int dy) const;

    std::shared_ptr<const ViewRays> rays_;
    std::uint32_t width_, height_;
};

/// All distances at once.
class SurfaceImage final : public SurfaceShape {
  public:
    /// No pixel sees a surface.
    explicit SurfaceImage(const pipeline::View& view)
        : SurfaceShape(std::make_shared<const ViewRays>(view), view.width, view.height),
          distances_(view.pixels(), none) {}

    double distance(std::uint32_t x, std::uint32_t y) const override {
        return distances_[std::size_t{y} * width() + x];
    }
    void set_distance(std::size_t pixel, double distance) { distances_[pixel] = distance; }

  private:
    std::vector<double> distances_;
};

} // namespace traces
