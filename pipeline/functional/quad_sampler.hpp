// The texture unit's arithmetic: what a quad reads of a surface through a sampler, for recorded programs.
//
// Modelled: lines, planes, volumes, cubes (seamless or face by face), rectangles, buffers and arrays; wrap modes and
// borders, texel offsets, minification and magnification filters, mip levels with biases and bounds, anisotropy,
// comparisons of depths, gathers, swizzles, integer formats (nearest texels, as bits), single texels, queries. With
// gradients or levels of its own each lane has its level; else the quad has one, from the differences of its first
// lane to its neighbours. Each filtered probe and each fetch is one read of QuadWork.
// Not modelled: the stencil of depth formats, arrays of multisampled textures.
// Source: OpenGL 4.5 core, sections 8.13 to 8.23.
#pragma once

#include "pipeline/functional/mip_levels.hpp"
#include "pipeline/functional/texture_addressing.hpp"
#include "pipeline/surface_access.hpp"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace pipeline {

class QuadSampler {
  public:
    /// All of them outlive it. The surface is no k-buffer.
    QuadSampler(SurfaceAccess& surfaces, const TextureView& view, const SamplerState& sampler);

    /// Lanes that want nothing get 0.
    QuadTexels sample(const TextureLookup& lookup);
    /// 0 for what is outside of the texture.
    QuadTexels fetch(const TexelLookup& lookup);

    /// By lane: the levels above the base level that sample() reads (of two with its share), and what they follow from.
    std::array<glm::vec2, 4> levels(const TextureLookup& lookup) const;
    /// Width, height, depth and layers, as far as the texture has them, in this order without gaps; 0 of levels that
    /// it does not have.
    std::array<std::int32_t, 4> size(std::int32_t level) const;
    std::int32_t levels() const { return static_cast<std::int32_t>(last_ - base_ + 1); }
    std::int32_t samples() const { return view_.multisampled ? static_cast<std::int32_t>(info_.planes) : 1; }

  private:
    using Place = std::array<Lanes, 4>; ///< as TextureLookup::place

    struct LaneLevel {
        LevelReads reads;
        std::uint32_t probes = 1;
        bool probes_down = false;

        bool operator==(const LaneLevel&) const = default;
    };
    /// What the lanes read of a level: columns, rows, slices, and the plane of what has no slices.
    struct Reads {
        const TextureLookup& lookup;
        std::uint32_t level;
        AxisReads x, y, z;
        LaneIndices plane;
    };

    PixelFootprint footprint(const TextureLookup& lookup, std::size_t lane) const;
    std::array<LaneLevel, 4> lane_levels(const TextureLookup& lookup) const;
    std::array<float, 3> change(const TextureLookup& lookup, std::size_t lane, bool down) const;

    Reads reads_of(const TextureLookup& lookup, const Place& place, std::uint32_t level, bool linear) const;
    AxisReads axis(const TextureLookup& lookup, const Lanes& values, std::size_t coordinate, std::uint32_t size,
                   Wrap wrap, bool linear) const;
    LaneIndices layers(const Lanes& layer) const;

    QuadTexels gather(const TextureLookup& lookup);
    QuadTexels probe(const TextureLookup& lookup, const LaneLevel& level, unsigned lanes);
    QuadTexels filtered(const TextureLookup& lookup, const Place& place, std::uint32_t level, bool linear,
                        unsigned lanes);

    glm::vec4 texel(const Reads& reads, std::size_t lane, std::int32_t column, std::int32_t row, std::int32_t slice);
    glm::vec4 over_edge(const Reads& reads, std::size_t lane, std::int32_t column, std::int32_t row);
    glm::vec4 stored(const Reads& reads, std::size_t lane, std::int32_t column, std::int32_t row, std::uint32_t plane);
    glm::vec4 stored(std::int32_t column, std::int32_t row, std::uint32_t plane, std::uint32_t level);
    glm::vec4 compared(const TextureLookup& lookup, std::size_t lane, const glm::vec4& texel) const;
    float swizzled(const glm::vec4& texel, Swizzle channel) const;

    SurfaceAccess& surfaces_;
    const TextureView& view_;
    const SamplerState& sampler_;
    const SurfaceInfo& info_;
    std::uint32_t base_, last_; ///< levels
    bool integers_;
    glm::vec4 outside_; ///< what a border gives
};

} // namespace pipeline
