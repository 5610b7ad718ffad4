// Where a ray meets the plane of a triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>

namespace reports {

struct PlaneHit {
    double t = 0.0;
    double u = 0.0, v = 0.0; ///< shares of corners 1 and 2; outside the triangle also negative or more than 1
};

/// Nothing where the ray is parallel to the plane or the triangle has no area.
inline std::optional<PlaneHit> meet_plane(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& origin,
                                          const glm::dvec3& step) {
    const glm::dvec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0], from = origin - corners[0];
    const glm::dvec3 p = glm::cross(step, edge2), q = glm::cross(from, edge1);
    const double determinant = glm::dot(edge1, p);
    const PlaneHit hit{glm::dot(edge2, q) / determinant, glm::dot(from, p) / determinant,
                       glm::dot(step, q) / determinant};
    if (!std::isfinite(hit.t) || !std::isfinite(hit.u) || !std::isfinite(hit.v)) return std::nullopt;
    return hit;
}

/// Distance of a point of a triangle to its nearest edge, in the units of the corners.
inline double distance_to_rim(const std::array<glm::dvec3, 3>& corners, double u, double v) {
    const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
    const double doubled_area = glm::length(glm::cross(a, b));
    const auto from_edge = [&](double share, const glm::dvec3& edge) {
        const double length = glm::length(edge);
        return length > 0.0 ? share * doubled_area / length : 0.0;
    };
    return std::min({from_edge(1.0 - u - v, corners[2] - corners[1]), from_edge(u, b), from_edge(v, a)});
}

} // namespace reports
