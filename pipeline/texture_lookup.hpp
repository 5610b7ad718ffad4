// What a shader asks of a texture: how it sees the surface, what the sampler does, where the four lanes of a quad read.
//
// Source: OpenGL 4.5 core, sections 8.10 to 8.16. GL's CLAMP, which blends with the border at the edge, is taken for
// Wrap::clamp (to the edge).
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/functional/lanes.hpp"
#include "pipeline/raster_state.hpp"

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

namespace pipeline {

/// Each channel that a shader sees is one of the surface's, or a constant.
enum class Swizzle : std::uint8_t { red, green, blue, alpha, zero, one };

struct SamplerState {
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat, wrap_w = Wrap::repeat;
    Filter min_filter = Filter::nearest_mip_linear, mag_filter = Filter::linear;
    glm::vec4 border{0.0F}; ///< linear; channels that the format lacks count as they read
    float lod_bias = 0.0F, least_lod = -1000.0F, most_lod = 1000.0F;
    float anisotropy = 1.0F;               ///< most probes along the longer axis; 1: isotropic
    bool compares = false;                 ///< depth formats: gives 0 or 1
    Compare compare = Compare::less_equal; ///< reference OP texel
    bool seamless = true;                  ///< filters of cubes reach over edges

    bool operator==(const SamplerState&) const = default;
};

enum class TextureKind : std::uint8_t { line, plane, volume, cube, rectangle, buffer };

/// Coordinates of a place in it, without layer.
constexpr std::uint32_t coordinates_of(TextureKind kind) {
    constexpr std::array<std::uint32_t, 6> counts{1, 2, 3, 3, 2, 1};
    return counts[static_cast<std::size_t>(kind)];
}

/// A level of a plane that another surface of one plane and level has.
struct TexturePart {
    std::uint32_t level = 0, plane = 0;
    std::uint32_t slot = 0; ///< of SurfaceAccess
};

/// How a shader sees a surface.
struct TextureView {
    std::uint32_t slot = 0; ///< of SurfaceAccess
    TextureKind kind = TextureKind::plane;
    bool arrayed = false;      ///< planes are layers; of a cube six each
    bool multisampled = false; ///< planes are samples
    std::uint32_t base_level = 0, last_level = 1000;
    std::array<Swizzle, 4> swizzle{Swizzle::red, Swizzle::green, Swizzle::blue, Swizzle::alpha};
    std::vector<TexturePart> parts{}; ///< in place of its own; their formats are the surface's
};

enum class LevelOfDetail : std::uint8_t {
    implicit, ///< from differences of the coordinates within the quad, plus `lod`
    given,    ///< `lod`
    gradients ///< from dx and dy
};

/// A filtered read, or a gather. All four lanes are there, those that want nothing, too: their coordinates make
/// differences.
struct TextureLookup {
    unsigned lanes = 15;          ///< mask of those that want a value
    std::array<Lanes, 4> place{}; ///< coordinates, then the layer; in [0,1] over the surface, of rectangles in texels
    LevelOfDetail level = LevelOfDetail::implicit;
    Lanes lod{};                                         ///< bias or level
    std::array<Lanes, 3> dx{}, dy{};                     ///< gradients
    std::array<std::array<std::int32_t, 4>, 3> offset{}; ///< texels, by coordinate and lane
    bool compares = false;
    Lanes reference{};           ///< depth to compare with
    bool gathers = false;        ///< four texels' component instead of a filtered texel
    std::uint32_t component = 0; ///< of a gather
};

/// A read of single texels.
struct TexelLookup {
    unsigned lanes = 15;
    std::array<std::array<std::int32_t, 4>, 4> place{}; ///< texel, then the layer; offsets are added
    std::array<std::int32_t, 4> level{}, sample{};
};

} // namespace pipeline
