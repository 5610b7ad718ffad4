// What a triangle's attributes are at the four pixel centres of a quad.
//
// Weights are exact edge functions divided by the area in binary64: at covered pixels none is negative, so no attribute
// and no depth leaves the range of the triangle's corners, however thin the triangle is.
#pragma once

#include "pipeline/functional/cull_and_clip.hpp"
#include "pipeline/functional/raster_triangle.hpp"

#include <array>
#include <cstdint>

namespace pipeline {

/// One number for each pixel of a quad.
using Lanes = std::array<float, 4>;

/// Weights of the three corners at each pixel.
struct QuadWeights {
    std::array<std::array<double, 4>, 3> screen; ///< linear on the screen: for depth
    std::array<Lanes, 3> perspective;            ///< perspective-correct: for attributes
};

class TriangleInterpolator {
  public:
    TriangleInterpolator(const RasterTriangle& raster, const std::array<ScreenVertex, 3>& corners);

    /// Screen weights at the quad whose top left pixel is (x, y). Sets weights.screen.
    void screen_weights(std::int32_t x, std::int32_t y, QuadWeights& weights) const;

    /// Window depth in [0,1], within the range of the corners' depths also where a pixel is not covered.
    Lanes depth(const QuadWeights& weights) const;

    /// Sets weights.perspective from weights.screen. A pixel that is not covered is extrapolated, for derivatives;
    /// where that crosses the eye plane or comes near it, the pixel takes the weights of the first covered one.
    void perspective_weights(unsigned covered, QuadWeights& weights) const;

    /// The attribute with these values at the corners of the primitive part.
    static Lanes interpolate(const QuadWeights& weights, float at0, float at1, float at2) {
        Lanes result;
        for (std::size_t lane = 0; lane < 4; ++lane)
            result[lane] = weights.perspective[0][lane] * at0 + weights.perspective[1][lane] * at1 +
                           weights.perspective[2][lane] * at2;
        return result;
    }

  private:
    std::array<double, 3> constant_, step_x_, step_y_; ///< edge functions, for the corners as they were given
    std::array<double, 3> depth_;
    std::array<double, 3> inverse_w_; ///< relative to the largest of the three
    double inverse_area_ = 0;
    float least_depth_ = 0, greatest_depth_ = 0;
    bool affine_ = false; ///< all w are equal
};

} // namespace pipeline
