#include "pipeline/functional/points_lines.hpp"

#include "pipeline/functional/number_formats.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace pipeline {

namespace {

constexpr std::int32_t half_pixel = subpixel_one / 2;

std::int32_t pixel_at_or_after(std::int32_t subpixels) { return (subpixels + subpixel_one - 1) >> subpixel_bits; }

/// The quotient rounded down, of a positive divisor.
std::int64_t divide_down(std::int64_t number, std::int64_t divisor) {
    const std::int64_t quotient = number / divisor;
    return quotient * divisor > number ? quotient - 1 : quotient;
}

/// Sorts quads as fragment_stream.hpp defines, and puts those at one place together.
CoveredQuads in_order(std::vector<CoveredQuad> quads) {
    const auto tile = [](const CoveredQuad& quad) { return std::pair(quad.y / tile_size, quad.x / tile_size); };
    std::sort(quads.begin(), quads.end(), [&](const CoveredQuad& a, const CoveredQuad& b) {
        return std::tuple(tile(a), a.y, a.x) < std::tuple(tile(b), b.y, b.x);
    });
    CoveredQuads result;
    for (const CoveredQuad& quad : quads) {
        if (!result.quads.empty()) {
            CoveredQuad& before = result.quads.back();
            if (before.x == quad.x && before.y == quad.y) {
                before.mask |= quad.mask;
                continue;
            }
            if (tile(before) != tile(quad)) ++result.tiles;
        }
        result.quads.push_back(quad);
    }
    return result;
}

CoveredQuad quad_of_pixel(std::int32_t x, std::int32_t y) {
    return {x & ~1, y & ~1, 1U << static_cast<unsigned>((x & 1) + 2 * (y & 1))};
}

} // namespace

PointSquare::PointSquare(const ScreenVertex& centre, float size) {
    const float pixels = size > 1.0F ? std::min(size, largest_point) : 1.0F; // a program may give NaN
    side = static_cast<std::int32_t>(round_even(static_cast<double>(pixels * subpixel_one)));
    left = centre.x - side / 2;
    top = centre.y - side / 2;
}

std::array<ScreenVertex, 3> PointSquare::corners(const ScreenVertex& centre) const {
    std::array<ScreenVertex, 3> result{centre, centre, centre};
    result[0].x = result[2].x = left;
    result[0].y = result[1].y = top;
    result[1].x = left + side;
    result[2].y = top + side;
    for (ScreenVertex& corner : result) corner.window = glm::vec2(corner.x, corner.y) / float{subpixel_one};
    return result;
}

PixelBounds PointSquare::pixels(const std::array<ScreenVertex, 3>& corners) {
    return {pixel_at_or_after(corners[0].x), pixel_at_or_after(corners[0].y), pixel_at_or_after(corners[1].x),
            pixel_at_or_after(corners[2].y)};
}

RasterLine::RasterLine(const ScreenVertex& from, const ScreenVertex& to, float width)
    : along_x_(std::abs(to.x - from.x) >= std::abs(to.y - from.y)),
      width_(static_cast<std::int32_t>(std::clamp(std::floor(width + 0.5F), 1.0F, largest_point))) {
    const auto end_of = [&](const ScreenVertex& vertex) {
        const End end = along_x_ ? End{vertex.x, vertex.y} : End{vertex.y, vertex.x};
        return End{end.major, end.minor - std::int64_t{half_pixel} * (width_ - 1)};
    };
    from_ = end_of(from);
    to_ = end_of(to);
    if (from_.major == to_.major) return; // leaves no diamond
    // An end lies a little before its place (OpenGL 4.5, section 14.5.1), so that its own pixel counts as behind it.
    const auto at_or_after = [](const End& end) { return pixel_at_or_after(static_cast<std::int32_t>(end.major)); };
    if (from_.major < to_.major) {
        first_ = at_or_after(from_);
        last_ = at_or_after(to_) - 1;
        if (in_diamond(from_, first_ - 1)) --first_;
        if (in_diamond(to_, last_)) --last_;
    } else {
        first_ = at_or_after(to_);
        last_ = at_or_after(from_) - 1;
        if (in_diamond(from_, last_ + 1)) ++last_;
        if (in_diamond(to_, first_)) ++first_;
    }
}

// The ends are moved by -(e, e^2) in x and y, e as small as one likes; that decides what lies on a border.
std::int32_t RasterLine::across(std::int32_t major) const {
    std::int64_t run = to_.major - from_.major, rise = to_.minor - from_.minor;
    if (run < 0) run = -run, rise = -rise;
    const std::int64_t scaled =
        from_.minor * run + (std::int64_t{major} * subpixel_one - from_.major) * rise; // minor coordinate there * run
    const std::int64_t pixel = subpixel_one * run;
    const bool up_at_ties = along_x_ && rise > 0;
    if (up_at_ties) return static_cast<std::int32_t>(divide_down(scaled + half_pixel * run, pixel));
    return static_cast<std::int32_t>(-divide_down(half_pixel * run - scaled, pixel));
}

bool RasterLine::in_diamond(const End& end, std::int32_t major) const {
    const std::int64_t along = end.major - std::int64_t{major} * subpixel_one;
    const std::int64_t beside = end.minor - std::int64_t{across(major)} * subpixel_one;
    const std::int64_t distance = std::abs(along) + std::abs(beside);
    if (distance != half_pixel) return distance < half_pixel;
    return (along_x_ ? along : beside) > 0;
}

CoveredQuads quads_of_rectangle(const PixelBounds& rectangle, const PixelBounds& drawn) {
    const PixelBounds pixels{std::max(rectangle.left, drawn.left), std::max(rectangle.top, drawn.top),
                             std::min(rectangle.right, drawn.right), std::min(rectangle.bottom, drawn.bottom)};
    std::vector<CoveredQuad> quads;
    if (!pixels.empty())
        for (std::int32_t y = pixels.top & ~1; y < pixels.bottom; y += 2)
            for (std::int32_t x = pixels.left & ~1; x < pixels.right; x += 2)
                quads.push_back({x, y, detail::pixels_of_quad(pixels, x, y)});
    return in_order(std::move(quads));
}

CoveredQuads quads_of_line(const RasterLine& line, const PixelBounds& drawn) {
    const bool x = line.along_x();
    const std::int32_t first = std::max(line.first(), x ? drawn.left : drawn.top);
    const std::int32_t end = std::min(line.last() + 1, x ? drawn.right : drawn.bottom);
    const std::int32_t least = x ? drawn.top : drawn.left, most = x ? drawn.bottom : drawn.right;
    std::vector<CoveredQuad> quads;
    for (std::int32_t major = first; major < end; ++major) {
        const std::int32_t across = line.across(major);
        for (std::int32_t minor = std::max(across, least); minor < std::min(across + line.width(), most); ++minor)
            quads.push_back(x ? quad_of_pixel(major, minor) : quad_of_pixel(minor, major));
    }
    return in_order(std::move(quads));
}

LinePlane::LinePlane(const RasterLine& line, const ScreenVertex& from, const ScreenVertex& to, const DepthState& state)
    : line_(line),
      depth_(static_cast<double>(from.depth)),
      depth_step_(static_cast<double>(to.depth) - depth_),
      lowest_(static_cast<double>(state.least())),
      highest_(static_cast<double>(state.greatest())),
      w_from_(static_cast<double>(std::max(from.clip.w, smallest_w))),
      w_to_(static_cast<double>(std::max(to.clip.w, smallest_w))) {
    const glm::dvec2 a(from.window), along = glm::dvec2(to.window) - a;
    const double length = glm::dot(along, along);
    const glm::dvec2 step = length > 0.0 ? along / length : glm::dvec2(0.0);
    const double moved = 0.5 * (line.width() - 1);
    major_ = line.along_x() ? a.x : a.y;
    minor_ = (line.along_x() ? a.y : a.x) - moved;
    step_major_ = line.along_x() ? step.x : step.y;
    step_minor_ = line.along_x() ? step.y : step.x;
}

std::array<double, 4> LinePlane::places(std::int32_t x, std::int32_t y) const {
    std::array<double, 4> result{};
    for (std::int32_t pixel = 0; pixel < 4; ++pixel) {
        const std::int32_t major = line_.along_x() ? x + pixel % 2 : y + pixel / 2;
        const double place = (major - major_) * step_major_ + (line_.across(major) - minor_) * step_minor_;
        result[static_cast<std::size_t>(pixel)] = std::clamp(place, 0.0, 1.0);
    }
    return result;
}

Lanes LinePlane::depths(std::int32_t x, std::int32_t y) const {
    const std::array<double, 4> place = places(x, y);
    Lanes result;
    for (std::size_t lane = 0; lane < 4; ++lane)
        result[lane] = static_cast<float>(std::clamp(depth_ + depth_step_ * place[lane], lowest_, highest_));
    return result;
}

CornerWeights LinePlane::weights(std::int32_t x, std::int32_t y) const {
    const std::array<double, 4> place = places(x, y);
    CornerWeights weights{};
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const double to = place[lane] * w_from_, from = (1.0 - place[lane]) * w_to_;
        weights.of1[lane] = static_cast<float>(to / (from + to));
    }
    return weights;
}

} // namespace pipeline
