// What deferred shading keeps of a surface in a k-buffer of two classes: the G-buffer's texels, packed into its words.
#pragma once

#include "models/programs/two_class.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/surface_access.hpp"
#include "traces/deferred/emission.hpp"

#include <array>
#include <cstring>

namespace traces {

/// As the G-buffer's formats round it: 8 bits of each colour and of opacity and specular, 10 bits of each part of a
/// normal. What remains of the words has 4 bits of each part of the light that the surface sends out.
struct TwoClassSurface {
    glm::vec4 colour{0, 0, 0, 1}; ///< alpha is opacity
    glm::vec4 normal{0.5F};       ///< from [-1,1] to [0,1]
    glm::vec4 specular{0.0F};     ///< intensity, power / 255
    glm::vec3 emission{0.0F};     ///< 0 to 1
    float depth = 1.0F;           ///< window depth; 1: there is no surface

    /// The words of an entry, for the output of a shader.
    glm::vec4 words() const {
        using Words = models::TwoClassWords;
        const std::uint32_t rgba = packed(pipeline::SurfaceFormat::rgba8, colour),
                            shine = packed(pipeline::SurfaceFormat::rgba8, specular);
        const std::uint32_t glow = emission_12(emission);
        const std::uint32_t material =
            (glow & 63U) << glow_shift | (rgba >> 24U) << Words::opacity_shift | (shine & 0xFFFFU);
        return {Words::packed((glow >> 6U) << glow_shift | (rgba & 0xFFFFFFU)),
                Words::packed(packed(pipeline::SurfaceFormat::rgb10a2, normal) & Words::most), Words::packed(material),
                0.0F};
    }

    static TwoClassSurface of(const float* entry) {
        using Words = models::TwoClassWords;
        const std::uint32_t first = Words::word(entry[0]), material = Words::word(entry[2]);
        const std::uint32_t opacity = material >> Words::opacity_shift & 0xFFU;
        return {unpacked(pipeline::SurfaceFormat::rgba8, (first & 0xFFFFFFU) | opacity << 24U),
                unpacked(pipeline::SurfaceFormat::rgb10a2, Words::word(entry[1])),
                unpacked(pipeline::SurfaceFormat::rgba8, material & 0xFFFFU),
                emission_of_12((first >> glow_shift) << 6U | (material >> glow_shift & 63U)), entry[3]};
    }

    /// Scale and round each of the three, and gather their parts by a dot product; and the way back.
    static constexpr std::uint32_t slots_to_pack = 3 + 3, slots_to_unpack = 3 + 3;

  private:
    static constexpr std::uint32_t glow_shift = 24; ///< of six bits in the first and in the third word

    static std::uint32_t packed(pipeline::SurfaceFormat format, const glm::vec4& colour) {
        std::array<std::byte, 4> bytes{};
        pipeline::pack_colour(format, colour, bytes.data());
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < bytes.size(); ++i) word |= std::to_integer<std::uint32_t>(bytes[i]) << 8U * i;
        return word;
    }
    static glm::vec4 unpacked(pipeline::SurfaceFormat format, std::uint32_t word) {
        std::array<std::byte, 4> bytes{};
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(word >> 8U * i & 0xFFU);
        return pipeline::unpack_texel(format, bytes.data());
    }
};

using QuadSurfaces = std::array<TwoClassSurface, 4>;

/// Both classes at the pixels of a quad; where nothing is read, there is no surface.
struct TwoClassQuad {
    QuadSurfaces transparent, opaque;
};

/// Reads entries [first, first + count) at these places.
inline TwoClassQuad read_two_class(pipeline::SurfaceAccess& surfaces, std::uint32_t slot,
                                   const pipeline::LaneIndices& x, const pipeline::LaneIndices& y, unsigned pixels,
                                   std::uint32_t first = 0, std::uint32_t count = 2) {
    static_assert(models::two_class_floats == 4); // an entry is a render target
    surfaces.issue(count * TwoClassSurface::slots_to_unpack, pixels);
    const auto read = surfaces.pixels(slot, x, y, pixels, first, count);
    TwoClassQuad quad;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::uint32_t entry = first; read[i] != nullptr && entry < first + count; ++entry)
            (entry == models::opaque_entry ? quad.opaque : quad.transparent)[i] =
                TwoClassSurface::of(read[i] + std::size_t{entry} * models::two_class_floats);
    return quad;
}

} // namespace traces
