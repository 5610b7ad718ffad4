// A3: positions as signed 16-bit integers in the box of their geometry.
#pragma once

#include "sim/described.hpp"
#include "traces/preparation/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace traces {

enum class QuantiseBox : std::uint8_t { axes, cube };

enum class NormalFormat : std::uint8_t { floats, s8, s16 };

/// The grid that positions are rounded to: q = round(32767 * (2 (p - lo) / extent - 1)) for each axis.
struct QuantiseGrid {
    glm::dvec3 lo{0.0}, extent{0.0}; ///< of the box; an axis without extent has q = 0

    /// `positions` are finite. cube: a box of one extent for all axes, round the middle of the positions.
    static QuantiseGrid around(std::span<const glm::vec3> positions, QuantiseBox box);

    std::array<std::int16_t, 3> quantise(const glm::vec3& position) const;
    /// Distance between a position and its integer, for each axis; at most extent / 131068 (specification 004, A3).
    glm::dvec3 error(const glm::vec3& position, const std::array<std::int16_t, 3>& quantised) const;
    /// Scene units per step; an axis without extent takes that of another axis, or 1, so that restoring can be undone.
    glm::dvec3 step() const;
    glm::dmat4 restore() const; ///< takes integers to positions
    /// False where a step is too small for the floats of a matrix.
    bool representable() const;
};

/// How far quantising went from the truth.
struct QuantiseErrors {
    double of_bound = 0.0;     ///< largest error of a coordinate, as a fraction of extent / 131068
    double normal_angle = 0.0; ///< largest angle between a normal and what is left of it, radians
};

/// Replaces positions, and normals where the restoring matrix would bend them or `normals` asks for integers. Returns
/// the matrix that restores positions (normals follow by its cofactors), or nothing and changes nothing where the grid
/// is not representable. Elements begin at multiples of `align` bytes.
std::optional<glm::dmat4> quantise_mesh(TriangleMesh& mesh, QuantiseBox box, NormalFormat normals, std::uint32_t align,
                                        QuantiseErrors& errors);

} // namespace traces

template <>
struct sim::EnumNames<traces::QuantiseBox> {
    static constexpr std::array<std::string_view, 2> names{"axes", "cube"};
};

template <>
struct sim::EnumNames<traces::NormalFormat> {
    static constexpr std::array<std::string_view, 3> names{"floats", "s8", "s16"};
};
