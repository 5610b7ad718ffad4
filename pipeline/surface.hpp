// The surfaces of a frame: what passes write and later passes read.
//
// Modelled: formats; planes (samples, layers, cube faces, slices of a volume, slots), mip levels; the value of a clear;
// where each texel lies in GPU memory, the same for ROPs, texture units, kernels and DRAM. A page of 16x16 pixels is
// allocated when something first writes into it: a surface that is cleared and never drawn to costs nothing. Textures
// in block-compressed formats have the addresses of their blocks; their texels are held decoded and cannot be written.
// Not modelled: compression of targets.
#pragma once

#include "pipeline/output/surface_layout.hpp"
#include "pipeline/surface_info.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pipeline {

/// Index into Frame::surfaces.
using SurfaceId = std::uint32_t;
inline constexpr SurfaceId no_surface = ~SurfaceId{0};

inline constexpr std::uint32_t target_pixel_bytes = 16; ///< of a pixel of a k-buffer's render target

/// A texel of a surface. With several planes, `row` counts through them: plane_rows() rows from one to the next.
struct SurfacePlace {
    std::uint32_t x = 0, row = 0;
    std::uint32_t level = 0;
};

/// What a surface takes of the memory.
struct SurfaceMemory {
    std::uint64_t nominal = 0;    ///< bytes, were all of it written
    std::uint64_t allocated = 0;  ///< bytes of the pages that something wrote to
    std::uint64_t high_water = 0; ///< the largest value of `allocated` so far
};

/// The bytes of all surfaces. Different pages may be written by different threads at the same time. Copies share pages
/// until one of them writes.
class SurfaceStore {
  public:
    static constexpr std::uint32_t page_size = PageGrid::page_size; ///< pixels along a side

    SurfaceStore() = default;
    /// Surfaces hold their contents, or their cleared value. Addresses begin at `first_address`, each level at a
    /// multiple of 256.
    explicit SurfaceStore(std::span<const SurfaceInfo> surfaces, std::uint64_t first_address = 0,
                          Fp16Overflow fp16_overflow = Fp16Overflow::saturate);

    /// How the GPU that they belong to stores 16-bit floats.
    Fp16Overflow fp16_overflow() const { return fp16_overflow_; }
    std::size_t count() const { return surfaces_.size(); }
    const SurfaceInfo& info(SurfaceId surface) const { return surfaces_[surface].info; }

    /// The texel to be written; allocates its page.
    std::byte* written(SurfaceId surface, SurfacePlace place) {
        const Level& level = surfaces_[surface].levels[place.level];
        const PageGrid::Place at = level.grid.find(place.x, place.row);
        SurfacePage& page = surfaces_[surface].levels[place.level].pages[at.page];
        if (page.use_count() != 1) page = own_page(surfaces_[surface], page.get());
        return page.get() + std::size_t{at.texel} * surfaces_[surface].texel_bytes;
    }
    /// The texel as it is, a cleared one where nothing was written.
    const std::byte* read(SurfaceId surface, SurfacePlace place) const {
        const Surface& of = surfaces_[surface];
        const Level& level = of.levels[place.level];
        const PageGrid::Place at = level.grid.find(place.x, place.row);
        const std::byte* page = level.pages[at.page].get();
        return page != nullptr ? page + std::size_t{at.texel} * of.texel_bytes : of.cleared.data();
    }

    /// A pixel of a k-buffer: its program's floats.
    const float* entries(SurfaceId kbuffer, SurfacePlace place) const {
        return reinterpret_cast<const float*>(read(kbuffer, place)); // pages hold whole pixels
    }
    float* written_entries(SurfaceId kbuffer, SurfacePlace place) {
        return reinterpret_cast<float*>(written(kbuffer, place));
    }

    /// Sets every texel to the cleared value and gives the pages back.
    void clear(SurfaceId surface);
    /// Takes the content that the same surface has in `other`.
    void share(const SurfaceStore& other, SurfaceId surface);
    /// Those that reports show, and nothing else.
    SurfaceStore shown() const;
    /// Hash of all its bytes; that of a page that nothing was written to and of one that holds the same are equal.
    std::uint64_t digest(SurfaceId surface) const;
    /// Places of level 0 at which both hold different bytes.
    std::uint64_t differences(const SurfaceStore& other, SurfaceId surface) const;
    /// Whether both hold the same bytes there.
    bool same(const SurfaceStore& other, SurfaceId surface, SurfacePlace place) const;

    /// Rows of all planes of a level.
    std::uint32_t rows(SurfaceId surface, std::uint32_t level = 0) const {
        return surfaces_[surface].levels[level].grid.rows;
    }
    /// Texels of level 0 that lie in memory: those of all rows.
    std::size_t places(SurfaceId surface) const { return std::size_t{info(surface).width} * rows(surface); }
    /// Byte address of a texel in GPU memory: tiles of 4x4 pixels in row order, 2x2 blocks within. A block of a
    /// k-buffer holds one render target (16 bytes a pixel) after the other; texels of a compressed tile have one
    /// address.
    std::uint64_t address(SurfaceId surface, SurfacePlace place, std::uint32_t target = 0) const;
    /// Behind the last byte of all its planes and levels.
    std::uint64_t end_of(SurfaceId surface) const;
    /// Behind the last surface.
    std::uint64_t end_address() const { return end_address_; }

    SurfaceMemory memory(SurfaceId surface) const;

  private:
    struct Level {
        PageGrid grid;
        std::uint64_t address = 0, bytes = 0; ///< of all its tiles
        std::vector<SurfacePage> pages;       ///< cleared ones are null
    };
    struct Surface {
        SurfaceInfo info;
        std::uint32_t texel_bytes = 0, tile_bytes = 0;
        std::vector<std::byte> cleared; ///< one texel
        std::vector<Level> levels;
        std::uint64_t high_water = 0;
    };
    static SurfacePage own_page(const Surface& surface, const std::byte* content);
    static std::uint64_t allocated(const Surface& surface);

    std::vector<Surface> surfaces_;
    std::uint64_t end_address_ = 0;
    Fp16Overflow fp16_overflow_ = Fp16Overflow::saturate;
};

} // namespace pipeline
