#include "pipeline/functional/clip.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cmath>

namespace pipeline {

namespace {

/// A plane of the clip volume: inside where sign * coordinate <= reach * w.
struct VolumePlane {
    std::uint32_t bit;
    int axis;
    double sign;
    double reach;

    double distance(const ClippedCorner& corner) const { return reach * corner.clip.w - sign * corner.clip[axis]; }

    /// Rounding must not leave the new corner off the plane.
    void settle(glm::dvec4& clip) const { clip[axis] = sign * reach * clip.w; }
};

/// A plane that is known by the distances of the triangle's vertices. Two of three weights make an edge's sum, so it is
/// the same for both triangles at the edge.
struct UserPlane {
    glm::dvec3 distances;

    double distance(const ClippedCorner& corner) const {
        return distances.x * corner.weights.x + distances.y * corner.weights.y + distances.z * corner.weights.z;
    }
    void settle(glm::dvec4&) const {}
};

template <class Plane>
ClippedCorner cut(const Plane& plane, const ClippedCorner& inner, double inner_distance, const ClippedCorner& outer,
                  double outer_distance) {
    const double t = inner_distance / (inner_distance - outer_distance);
    ClippedCorner result;
    result.clip = inner.clip + t * (outer.clip - inner.clip);
    result.weights = inner.weights + t * (outer.weights - inner.weights);
    plane.settle(result.clip);
    return result;
}

template <class Plane>
ClippedPolygon clip_polygon(const Plane& plane, const ClippedPolygon& polygon) {
    ClippedPolygon result;
    const auto add = [&](const ClippedCorner& corner) {
        CHECK(result.count < result.corners.size());
        result.corners[result.count++] = corner;
    };
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        const ClippedCorner& here = polygon.corners[i];
        const ClippedCorner& next = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
        const double here_distance = plane.distance(here);
        const double next_distance = plane.distance(next);
        const bool here_inside = here_distance >= 0.0;
        const bool next_inside = next_distance >= 0.0;
        if (here_inside) add(here);
        if (here_inside && !next_inside) add(cut(plane, here, here_distance, next, next_distance));
        if (!here_inside && next_inside) add(cut(plane, next, next_distance, here, here_distance));
    }
    if (result.count < 3) result.count = 0;
    return result;
}

template <class Plane>
ClippedPolygon clip_ends(const Plane& plane, ClippedPolygon line) {
    const double first = plane.distance(line.corners[0]), second = plane.distance(line.corners[1]);
    if (first < 0.0 && second < 0.0) {
        line.count = 0;
    } else if (first < 0.0) {
        line.corners[0] = cut(plane, line.corners[1], second, line.corners[0], first);
    } else if (second < 0.0) {
        line.corners[1] = cut(plane, line.corners[0], first, line.corners[1], second);
    }
    return line;
}

/// `clip` by every plane that some of the first `count` corners is outside of.
template <class Clip>
ClippedPolygon clip_by_all(const Viewport& viewport, const PrimitiveCorners& whole, std::uint32_t count,
                           const Clip& clip) {
    ClippedPolygon polygon;
    polygon.count = count;
    std::uint32_t crossed = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        polygon.corners[i].clip = glm::dvec4(whole.vertices[i]->clip);
        polygon.corners[i].weights = glm::dvec3(0.0);
        polygon.corners[i].weights[static_cast<glm::length_t>(i)] = 1.0;
        crossed |= whole.vertices[i]->outside;
    }
    const auto guard_x = static_cast<double>(viewport.guard_x());
    const auto guard_y = static_cast<double>(viewport.guard_y());
    const std::array<VolumePlane, 6> planes{{{outside::near, 2, -1.0, 1.0},
                                             {outside::far, 2, 1.0, 1.0},
                                             {outside::guard_left, 0, -1.0, guard_x},
                                             {outside::guard_right, 0, 1.0, guard_x},
                                             {outside::guard_bottom, 1, -1.0, guard_y},
                                             {outside::guard_top, 1, 1.0, guard_y}}};
    for (const VolumePlane& plane : planes)
        if ((crossed & plane.bit) != 0 && polygon.count != 0) polygon = clip(plane, polygon);
    for (std::uint32_t i = 0; i < most_clip_distances; ++i) {
        if ((crossed & outside::user_plane(i)) == 0 || polygon.count == 0) continue;
        UserPlane plane{glm::dvec3(0.0)};
        for (std::uint32_t corner = 0; corner < count; ++corner)
            plane.distances[static_cast<glm::length_t>(corner)] = static_cast<double>((*whole.distances[corner])[i]);
        polygon = clip(plane, polygon);
    }
    return polygon;
}

} // namespace

UserPlanes::UserPlanes(const RasterState& state, const glm::dmat4& model_to_eye) : cutting_(state.clip_planes) {
    for (std::size_t i = 0; i < most_clip_distances; ++i)
        planes_[i] = glm::transpose(model_to_eye) * glm::dvec4(state.clip_plane[i]);
}

ClipDistances UserPlanes::measure(const glm::vec4& position, ScreenVertex& vertex) const {
    ClipDistances distances{};
    const glm::dvec4 place(glm::dvec3(position), 1.0);
    for (std::uint32_t i = 0; i < most_clip_distances; ++i) {
        if ((cutting_ >> i & 1U) == 0) continue;
        distances[i] = static_cast<float>(glm::dot(planes_[i], place));
        if (!std::isfinite(distances[i])) vertex.outside = outside::not_finite;
        if (distances[i] < 0.0F) vertex.outside |= outside::user_plane(i);
    }
    return distances;
}

ClippedPolygon clip_triangle(const Viewport& viewport, const PrimitiveCorners& triangle) {
    return clip_by_all(viewport, triangle, 3,
                       [](const auto& plane, const ClippedPolygon& polygon) { return clip_polygon(plane, polygon); });
}

ClippedPolygon clip_line(const Viewport& viewport, const PrimitiveCorners& line) {
    return clip_by_all(viewport, line, 2,
                       [](const auto& plane, const ClippedPolygon& ends) { return clip_ends(plane, ends); });
}

ScreenVertex screen_vertex(const Viewport& viewport, const ClippedCorner& corner) {
    ScreenVertex vertex;
    vertex.clip = glm::vec4(corner.clip);
    vertex.clip.w = std::max(vertex.clip.w, smallest_w);
    // A little farther than the guard band, so that corners that were not cut stay what they are.
    const float w = vertex.clip.w;
    const float reach_x = viewport.guard_x() * w * 1.0001F;
    const float reach_y = viewport.guard_y() * w * 1.0001F;
    vertex.clip.x = std::clamp(vertex.clip.x, -reach_x, reach_x);
    vertex.clip.y = std::clamp(vertex.clip.y, -reach_y, reach_y);
    if (!viewport.clamps_depth()) vertex.clip.z = std::clamp(vertex.clip.z, -w, w);
    viewport.project(vertex);
    return vertex;
}

} // namespace pipeline
