#include "pipeline/functional/cube_faces.hpp"

#include <cmath>
#include <cstdlib>

namespace pipeline {

namespace {

/// A component of the direction, with a sign.
struct Axis {
    std::size_t component;
    int sign;
};
struct FaceAxes {
    Axis s, t;
};
/// Table 8.19. The major axis of face f is component f / 2, negative where f is odd.
constexpr std::array<FaceAxes, 6> faces{{{{2, -1}, {1, -1}},
                                         {{2, 1}, {1, -1}},
                                         {{0, 1}, {2, 1}},
                                         {{0, 1}, {2, -1}},
                                         {{0, 1}, {1, -1}},
                                         {{0, -1}, {1, -1}}}};

template <class T>
T component_along(const std::array<T, 3>& direction, const Axis& axis) {
    return axis.sign < 0 ? -direction[axis.component] : direction[axis.component];
}

template <class T>
std::uint32_t face_of(const std::array<T, 3>& direction) {
    const T x = std::abs(direction[0]), y = std::abs(direction[1]), z = std::abs(direction[2]);
    const std::uint32_t component = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
    return 2 * component + (direction[component] < T{0} ? 1 : 0);
}

} // namespace

CubePlace cube_place(const std::array<float, 3>& direction) {
    const std::uint32_t face = face_of(direction);
    const float major = std::abs(direction[face / 2]);
    // Divided before anything is added: directions may be as long as floats go.
    const auto place = [&](const Axis& axis) { return (component_along(direction, axis) / major + 1.0F) * 0.5F; };
    return {face, place(faces[face].s), place(faces[face].t)};
}

std::array<double, 2> cube_derivative(std::uint32_t face, const std::array<float, 3>& direction,
                                      const std::array<float, 3>& change) {
    const Axis major_axis{face / 2, face % 2 == 0 ? 1 : -1};
    const double major = component_along(direction, major_axis), growth = component_along(change, major_axis);
    const auto derivative = [&](const Axis& axis) {
        const double minor = component_along(direction, axis);
        return 0.5 * (component_along(change, axis) - minor / major * growth) / major;
    };
    return {derivative(faces[face].s), derivative(faces[face].t)};
}

// In units of half a texel from the middle of the cube, its sides are `size` away, and centres of texels have odd
// coordinates below that. Beyond an edge the side that ends there becomes the last row of texels of the next one.
CubeTexel beyond_edge(const CubeTexel& texel, std::int32_t size) {
    const FaceAxes& axes = faces[texel.face];
    std::array<std::int32_t, 3> place{};
    const auto put = [&](const Axis& axis, std::int32_t coordinate) { place[axis.component] = axis.sign * coordinate; };
    const auto crossed = [&](std::int32_t index) { return index < 0 ? -size : size; };
    const auto inside = [&](std::int32_t index) { return 2 * index + 1 - size; };
    const bool over_column = texel.column < 0 || texel.column >= size;
    put({texel.face / 2, texel.face % 2 == 0 ? 1 : -1}, size - 1);
    put(axes.s, over_column ? crossed(texel.column) : inside(texel.column));
    put(axes.t, over_column ? inside(texel.row) : crossed(texel.row));
    const std::uint32_t face = face_of(place);
    const auto index = [&](const Axis& axis) { return (component_along(place, axis) + size - 1) / 2; };
    return {face, index(faces[face].s), index(faces[face].t)};
}

} // namespace pipeline
