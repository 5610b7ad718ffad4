// Spot lights of deferred shading: what they send where, the view of their shadow map, and the volume that they light.
//
// Source: Aladağlı 2015, sections 2.1 and 3.2 (specification 003, B1). Attenuation and cone are not given there:
// (1 - distance / range)^2 and a smooth step between the two angles are taken.
#pragma once

#include "pipeline/frame.hpp"
#include "traces/scene.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace traces {

struct SpotLight {
    glm::dvec3 place{0.0};
    glm::dvec3 direction{0.0, -1.0, 0.0}; ///< of unit length
    glm::dvec3 colour{1.0};               ///< linear RGB in [0,1]
    double range = 1.0;                   ///< scene units; nothing is lit beyond
    double inner = 0.2, outer = 0.4;      ///< half angles of the cone, radians; 0 <= inner < outer < pi / 2

    /// The share of its light that arrives at a point, in [0,1].
    double arrives(const glm::dvec3& at) const;
    /// What is nearer casts no shadow.
    double lamp() const { return range / 1000.0; }
    /// Of its shadow map; depths from lamp() to the range.
    pipeline::View view(std::uint32_t map_size) const;
    /// Takes the cone of add_light_volumes() to the one that encloses all that it lights.
    glm::dmat4 volume() const;
    /// Whether a ball of this radius touches that cone.
    bool touches(const glm::dvec3& centre, double radius) const;
};

/// `count` lights: first the spot lights of the scene, then some around it that look into it, always the same.
std::vector<SpotLight> spot_lights(const Scene& scene, std::uint32_t count);

/// Gives the frame resources of its own with a cone, and a draw of it for each light; returns their numbers. The sides
/// of the cone face outwards.
std::vector<std::uint32_t> add_light_volumes(pipeline::Frame& frame, const std::vector<SpotLight>& lights);

} // namespace traces
