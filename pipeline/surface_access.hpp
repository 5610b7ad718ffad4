// How shaders read surfaces that earlier passes finished. With a QuadWork attached every read records the lines that it
// touches, so that value and cost come from the same code.
//
// Modelled: single texels, nearest, bilinear and trilinear filters, wrap modes and borders, pixels of k-buffers. What
// recorded programs want of textures beside these is in functional/quad_sampler.hpp. Source: OpenGL 4.5 core,
// sections 8.14 and 8.15.
#pragma once

#include "pipeline/functional/texture_addressing.hpp"
#include "pipeline/quad_work.hpp"
#include "pipeline/surface.hpp"

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>

namespace pipeline {

/// Values at the pixels of a quad; pixel i is (x + i % 2, y + i / 2).
using QuadTexels = std::array<glm::vec4, 4>;
using LaneIndices = std::array<std::int32_t, 4>;

struct SurfaceSampler {
    bool linear = false; ///< within a level
    bool mips = false;   ///< blends two levels where `linear`, takes the nearer one else
    Wrap wrap_u = Wrap::clamp, wrap_v = Wrap::clamp;
    glm::vec4 border{0.0F};
};

class SurfaceAccess {
  public:
    /// `surfaces` and `slots` outlive it, and `work` where there is one. The shader knows surface slots[i] as i.
    SurfaceAccess(const SurfaceStore& surfaces, std::span<const SurfaceId> slots, QuadWork* work = nullptr)
        : surfaces_(surfaces), slots_(slots), work_(work) {}

    /// Counts instructions of the pixels in the mask.
    void issue(std::uint32_t instructions, unsigned pixels = 15) {
        if (work_ != nullptr) work_->issue(instructions, pixels);
    }

    /// Begins a read of the surface by the quad, to which the texels belong that read_texel() gives next.
    void begin_read(std::uint32_t slot) { begin_fetch(slots_[slot]); }
    /// The bytes of a texel inside of the surface.
    const std::byte* read_texel(std::uint32_t slot, const SurfacePlace& place) { return bytes(slots_[slot], place); }

    /// The texels at these places, for the pixels in the mask; 0 for others and outside of the surface.
    QuadTexels fetch(std::uint32_t slot, const LaneIndices& x, const LaneIndices& y, unsigned pixels,
                     std::uint32_t plane = 0, std::uint32_t level = 0);

    /// Filtered at coordinates in [0,1] over the surface, v = 0 at row 0; the level follows from the derivatives within
    /// the quad, so coordinates of pixels outside of the mask count, too.
    QuadTexels sample(std::uint32_t slot, const SurfaceSampler& sampler, const Lanes& u, const Lanes& v,
                      unsigned pixels, std::uint32_t plane = 0);
    /// The same at a level of detail that the shader gives; 0 is the finest.
    QuadTexels sample_level(std::uint32_t slot, const SurfaceSampler& sampler, const Lanes& u, const Lanes& v,
                            unsigned pixels, float level_of_detail, std::uint32_t plane = 0);

    /// Pixels of a k-buffer at these places, null for those not in the mask: their program's floats, of which the
    /// shader reads render targets [first, first + count). Each of them is a texture read of its own.
    std::array<const float*, 4> pixels(std::uint32_t slot, const LaneIndices& x, const LaneIndices& row,
                                       unsigned pixels, std::uint32_t first, std::uint32_t count);

    const SurfaceInfo& info(std::uint32_t slot) const { return surfaces_.info(slots_[slot]); }

  private:
    QuadTexels filter(SurfaceId surface, const SurfaceSampler& sampler, const Lanes& u, const Lanes& v, unsigned pixels,
                      std::uint32_t plane, std::uint32_t level);
    glm::vec4 texel(SurfaceId surface, std::int32_t x, std::int32_t y, std::uint32_t plane, std::uint32_t level,
                    const glm::vec4& outside);
    const std::byte* bytes(SurfaceId surface, const SurfacePlace& place) {
        if (work_ != nullptr) work_->touch(surfaces_.address(surface, place));
        return surfaces_.read(surface, place);
    }
    void begin_fetch(SurfaceId surface) {
        if (work_ != nullptr) work_->begin_fetch(surfaces_.info(surface).texel_bytes());
    }

    const SurfaceStore& surfaces_;
    std::span<const SurfaceId> slots_;
    QuadWork* work_;
};

} // namespace pipeline
