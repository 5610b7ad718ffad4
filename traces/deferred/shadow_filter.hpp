// What a point receives of a light through an interlaced shadow map, and how a pane lies over what is seen through it:
// in floats for shaders, in doubles for rays.
// Source: Aladağlı 2015, sections 3.2.1 and 3.3, equations 3.1 to 3.3 (specification 003, B6 and B8).
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace traces {

/// What lies somewhere between the light and a point.
template <class T>
struct Filter {
    T depth = T(1);                    ///< as the light sees it
    glm::vec<4, T> colour{0, 0, 0, 1}; ///< alpha is opacity
};
using ShadowTexel = Filter<float>;

/// Of two texels, one above the other: nothing behind the more opaque one; behind the other its colour is the most that
/// passes, and of that the share that it lets through. Of two of the same opacity `first` counts as the clearer one.
template <class T>
glm::vec<3, T> light_through(const Filter<T>& first, const Filter<T>& second, T depth, const glm::vec<3, T>& light) {
    const bool swapped = second.colour.a < first.colour.a;
    const Filter<T>&clearer = swapped ? second : first, &denser = swapped ? first : second;
    if (denser.depth < depth) return glm::vec<3, T>(0);
    if (clearer.depth < depth) return glm::min(light, glm::vec<3, T>(clearer.colour)) * (T(1) - clearer.colour.a);
    return light;
}

/// A surface of this opacity over another; both lit.
template <class T>
glm::vec<3, T> laid_over(const glm::vec<3, T>& behind, const glm::vec<3, T>& front, T opacity) {
    return behind * (T(1) - opacity) + front * opacity;
}

/// A surface in the light that it got. Specular light, in alpha, is white.
template <class T>
glm::vec<3, T> lit_by(const glm::vec<4, T>& light, const glm::vec<3, T>& colour) {
    return colour * glm::vec<3, T>(light) + light.a;
}

/// The pixel that shows what a pane with this normal, in eye space, shows at pixel `at`; `offset` pixels away where the
/// normal lies across the view.
template <class T>
glm::ivec2 seen_through(const glm::ivec2& at, const glm::vec<3, T>& normal, T offset, const glm::ivec2& size) {
    const auto along = [offset](T part) { return static_cast<std::int32_t>(std::lround(offset * part)); };
    return glm::clamp(at + glm::ivec2(along(normal.x), -along(normal.y)), glm::ivec2(0), size - 1);
}

} // namespace traces
