// What a surface is: its format and size, how its levels are cut into pages, and what it holds when the frame begins.
#pragma once

#include "pipeline/output/kbuffer.hpp"
#include "pipeline/sample_planes.hpp"
#include "pipeline/shared_bytes.hpp"
#include "pipeline/surface_format.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pipeline {

/// How reports make a picture of a channel of a surface.
struct SurfacePicture {
    std::string name; ///< a file's, without its ending
    std::string title;
    std::uint32_t channel = 0;
    float low = 0.0F, high = 1.0F; ///< what is shown as black and as white
};

enum class SurfaceShape : std::uint8_t {
    planes, ///< as many on each level
    volume, ///< slices, which halve with the levels, too
    row     ///< a buffer: one row of any length, whose texels lie one behind the other
};

struct SurfaceContents;

struct SurfaceInfo {
    std::string name;
    SurfaceFormat format = SurfaceFormat::rgba8; ///< of a texel; a k-buffer's is its program's pixel
    std::uint32_t width = 1, height = 1;         ///< of one plane of level 0
    std::uint32_t planes = 1;                    ///< of a volume: on level 0
    std::uint32_t levels = 1;
    /// What a clear stores, in the format's bytes; a k-buffer takes its program's.
    std::array<std::byte, largest_texel> cleared{};
    std::shared_ptr<const ModifyProgram> program{}; ///< makes it a k-buffer
    bool kept = false;                              ///< lives on in the next frame
    std::vector<SurfacePicture> shown{};
    SurfaceShape shape = SurfaceShape::planes;
    std::shared_ptr<const SurfaceContents> contents{}; ///< before the first pass; null: the cleared value

    /// As the store holds it; that of a compressed format is decoded.
    std::uint32_t texel_bytes() const { return program ? program->bytes_per_pixel() : bytes_of(format); }
    bool compressed() const { return program == nullptr && is_compressed(format); }
    /// Of 4x4 texels in GPU memory.
    std::uint32_t tile_bytes() const { return compressed() ? block_bytes_of(format) : 16 * texel_bytes(); }
    std::uint32_t width_of(std::uint32_t level) const { return std::max(1U, width >> level); }
    std::uint32_t height_of(std::uint32_t level) const { return std::max(1U, height >> level); }
    std::uint32_t planes_of(std::uint32_t level) const {
        return shape == SurfaceShape::volume ? std::max(1U, planes >> level) : planes;
    }
    /// Rows from one plane of a level to the next.
    std::uint32_t rows_between_planes(std::uint32_t level) const { return plane_rows(height_of(level), planes); }
    /// Of all planes and levels.
    std::uint64_t nominal_bytes() const;
};

/// How a level is cut into pages of 256 texels: 16x16, of a row one behind the other.
struct PageGrid {
    static constexpr std::uint32_t page_size = 16;
    static constexpr std::uint32_t page_texels = page_size * page_size;

    struct Place {
        std::size_t page = 0;
        std::uint32_t texel = 0; ///< within it
    };

    PageGrid() = default;
    PageGrid(const SurfaceInfo& info, std::uint32_t level)
        : width(info.width_of(level)),
          rows(info.planes_of(level) * info.rows_between_planes(level)),
          pages_in_row((width + page_size - 1) / page_size),
          row(info.shape == SurfaceShape::row) {}

    std::size_t pages() const {
        if (row) return (std::size_t{width} + page_texels - 1) / page_texels;
        return std::size_t{pages_in_row} * ((rows + page_size - 1) / page_size);
    }
    Place find(std::uint32_t x, std::uint32_t y) const {
        if (row) return {x / page_texels, x % page_texels};
        return {std::size_t{y / page_size} * pages_in_row + x / page_size, y % page_size * page_size + x % page_size};
    }

    std::uint32_t width = 0, rows = 0; ///< rows of all planes
    std::uint32_t pages_in_row = 0;
    bool row = false;
};

using SurfacePage = std::shared_ptr<std::byte[]>;

/// A page whose texels all hold `texel`.
SurfacePage make_page(const std::byte* texel, std::uint32_t texel_bytes);

/// Pages that all stores of the surface share until they write to them.
struct SurfaceContents {
    std::vector<std::vector<SurfacePage>> levels; ///< null: the cleared value
};

/// `levels`: bytes of a level's planes, of their rows, of their texels, without gaps; of compressed formats those of
/// the 4x4 blocks in their place. A level without bytes holds 0. Throws the sim::InputError that names the surface when
/// there are more levels than it has, or a level has another number of bytes.
std::shared_ptr<const SurfaceContents> make_contents(const SurfaceInfo& info, const std::vector<SharedBytes>& levels);

} // namespace pipeline
