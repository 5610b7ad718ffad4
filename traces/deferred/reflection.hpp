// The light that a surface sends to the eye: one formula for shaders and for rays.
// Source: Aladağlı 2015, equation 2.1 (specification 003, B1).
#pragma once

#include "traces/deferred/spot_lights.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace traces {

struct ReflectingPoint {
    glm::dvec3 place{0.0};
    glm::dvec3 normal{0.0};
    double specular = 0.0; ///< its share
    double power = 1.0;
};

/// Diffuse light, and specular in alpha, which has the strongest channel. `arriving` is the light's colour, as far as
/// shadows leave it; `intensity` and the light's shape are applied here.
inline glm::dvec4 reflected(const SpotLight& light, double intensity, const glm::dvec3& arriving,
                            const ReflectingPoint& point, const glm::dvec3& eye) {
    const glm::dvec3 to_light = glm::normalize(light.place - point.place);
    const double facing = glm::dot(point.normal, to_light);
    if (!(facing > 0.0)) return glm::dvec4(0.0);
    const glm::dvec3 mirrored = 2.0 * facing * point.normal - to_light;
    const double along = std::max(glm::dot(mirrored, glm::normalize(eye - point.place)), 0.0);
    const double shine = point.specular * std::pow(along, point.power);
    const double share = intensity * light.arrives(point.place);
    return {arriving * (facing * share), shine * share * std::max({arriving.r, arriving.g, arriving.b})};
}

} // namespace traces
