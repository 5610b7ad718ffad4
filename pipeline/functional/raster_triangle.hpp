// Triangle setup and the walk over its tiles, in fixed point: which pixel centres does a triangle cover?
//
// Positions are integers (1/256 pixel), edge functions are 64-bit integers, and an edge's own points belong to the
// triangle only where the edge is a left or a top one. So triangles that share an edge cover each pixel centre on it
// exactly once. Source of the rule: Direct3D 11.3 functional specification, section 3.4.2.1; Pineda 1988 for the edge
// functions.
#pragma once

#include "pipeline/functional/sample_pattern.hpp"
#include "pipeline/functional/vertex_transform.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace pipeline {

inline constexpr std::int32_t tile_size = 8; ///< pixels along a side of a raster tile

/// A triangle ready for rasterization, oriented so that its inside has positive edge functions.
struct RasterTriangle {
    /// Edge function i, opposite to corner i, at the centre of pixel (px, py) is
    /// constant[i] + step_x[i] * px + step_y[i] * py; their sum is `area` everywhere.
    std::array<std::int64_t, 3> constant;
    std::array<std::int64_t, 3> step_x;
    std::array<std::int64_t, 3> step_y;
    std::array<std::int64_t, 3> bias; ///< -1 where points on the edge are outside
    std::int64_t area = 0;            ///< twice the area in sub-pixel units squared; > 0
    /// Pixels whose centres lie in the bounding box and that may be drawn, both ends included.
    std::int32_t first_x = 0, last_x = -1, first_y = 0, last_y = -1;
    PixelBounds drawn;     ///< the pixels that may be drawn
    bool reversed = false; ///< corners 1 and 2 were exchanged to make the area positive
};

// Why 64 bits are enough, and binary64 holds every edge value exactly: coordinates stay within the guard band around
// the middle of the farthest viewport; a difference takes one bit more, an edge function sums two products of
// differences, and the walk leaves the bounding box by less than a tile, samples included.
inline constexpr std::int64_t largest_coordinate =
    (static_cast<std::int64_t>(guard_band_pixels * 1.001F) + farthest_viewport + largest_viewport / 2 + 1) *
    subpixel_one;
inline constexpr std::int64_t largest_difference = 2 * largest_coordinate + std::int64_t{2} * tile_size * subpixel_one;
inline constexpr std::int64_t largest_edge_function = 2 * largest_difference * largest_difference;
static_assert(largest_coordinate < (std::int64_t{1} << 24));
static_assert(largest_edge_function < (std::int64_t{1} << 53));

/// Twice the signed area of a triangle, in sub-pixel units squared; positive when its corners run clockwise on the
/// screen.
std::int64_t signed_area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c);

/// Sets a triangle of non-zero area up. Its pixel centres lie at `from_centre` (less than a pixel away), so that a
/// pixel's sample is rasterized like a centre.
RasterTriangle set_up(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, const Viewport& viewport,
                      SampleOffset from_centre = {});

namespace detail {

/// First and last of `count` tiles in a row that `edge` does not reject, given the largest value of the edge function
/// over the first tile and its step from tile to tile. Narrows [first, last].
inline void narrow_span(std::int64_t value, std::int64_t step, std::int64_t& first, std::int64_t& last) {
    if (value + first * step >= 0 && value + last * step >= 0) return;
    if (step > 0) {
        first = std::max(first, (-value + step - 1) / step);
    } else if (step < 0 && value >= 0) {
        last = std::min(last, value / -step);
    } else {
        last = first - 1;
    }
}

} // namespace detail

/// Visits the 2x2 quads that `triangle` covers, in the order that fragment_stream.hpp defines, as
/// emit(x, y, coverage mask), and returns the number of 8x8 tiles that the coarse test does not reject, at least 1.
template <class Emit>
std::uint32_t for_each_quad(const RasterTriangle& triangle, Emit&& emit);

} // namespace pipeline

#include "pipeline/functional/tile_walk.hpp"
