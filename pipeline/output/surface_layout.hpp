// How a surface is cut into the units that caches, ROPs and memory work on.
//
// A tile is 4x4 pixels and belongs to one ROP group (four ROPs); a block is one aligned 2x2 quad. Blocks are numbered
// tile by tile so that a tile is contiguous in memory. With several samples to a pixel the surface holds a plane for
// each (sample_planes.hpp): a tile is 4x4 pixels of one sample, and all samples of a pixel belong to one group.
#pragma once

#include "pipeline/sample_planes.hpp"

#include <cstdint>

namespace pipeline {

struct SurfaceLayout {
    static constexpr std::uint32_t tile_size = 4; ///< pixels along one side

    std::uint32_t width = 0, height = 0; ///< pixels
    std::uint32_t partitions = 1;        ///< ROP groups that share the surface
    std::uint32_t samples = 1;           ///< of a pixel

    std::uint32_t rows_of_plane() const { return plane_rows(height, samples); }
    std::uint32_t rows() const { return samples * rows_of_plane(); } ///< of all planes
    std::uint32_t pixel_row(std::uint32_t row) const { return samples == 1 ? row : row % rows_of_plane(); }
    bool inside(std::uint32_t x, std::uint32_t row) const { return x < width && pixel_row(row) < height; }

    std::uint32_t tiles_x() const { return (width + tile_size - 1) / tile_size; }
    std::uint32_t tiles_y() const { return (rows() + tile_size - 1) / tile_size; }
    std::uint32_t tiles() const { return tiles_x() * tiles_y(); }
    std::uint32_t blocks() const { return tiles() * 4; }

    std::uint32_t tile_of(std::uint32_t x, std::uint32_t y) const {
        return (y / tile_size) * tiles_x() + x / tile_size;
    }
    std::uint32_t block_of(std::uint32_t x, std::uint32_t y) const {
        return tile_of(x, y) * 4 + (y / 2 % 2) * 2 + x / 2 % 2;
    }
    static std::uint32_t tile_of_block(std::uint32_t block) { return block / 4; }

    /// Upper-left pixel of a block.
    std::uint32_t block_x(std::uint32_t block) const { return (block / 4 % tiles_x()) * tile_size + block % 2 * 2; }
    std::uint32_t block_y(std::uint32_t block) const { return (block / 4 / tiles_x()) * tile_size + block / 2 % 2 * 2; }
    /// Neighbouring tiles lie in different groups in both directions, if there is more than one.
    std::uint32_t partition_of_tile(std::uint32_t tile) const {
        const std::uint32_t row_step = partitions == 2 ? 1 : 2;
        const std::uint32_t row = pixel_row(tile / tiles_x() * tile_size) / tile_size;
        return (tile % tiles_x() + row_step * row) % partitions;
    }
    std::uint32_t partition_of(std::uint32_t x, std::uint32_t y) const { return partition_of_tile(tile_of(x, y)); }
};

} // namespace pipeline
