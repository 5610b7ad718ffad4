// The rays through the centres of a view's pixels, and what they hit.
#pragma once

#include "pipeline/draw.hpp"
#include "reports/truth/ray_scene.hpp"
#include "traces/view_rays.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace reports {

/// How to do work on many pixels or points. The result does not depend on it.
struct TracingOptions {
    unsigned threads = 0;                      ///< 0 = all cores
    const std::atomic<bool>* stop = nullptr;   ///< becomes true: sim::Interrupted is thrown soon
    std::function<void(double)> progress = {}; ///< called with the share done, 0 to 1, never by two threads at once
};

/// Calls piece(i) for every i below `count`, in no order; throws what a piece throws.
void trace_pieces(const TracingOptions& options, std::size_t count, const std::function<void(std::size_t)>& piece);

class PixelRays {
  public:
    explicit PixelRays(const pipeline::View& view);

    /// In world space, from the near to the far plane.
    WorldRay operator()(std::uint32_t x, std::uint32_t y) const;
    /// Distance along the view axis at t of a ray. A parallel projection may look the other way: then they decrease.
    double distance(double t) const { return sense_ * t; }
    double sense() const { return sense_; } ///< 1 or -1
    const traces::ViewRays& in_eye_space() const { return rays_; }
    bool perspective() const { return perspective_; }

  private:
    traces::ViewRays rays_;
    glm::dmat4 to_world_;
    double near_, far_; ///< distances
    double sense_;
    bool perspective_;
};

/// What the rays of one row of pixels hit. Kept from row to row, so that memory is not asked for again.
class RowHits {
  public:
    void trace(const RayScene& scene, const PixelRays& rays, std::uint32_t width, std::uint32_t y);
    /// Of pixel x, nearest first.
    std::span<const RayHit> of(std::uint32_t x) const {
        return std::span(hits_).subspan(first_[x], first_[x + 1] - first_[x]);
    }

  private:
    std::vector<RayHit> hits_, pixel_;
    std::vector<std::size_t> first_;
};

/// The nearest surface of a pixel, in world space.
struct FirstHit {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0}; ///< of the triangle, of unit length, towards the eye; 0 where the pixel sees nothing
    std::uint32_t draw = 0;
    std::uint32_t triangle = 0;

    bool seen() const { return normal != glm::dvec3(0.0); }
};

/// Of every pixel, row 0 first; alpha tests are honoured (textures in their finest level), facing does not count.
std::vector<FirstHit> first_hits(const RayScene& scene, const pipeline::View& view, const TracingOptions& options = {});

} // namespace reports
