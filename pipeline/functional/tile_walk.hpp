// The body of for_each_quad (raster_triangle.hpp): tile row by tile row, within a tile quad row by quad row.
#pragma once

#include "pipeline/functional/raster_triangle.hpp"

namespace pipeline {
namespace detail {

/// Values of the three edge functions at one pixel, biases included: the pixel is covered when none is negative.
struct EdgeValues {
    std::int64_t e0, e1, e2;

    static EdgeValues at(const RasterTriangle& t, std::int32_t x, std::int32_t y) {
        const auto value = [&](std::size_t i) { return t.constant[i] + t.bias[i] + t.step_x[i] * x + t.step_y[i] * y; };
        return {value(0), value(1), value(2)};
    }
    bool covered() const { return (e0 | e1 | e2) >= 0; }
    EdgeValues plus(const EdgeValues& step) const { return {e0 + step.e0, e1 + step.e1, e2 + step.e2}; }
};

/// Which pixels of a quad lie within bounds that may begin and end in the middle of it.
inline unsigned pixels_of_quad(const PixelBounds& bounds, std::int32_t x, std::int32_t y) {
    unsigned mask = 15U;
    if (x < bounds.left) mask &= 10U;
    if (y < bounds.top) mask &= 12U;
    if (x + 1 >= bounds.right) mask &= 5U;
    if (y + 1 >= bounds.bottom) mask &= 3U;
    return mask;
}

/// First and last of some tiles; none where first > last.
struct TileSpan {
    std::int64_t first = 0, last = -1;
};

/// One triangle on its way over its tiles.
template <class Emit>
class TileWalk {
  public:
    TileWalk(const RasterTriangle& triangle, Emit& emit)
        : t_(triangle),
          emit_(emit),
          right_{t_.step_x[0], t_.step_x[1], t_.step_x[2]},
          down_{t_.step_y[0], t_.step_y[1], t_.step_y[2]},
          diagonal_(right_.plus(down_)) {}

    std::uint32_t run() {
        if (t_.first_x > t_.last_x || t_.first_y > t_.last_y) return 1; // between pixel centres
        const std::int32_t left = t_.first_x / tile_size, right = t_.last_x / tile_size;
        const std::int32_t top = t_.first_y / tile_size, bottom = t_.last_y / tile_size;
        if (left == right && top == bottom) {
            walk_partial(left, top);
            return 1;
        }
        std::uint32_t tiles = 0;
        for (std::int32_t row = top; row <= bottom; ++row) tiles += walk_row(left, right, row);
        return std::max(tiles, 1U);
    }

    /// Those tiles of a row, from `left` to `right`, that the coarse test does not reject, counted from `left`.
    TileSpan span(std::int32_t left, std::int32_t right, std::int32_t row) const {
        TileSpan tiles{0, right - left};
        for (std::size_t i = 0; i < 3 && tiles.first <= tiles.last; ++i)
            narrow_span(extreme(i, left, row, true), t_.step_x[i] * tile_size, tiles.first, tiles.last);
        return tiles;
    }

    void walk_tile(std::int32_t tile_x, std::int32_t tile_y) {
        const bool full = extreme(0, tile_x, tile_y, false) >= 0 && extreme(1, tile_x, tile_y, false) >= 0 &&
                          extreme(2, tile_x, tile_y, false) >= 0;
        if (full) {
            walk_full(tile_x, tile_y);
        } else {
            walk_partial(tile_x, tile_y);
        }
    }

  private:
    /// The largest (or smallest) value of edge i over the 8x8 pixels of a tile.
    std::int64_t extreme(std::size_t i, std::int32_t tile_x, std::int32_t tile_y, bool largest) const {
        constexpr std::int64_t reach = tile_size - 1;
        const auto part = [&](std::int64_t step) { return largest == (step > 0) ? reach * step : std::int64_t{0}; };
        return t_.constant[i] + t_.bias[i] + t_.step_x[i] * (std::int64_t{tile_x} * tile_size) +
               t_.step_y[i] * (std::int64_t{tile_y} * tile_size) + part(t_.step_x[i]) + part(t_.step_y[i]);
    }

    std::uint32_t walk_row(std::int32_t left, std::int32_t right, std::int32_t row) {
        const auto [first, last] = span(left, right, row);
        for (std::int64_t tile = first; tile <= last; ++tile) walk_tile(left + static_cast<std::int32_t>(tile), row);
        return first <= last ? static_cast<std::uint32_t>(last - first + 1) : 0;
    }

    void walk_full(std::int32_t tile_x, std::int32_t tile_y) {
        const std::int32_t begin_x = std::max(tile_x * tile_size, t_.drawn.left & ~1);
        const std::int32_t begin_y = std::max(tile_y * tile_size, t_.drawn.top & ~1);
        const std::int32_t end_x = std::min((tile_x + 1) * tile_size, t_.drawn.right);
        const std::int32_t end_y = std::min((tile_y + 1) * tile_size, t_.drawn.bottom);
        for (std::int32_t y = begin_y; y < end_y; y += 2)
            for (std::int32_t x = begin_x; x < end_x; x += 2) emit_quad(x, y, 15U);
    }

    void walk_partial(std::int32_t tile_x, std::int32_t tile_y) {
        const std::int32_t begin_x = std::max(tile_x * tile_size, t_.first_x & ~1);
        const std::int32_t begin_y = std::max(tile_y * tile_size, t_.first_y & ~1);
        const std::int32_t last_x = std::min((tile_x + 1) * tile_size - 1, t_.last_x);
        const std::int32_t last_y = std::min((tile_y + 1) * tile_size - 1, t_.last_y);
        EdgeValues row = EdgeValues::at(t_, begin_x, begin_y);
        const EdgeValues two_right = right_.plus(right_), two_down = down_.plus(down_);
        for (std::int32_t y = begin_y; y <= last_y; y += 2, row = row.plus(two_down)) {
            EdgeValues here = row;
            for (std::int32_t x = begin_x; x <= last_x; x += 2, here = here.plus(two_right)) {
                const unsigned mask = coverage(here);
                if (mask != 0) emit_quad(x, y, mask);
            }
        }
    }

    unsigned coverage(const EdgeValues& here) const {
        return (here.covered() ? 1U : 0U) | (here.plus(right_).covered() ? 2U : 0U) |
               (here.plus(down_).covered() ? 4U : 0U) | (here.plus(diagonal_).covered() ? 8U : 0U);
    }

    void emit_quad(std::int32_t x, std::int32_t y, unsigned mask) {
        mask &= pixels_of_quad(t_.drawn, x, y);
        if (mask != 0) emit_(x, y, mask);
    }

    const RasterTriangle& t_;
    Emit& emit_;
    const EdgeValues right_, down_, diagonal_;
};

} // namespace detail

template <class Emit>
std::uint32_t for_each_quad(const RasterTriangle& triangle, Emit&& emit) {
    return detail::TileWalk<Emit>(triangle, emit).run();
}

} // namespace pipeline
