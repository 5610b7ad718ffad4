#include "traces/workloads/surface_image.hpp"

#include "pipeline/functional/shader.hpp" // ambient_light

#include <algorithm>
#include <array>
#include <cmath>

namespace traces {

namespace {

// Steps along the surface from one pixel to the next that differ by more than this, in parts of the steeper one and of
// the width of a pixel, are those of two surfaces, or of two sides of an edge.
constexpr double most_bend = 0.5;

// Farther by more pixel widths than this is another surface, or one that is seen edge-on.
constexpr double silhouette_slope = 10.0;

double width_of(const glm::dvec3& step) { return std::max(std::fabs(step.x), std::fabs(step.y)); }

bool is_smooth(const glm::dvec3& back, const glm::dvec3& ahead) {
    const double steeper = std::max(std::fabs(back.z), std::fabs(ahead.z));
    return std::fabs(ahead.z - back.z) <= most_bend * (steeper + width_of(back));
}

} // namespace

SurfaceShape::Neighbour SurfaceShape::neighbour(std::uint32_t x, std::uint32_t y, int dx, int dy) const {
    const std::int64_t column = std::int64_t{x} + dx, row = std::int64_t{y} + dy;
    if (column < 0 || column >= width_ || row < 0 || row >= height_) return {};
    const auto u = static_cast<std::uint32_t>(column), v = static_cast<std::uint32_t>(row);
    if (!sees(u, v)) return {};
    return {true, rays_->place(u, v, distance(u, v))};
}

// Along the surface in the direction (dx, dy) of the picture, of any length.
glm::dvec3 SurfaceShape::step(std::uint32_t x, std::uint32_t y, int dx, int dy) const {
    const glm::dvec3 here = rays_->place(x, y, distance(x, y));
    const Neighbour before = neighbour(x, y, -dx, -dy), behind = neighbour(x, y, dx, dy);
    const glm::dvec3 back = here - before.place, ahead = behind.place - here;
    if (before.seen && behind.seen) {
        if (is_smooth(back, ahead)) return back + ahead;
        return std::fabs(back.z) < std::fabs(ahead.z) ? back : ahead;
    }
    if (before.seen) return back;
    if (behind.seen) return ahead;
    return {dx, -dy, 0.0}; // one pixel of a surface: it faces the eye
}

glm::dvec3 SurfaceShape::normal(std::uint32_t x, std::uint32_t y) const {
    const glm::dvec3 normal = glm::cross(step(x, y, 1, 0), step(x, y, 0, -1));
    const double length = glm::length(normal);
    return length > 0.0 && std::isfinite(length) ? normal / length : glm::dvec3(0.0, 0.0, 1.0);
}

double SurfaceShape::lambert(std::uint32_t x, std::uint32_t y) const {
    constexpr double ambient = pipeline::ambient_light;
    return ambient + (1.0 - ambient) * std::fabs(normal(x, y).z);
}

bool SurfaceShape::is_silhouette(std::uint32_t x, std::uint32_t y) const {
    constexpr std::array<std::array<int, 2>, 4> around{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    const glm::dvec3 here = rays_->place(x, y, distance(x, y));
    return std::any_of(around.begin(), around.end(), [&](const auto& by) {
        const std::int64_t column = std::int64_t{x} + by[0], row = std::int64_t{y} + by[1];
        if (column < 0 || column >= width_ || row < 0 || row >= height_)
            return false; // the picture ends, not the surface
        const Neighbour other = neighbour(x, y, by[0], by[1]);
        return !other.seen || here.z - other.place.z > silhouette_slope * width_of(other.place - here);
    });
}

} // namespace traces
