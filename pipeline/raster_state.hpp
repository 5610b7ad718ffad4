// State of the fixed-function units that an application may change from draw to draw.
//
// Source: OpenGL 4.5 core, sections 13.5 (user clip distances), 13.6 (viewport, depth range), 14.4 to 14.6 (points,
// lines, polygons) and 17.3 (per-fragment operations). Not modelled: logic operations, dual-source blending, depth
// bounds.
#pragma once

#include "sim/field.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <string_view>

namespace pipeline {

/// A comparison `incoming OP stored`.
enum class Compare : std::uint8_t { never, less, equal, less_equal, greater, not_equal, greater_equal, always };

template <class T>
constexpr bool passes(Compare compare, T incoming, T stored) {
    switch (compare) {
    case Compare::never:
        return false;
    case Compare::less:
        return incoming < stored;
    case Compare::equal:
        return incoming == stored;
    case Compare::less_equal:
        return incoming <= stored;
    case Compare::greater:
        return incoming > stored;
    case Compare::not_equal:
        return incoming != stored;
    case Compare::greater_equal:
        return incoming >= stored;
    case Compare::always:
        break;
    }
    return true;
}

enum class BlendFactor : std::uint8_t {
    zero,
    one,
    source_colour,
    one_minus_source_colour,
    target_colour,
    one_minus_target_colour,
    source_alpha,
    one_minus_source_alpha,
    target_alpha,
    one_minus_target_alpha,
    constant_colour,
    one_minus_constant_colour,
    constant_alpha,
    one_minus_constant_alpha,
    source_alpha_saturate ///< min(source alpha, 1 - target alpha) for colour, 1 for alpha
};

/// `least` and `greatest` take no factors.
enum class BlendEquation : std::uint8_t { add, subtract, reverse_subtract, least, greatest };

struct BlendPart {
    BlendFactor source = BlendFactor::one;
    BlendFactor target = BlendFactor::zero;
    BlendEquation equation = BlendEquation::add;

    bool operator==(const BlendPart&) const = default;
};

/// How the colour of a fragment is combined with that of a target.
struct BlendState {
    bool enabled = false; ///< false: the fragment's colour replaces the stored one
    BlendPart colour, alpha;
    glm::vec4 constant{0.0F};

    bool operator==(const BlendState&) const = default;
};

namespace blends {

/// rgb = source * a + target * (1 - a), alpha = a + target * (1 - a), a = source alpha; colours not premultiplied.
inline constexpr BlendPart over_colour{BlendFactor::source_alpha, BlendFactor::one_minus_source_alpha,
                                       BlendEquation::add};
inline constexpr BlendPart over_alpha{BlendFactor::one, BlendFactor::one_minus_source_alpha, BlendEquation::add};
inline constexpr BlendPart sum{BlendFactor::one, BlendFactor::one, BlendEquation::add};
inline constexpr BlendPart least{BlendFactor::one, BlendFactor::one, BlendEquation::least};
inline constexpr BlendPart greatest{BlendFactor::one, BlendFactor::one, BlendEquation::greatest};

inline BlendState of(const BlendPart& colour, const BlendPart& alpha) { return {true, colour, alpha, glm::vec4(0.0F)}; }
inline BlendState of(const BlendPart& all) { return of(all, all); }
inline BlendState over() { return of(over_colour, over_alpha); }

} // namespace blends

struct DepthState {
    bool test = false;
    bool write = false;
    Compare compare = Compare::less;
    /// Depths beyond the near and far planes are clamped instead of clipped.
    bool clamp = false;
    float bias_slope = 0.0F;    ///< added to the depth: slope * largest depth change per pixel
    float bias_constant = 0.0F; ///< ... + constant * the smallest step of the depth format
    float range_near = 0.0F;    ///< window depth of the near plane of clip space, 0 to 1
    float range_far = 1.0F;     ///< ... of the far plane, which may be less

    /// What fragments' depths lie between; those that a shader sets, between 0 and 1.
    float least() const { return clamp ? std::min(range_near, range_far) : 0.0F; }
    float greatest() const { return clamp ? std::max(range_near, range_far) : 1.0F; }
    /// Whether the depth surface is touched at all.
    bool used() const { return test || write; }
    bool operator==(const DepthState&) const = default;
};

enum class StencilOperation : std::uint8_t {
    keep,
    zero,
    replace,
    increment,      ///< up to 255
    decrement,      ///< down to 0
    increment_wrap, ///< 255 becomes 0
    decrement_wrap,
    invert
};

/// Of triangles that face one way.
struct StencilFace {
    Compare compare = Compare::always; ///< (reference & mask) OP (stored & mask)
    std::uint8_t reference = 0;
    std::uint8_t compare_mask = 0xFF;
    std::uint8_t write_mask = 0xFF;
    StencilOperation stencil_fails = StencilOperation::keep;
    StencilOperation depth_fails = StencilOperation::keep;
    StencilOperation passes = StencilOperation::keep;

    bool operator==(const StencilFace&) const = default;
};

struct StencilState {
    bool test = false;
    StencilFace front, back;

    bool operator==(const StencilState&) const = default;
};

/// Pixels [x, x + width) x [y, y + height), row 0 on top.
struct PixelRectangle {
    std::int32_t x = 0, y = 0;
    std::uint32_t width = 0, height = 0;

    bool operator==(const PixelRectangle&) const = default;
};

enum class FaceCulling : std::uint8_t {
    by_material, ///< back faces, unless the material is double-sided; winding follows mirroring matrices (glTF)
    none,
    front,
    back,
    both
};

/// Whose flat attributes a primitive takes.
enum class ProvokingVertex : std::uint8_t { first, last };

inline constexpr std::uint32_t most_targets_of_pass = 8;
inline constexpr std::uint32_t most_clip_distances = 8;
inline constexpr float largest_point = 2048.0F; ///< pixels; points and lines are 1 pixel wide at least

struct RasterState {
    std::array<BlendState, most_targets_of_pass> blend;
    std::array<std::uint8_t, most_targets_of_pass> write_mask{0xF, 0xF, 0xF, 0xF, 0xF, 0xF, 0xF, 0xF}; ///< bit 0 is red
    DepthState depth;
    StencilState stencil;
    std::optional<PixelRectangle> viewport; ///< none: the whole view
    std::optional<PixelRectangle> scissor;
    FaceCulling culling = FaceCulling::by_material;
    bool front_is_clockwise = false; ///< on the screen, for culling by face and for stencil faces
    ProvokingVertex provoking = ProvokingVertex::last;
    float point_size = 1.0F;           ///< pixels along a side of the square
    bool point_size_of_vertex = false; ///< the vertex program says it instead
    bool point_sprites = false;   ///< texture coordinates run from 0 to 1 over a point, from the left and from the top
    float line_width = 1.0F;      ///< pixels across the larger extent of the line, rounded
    std::uint8_t clip_planes = 0; ///< bit i: plane i cuts
    std::array<glm::vec4, most_clip_distances> clip_plane{}; ///< in eye space; what has a negative product is cut

    bool operator==(const RasterState&) const = default;
};

} // namespace pipeline

template <>
struct sim::EnumNames<pipeline::Compare> {
    static constexpr std::array<std::string_view, 8> names{"never",   "less",      "equal",         "less_equal",
                                                           "greater", "not_equal", "greater_equal", "always"};
};
template <>
struct sim::EnumNames<pipeline::BlendFactor> {
    static constexpr std::array<std::string_view, 15> names{"zero",
                                                            "one",
                                                            "source_colour",
                                                            "one_minus_source_colour",
                                                            "target_colour",
                                                            "one_minus_target_colour",
                                                            "source_alpha",
                                                            "one_minus_source_alpha",
                                                            "target_alpha",
                                                            "one_minus_target_alpha",
                                                            "constant_colour",
                                                            "one_minus_constant_colour",
                                                            "constant_alpha",
                                                            "one_minus_constant_alpha",
                                                            "source_alpha_saturate"};
};
template <>
struct sim::EnumNames<pipeline::BlendEquation> {
    static constexpr std::array<std::string_view, 5> names{"add", "subtract", "reverse_subtract", "least", "greatest"};
};
template <>
struct sim::EnumNames<pipeline::StencilOperation> {
    static constexpr std::array<std::string_view, 8> names{"keep",      "zero",           "replace",        "increment",
                                                           "decrement", "increment_wrap", "decrement_wrap", "invert"};
};
