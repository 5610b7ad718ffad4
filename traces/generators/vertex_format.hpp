// In which formats a generator writes the vertices and indices of a mesh.
#pragma once

#include "pipeline/draw.hpp"
#include "sim/field.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

/// Where attributes lie: each in a buffer of its own, or all of a vertex together.
enum class VertexLayout : std::uint8_t { separate, interleaved };

/// Three floats, or three signed 16-bit integers on a grid over the bounding box of each draw.
enum class PositionFormat : std::uint8_t { f32, s16 };

/// `automatic`: 16 bits where 65,536 vertices suffice.
enum class IndexWidth : std::uint8_t { automatic, u16, u32 };

/// One attribute. Integers are normalised: they hold -1 to 1 or 0 to 1.
struct AttributeFormat {
    pipeline::Semantic semantic = pipeline::Semantic::normal;
    pipeline::ComponentType type = pipeline::ComponentType::f32;
    std::uint8_t components = 3;

    std::uint32_t bytes() const { return pipeline::element_bytes(type, components); }
    bool operator==(const AttributeFormat&) const = default;
};

struct MeshFormat {
    PositionFormat position = PositionFormat::f32;
    /// Beside positions; none given: what the mesh has, normals as three floats and colours as four bytes.
    std::optional<std::vector<AttributeFormat>> attributes = std::nullopt;
    VertexLayout layout = VertexLayout::separate;
    IndexWidth index = IndexWidth::automatic;
    std::uint32_t align = 4; ///< bytes; the offset and the stride of every attribute is a multiple of it
};

/// Reads "normal:3f32+texcoord:4f32*8+colour:4u8", or "none": attributes joined by '+', each a name (normal, colour,
/// secondary_colour, texcoord, generic), the number of components, a sim::EnumNames name of pipeline::ComponentType
/// and, for texcoord, '*' and how many sets. Texture coordinates take the sets 0 to 7 in turn; other names occur once.
/// Throws sim::InputError, beginning with `place`.
std::vector<AttributeFormat> read_attribute_formats(std::string_view text, std::string_view place);

/// Throws sim::InputError, beginning with `place`, for what is not 1, 2 or 4.
void check_align(std::uint32_t align, std::string_view place);

/// What help says of the parameters below.
struct MeshFormatTexts {
    static constexpr std::string_view layout = "each attribute in a buffer of its own, or all of a vertex together";
    static constexpr std::string_view position =
        "three floats, or three 16-bit integers on a grid over the bounding box of each draw";
    static constexpr std::string_view attributes =
        "beside positions: none, or name:components, type and *sets joined by +, as in "
        "normal:3s16+texcoord:4f32*8+colour:4u8; names normal, colour, secondary_colour, texcoord, generic; types f32, "
        "f16, s8, u8, s16, u16, u32, s10_10_10_2, u10_10_10_2";
    static constexpr std::string_view index = "bits of an index; auto takes 16 where 65536 vertices suffice";
    static constexpr std::string_view align = "1, 2 or 4: offset and stride of every attribute is a multiple of it";
};

/// The format that the parameters position, attributes, layout, index and align of a generator ask for.
template <class Params>
MeshFormat format_of(const Params& params, const std::string& place) {
    check_align(params.align, place);
    return {params.position, read_attribute_formats(params.attributes, place + ": attributes"), params.layout,
            params.index, params.align};
}

/// Writes an element of `type` at `target`: integers to nearest, after scaling by their largest value when
/// `normalized`; out of range goes to the nearest that is in it. Components beyond `components` are left out.
void write_element(std::byte* target, pipeline::ComponentType type, std::uint32_t components, bool normalized,
                   const glm::dvec4& value);

/// What a draw of 16-bit positions is drawn with (Bavoil 2007, section 3.7.1; specification 004, A3).
///
/// Code q of an axis stands for centre + q * step, |q| <= 32767: off by at most half a step, which is
/// extent / 131,068. An axis without extent has the code 0 only.
struct PositionGrid {
    glm::dvec3 centre{0.0};
    glm::dvec3 step{1.0};

    PositionGrid() = default;
    PositionGrid(const glm::dvec3& lo, const glm::dvec3& hi); ///< lo <= hi
    glm::dvec3 code(const glm::dvec3& position) const;        ///< whole numbers
    glm::mat4 to_model() const;                               ///< from codes to positions
};

} // namespace traces

template <>
struct sim::EnumNames<traces::VertexLayout> {
    static constexpr std::array<std::string_view, 2> names{"separate", "interleaved"};
};

template <>
struct sim::EnumNames<traces::PositionFormat> {
    static constexpr std::array<std::string_view, 2> names{"f32", "s16"};
};

template <>
struct sim::EnumNames<traces::IndexWidth> {
    static constexpr std::array<std::string_view, 3> names{"auto", "u16", "u32"};
};
