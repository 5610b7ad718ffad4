#include "pipeline/functional/raster_triangle.hpp"

#include "sim/check.hpp"

#include <utility>

namespace pipeline {

namespace {

struct Point {
    std::int64_t x, y;
};

void set_up_edge(RasterTriangle& triangle, std::size_t edge, const Point& from, const Point& to) {
    const std::int64_t dx = to.x - from.x;
    const std::int64_t dy = to.y - from.y;
    // The edge runs clockwise on the screen: a left edge goes up (y falls), a top edge goes to the right.
    const bool owns_its_points = dy < 0 || (dy == 0 && dx > 0);
    triangle.step_x[edge] = -dy * subpixel_one;
    triangle.step_y[edge] = dx * subpixel_one;
    triangle.constant[edge] = dy * from.x - dx * from.y;
    triangle.bias[edge] = owns_its_points ? 0 : -1;
}

void bound(RasterTriangle& triangle, const std::array<Point, 3>& corners) {
    const auto [min_x, max_x] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
    const auto [min_y, max_y] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    const auto pixel_at_or_after = [](std::int64_t v) { return (v + subpixel_one - 1) >> subpixel_bits; };
    const auto pixel_at_or_before = [](std::int64_t v) { return v >> subpixel_bits; };
    const PixelBounds& drawn = triangle.drawn;
    const auto number = [](std::int64_t pixel) { return static_cast<std::int32_t>(pixel); };
    triangle.first_x = std::max(number(pixel_at_or_after(min_x)), drawn.left);
    triangle.first_y = std::max(number(pixel_at_or_after(min_y)), drawn.top);
    triangle.last_x = std::min(number(pixel_at_or_before(max_x)), drawn.right - 1);
    triangle.last_y = std::min(number(pixel_at_or_before(max_y)), drawn.bottom - 1);
}

} // namespace

std::int64_t signed_area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
    const std::int64_t abx = std::int64_t{b.x} - a.x, aby = std::int64_t{b.y} - a.y;
    const std::int64_t acx = std::int64_t{c.x} - a.x, acy = std::int64_t{c.y} - a.y;
    return abx * acy - acx * aby;
}

RasterTriangle set_up(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, const Viewport& viewport,
                      SampleOffset from_centre) {
    RasterTriangle triangle;
    triangle.drawn = viewport.drawn();
    triangle.area = signed_area(a, b, c);
    triangle.reversed = triangle.area < 0;
    CHECK(triangle.area != 0);
    std::array<Point, 3> corners{{{a.x, a.y}, {b.x, b.y}, {c.x, c.y}}};
    for (Point& corner : corners) corner = {corner.x - from_centre.x, corner.y - from_centre.y};
    if (triangle.reversed) {
        triangle.area = -triangle.area;
        std::swap(corners[1], corners[2]);
    }
    set_up_edge(triangle, 0, corners[1], corners[2]);
    set_up_edge(triangle, 1, corners[2], corners[0]);
    set_up_edge(triangle, 2, corners[0], corners[1]);
    bound(triangle, corners);
    return triangle;
}

} // namespace pipeline
