// What a point receives of a light through an interlaced shadow map, and how a pane lies over what is seen through it.
// Source: Aladağlı 2015, sections 3.2.1 and 3.3, equations 3.1 to 3.3 (specification 003, B6 and B8).
#pragma once

#include <glm/glm.hpp>

namespace traces {

struct ShadowTexel {
    float depth = 1.0F;             ///< as the light sees it
    glm::vec4 colour{0, 0, 0, 1.F}; ///< alpha is opacity
};

/// Of two texels, one above the other: nothing behind the more opaque one; behind the other its colour is the most that
/// passes, and of that the share that it lets through. Of two of the same opacity `first` counts as the clearer one.
inline glm::vec3 light_through(const ShadowTexel& first, const ShadowTexel& second, float depth,
                               const glm::vec3& light) {
    const bool swapped = second.colour.a < first.colour.a;
    const ShadowTexel &clearer = swapped ? second : first, &denser = swapped ? first : second;
    if (denser.depth < depth) return glm::vec3(0.0F);
    if (clearer.depth < depth) return glm::min(light, glm::vec3(clearer.colour)) * (1.0F - clearer.colour.a);
    return light;
}

/// A surface of this opacity over another; both lit.
inline glm::vec3 laid_over(const glm::vec3& behind, const glm::vec3& front, float opacity) {
    return behind * (1.0F - opacity) + front * opacity;
}

} // namespace traces
