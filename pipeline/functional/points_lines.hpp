// Which pixels points and lines cover, and what depth and attributes are over a line.
//
// Pixels of several samples are covered as a whole, by the rules for one sample.
// Sources: OpenGL 4.5 core, sections 14.4 (a point is a square around its vertex) and 14.5 (a line leaves the diamonds
// of its pixels; a wide one repeats them across its larger extent). Ties are those of triangles (top-left rule): where
// the specification moves the ends of a line, y counts downwards here.
#pragma once

#include "pipeline/functional/interpolation.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace pipeline {

/// The square of a point as a rectangle whose left and top borders belong to it, in sub-pixel units as ScreenVertex::x.
struct PointSquare {
    std::int32_t left = 0, top = 0, side = 0;

    PointSquare(const ScreenVertex& centre, float size);

    /// Top left, top right and bottom left corner, with everything else from the centre: weights 1 and 2 of
    /// AttributePlanes run from 0 to 1 over the square, to the right and down.
    std::array<ScreenVertex, 3> corners(const ScreenVertex& centre) const;
    /// The pixels whose centres lie in a square of which these are the corners.
    static PixelBounds pixels(const std::array<ScreenVertex, 3>& corners);
};

/// A line on the sub-pixel grid. `Major` is the axis along which it extends farther, x where both are equal.
class RasterLine {
  public:
    RasterLine(const ScreenVertex& from, const ScreenVertex& to, float width);

    /// First and last pixel along the major axis; none where first > last.
    std::int32_t first() const { return first_; }
    std::int32_t last() const { return last_; }
    bool along_x() const { return along_x_; }
    std::int32_t width() const { return width_; }
    /// The first of width() pixels across it at a pixel along it, which may lie beyond the ends.
    std::int32_t across(std::int32_t major) const;

  private:
    /// Major and minor coordinate, the latter moved for wide lines; sub-pixel units.
    struct End {
        std::int64_t major = 0, minor = 0;
    };
    bool in_diamond(const End& end, std::int32_t major) const;

    End from_, to_;
    bool along_x_;
    std::int32_t width_;
    std::int32_t first_ = 0, last_ = -1;
};

/// A quad with its covered pixels.
struct CoveredQuad {
    std::int32_t x = 0, y = 0;
    unsigned mask = 0;
};

/// In the order that fragment_stream.hpp defines; `tiles` is the number of 8x8 tiles that have one, at least 1.
struct CoveredQuads {
    std::vector<CoveredQuad> quads;
    std::uint32_t tiles = 1;
};

CoveredQuads quads_of_rectangle(const PixelBounds& rectangle, const PixelBounds& drawn);
CoveredQuads quads_of_line(const RasterLine& line, const PixelBounds& drawn);

/// Depth and attributes over a line: by the place of the pixel's centre between its ends, which never leaves them. All
/// pixels across a wide line have those of the first.
class LinePlane {
  public:
    /// Depths are kept between what the state says.
    LinePlane(const RasterLine& line, const ScreenVertex& from, const ScreenVertex& to, const DepthState& state);

    Lanes depths(std::int32_t x, std::int32_t y) const;
    CornerWeights weights(std::int32_t x, std::int32_t y) const;

  private:
    /// 0 at the first end, 1 at the second, at the pixels of a quad.
    std::array<double, 4> places(std::int32_t x, std::int32_t y) const;

    RasterLine line_;
    double major_, minor_;           ///< of the first end, in pixels
    double step_major_, step_minor_; ///< of the place, per pixel
    double depth_, depth_step_;
    double lowest_, highest_; ///< depths
    double w_from_, w_to_;
};

} // namespace pipeline
