// How much of a square light is seen from points of a scene: stratified occlusion rays (specification 004, section
// 10.4, "soft shadow").
//
// The light is cut into n x n equal parts, n * n as near to the wanted number of rays as a square comes, and a ray goes
// to a random place of each. The random numbers come from seed, point and part, so points can be computed in any order.
// Triangles hide from both sides, alpha tests are honoured. A ray does not see what lies within RayScene::clearance()
// of the point or of the light: the surface that the point lies on, and a lamp that is drawn where the light is.
#pragma once

#include "reports/truth/pixel_rays.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace reports {

using traces::SquareLight;

struct LightSampling {
    std::uint32_t rays = 1000; ///< for each point, at least 1
    std::uint64_t seed = 1;
    std::uint64_t first_point = 0; ///< number of the first point, where points come in portions
};

/// n of the n x n parts.
std::uint32_t light_parts(std::uint32_t rays);

/// The visible share of the light, 0 to 1, for each point. A point within the light's plane sees what its rays see.
std::vector<float> light_visibility(const RayScene& scene, std::span<const glm::dvec3> points, const SquareLight& light,
                                    const LightSampling& sampling = {}, const TracingOptions& options = {});

} // namespace reports
