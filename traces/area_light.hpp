// A square light, and the frustum in which its middle sees a scene.
//
// Source: Bavoil 2007, section 5.3 (specification 004, section 3.5): light width l, near distance n and near-plane
// width w; all lengths in units of the scene, depths measured from the plane of the light.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/rays.hpp"
#include "traces/scene.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace traces {

struct AreaLight {
    glm::dvec3 centre{0.0};
    glm::dvec3 right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0}, forward{0.0, 0.0, -1.0}; ///< of unit length, orthogonal
    double width = 0.0;                                                          ///< edge of the square; 0 = a point
    double near = 0.1, far = 1.0; ///< planes of the frustum; 0 < near < far
    double near_width = 0.1;      ///< edge of the frustum at the near plane

    /// (along right, along up, distance from the plane of the light).
    glm::dvec3 seen(const glm::dvec3& world) const {
        const glm::dvec3 way = world - centre;
        return {glm::dot(way, right), glm::dot(way, up), glm::dot(way, forward)};
    }
    /// From the middle of the light onto a square map.
    pipeline::View view(std::uint32_t resolution) const;
    SquareLight square() const { return {centre, right * (width / 2.0), up * (width / 2.0)}; }
};

/// A place of number `i` of `count` point lights, a power of 4, that share the area of a light: the middles of equal
/// parts, in an order in which the first 4, 16 ... are evenly spread, too.
glm::dvec3 spread_over(const SquareLight& light, std::uint32_t i, std::uint32_t count);

/// The light of a scene. `light` is one of
///   auto             the scene's first spot light; without one, a light above the scene, to the right and in front
///   N                light number N of the scene, counted from 0: a spot light
///   px,py,pz,tx,ty,tz   place and target
/// `size` is the edge over the distance to the middle of the scene. Spot lights see what lies in their outer cone, the
/// others the bounding sphere. Near and far planes enclose the scene.
/// Throws sim::InputError, beginning with `place`, for anything else.
AreaLight make_area_light(const Scene& scene, const std::string& light, double size, const std::string& place);

} // namespace traces
