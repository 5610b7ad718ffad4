// What a triangle's depth and attributes are at the four pixel centres of a quad.
//
// Pixels of several samples have a depth at each sample and one set of attributes, at a place that the caller chooses.
// Attributes: the corners' weights are exact edge functions divided by the area in binary64. At covered pixels none is
// negative, so no attribute leaves the range of the corners (but for rounding), however thin the triangle is.
// Depth: the plane through the corners as they were before they were snapped to the sub-pixel grid (Mesa does the
// same), so that surfaces in one plane have one depth whatever their triangles; clamped to the range of the corners'
// depths.
#pragma once

#include "pipeline/functional/cull_and_clip.hpp"
#include "pipeline/functional/lanes.hpp"
#include "pipeline/functional/raster_triangle.hpp"

#include <array>
#include <cstdint>

namespace pipeline {

/// Window depth over a triangle, with the bias of a state.
class DepthPlane {
  public:
    DepthPlane(const RasterTriangle& raster, const std::array<ScreenVertex, 3>& corners);

    /// Adds the bias of a state (OpenGL 4.5, section 14.6.5). `step` is the smallest one of the depth format; 0: that
    /// of a 32-bit float at the greatest depth of the corners.
    void add_bias(const DepthState& state, double step);
    /// Keeps depths between what the state says instead of between 0 and 1.
    void bound(const DepthState& state) {
        lowest_ = static_cast<double>(state.least());
        highest_ = static_cast<double>(state.greatest());
    }

    /// Depth in [0,1] at the quad whose top left pixel is (x, y), also where pixels are not covered; at the samples
    /// that lie there from the centres.
    Lanes at(std::int32_t x, std::int32_t y, SampleOffset from_centre = {}) const;

  private:
    double x_, y_, depth_; ///< of corner 0, pixels from the centre of pixel (0, 0)
    double step_x_ = 0, step_y_ = 0;
    float least_, greatest_;
    double bias_ = 0;
    double lowest_ = 0, highest_ = 1;
};

/// Shares of corners 1 and 2 in the attributes at each pixel; the rest is corner 0's.
struct CornerWeights {
    Lanes of1, of2;

    /// The attribute that has these values at the corners; exactly that value where all three are equal.
    Lanes interpolate(float at0, float at1, float at2) const {
        const float to1 = at1 - at0, to2 = at2 - at0;
        const Lanes share1 = of1, share2 = of2; // copies: the compiler need not fear that the result overlaps them
        Lanes result;
        for (std::size_t i = 0; i < 4; ++i) result[i] = at0 + (share1[i] * to1 + share2[i] * to2);
        return result;
    }
};

/// Perspective-correct interpolation over a triangle.
class AttributePlanes {
  public:
    AttributePlanes(const RasterTriangle& raster, const std::array<ScreenVertex, 3>& corners);

    /// Weights at the quad whose top left pixel is (x, y). Pixels that are not covered are extrapolated, for
    /// derivatives; one beyond the eye plane, or near it, takes the weights of the first covered pixel. `covered` is
    /// not 0.
    CornerWeights at(std::int32_t x, std::int32_t y, unsigned covered) const;

    /// The same at one place of each pixel. What lies inside the triangle gets no negative weight there.
    CornerWeights at(std::int32_t x, std::int32_t y, unsigned covered,
                     const std::array<SampleOffset, 4>& from_centres) const;

  private:
    std::array<double, 3> constant_, step_x_, step_y_; ///< edge functions, for the corners in their given order
    std::array<double, 3> scale_;                      ///< 1/area times the corner's 1/w relative to the largest 1/w
};

} // namespace pipeline
