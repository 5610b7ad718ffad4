#include "pipeline/functional/pixel_lists.hpp"

namespace pipeline {

TileLists::TileLists(const FragmentStream& stream)
    : stream_(stream), tiles_in_row_((stream.width + tile_width - 1) / tile_width) {
    const std::size_t tiles = std::size_t{tiles_in_row_} * ((stream.rows() + tile_width - 1) / tile_width);
    const auto tile_of = [&](const Quad& quad) {
        return std::size_t{quad.y / tile_width} * tiles_in_row_ + quad.x / tile_width;
    };
    begin_.resize(tiles + 1);
    for (const Quad& quad : stream.quads)
        if (quad.alive != 0) ++begin_[tile_of(quad) + 1];
    for (std::size_t i = 0; i < tiles; ++i) begin_[i + 1] += begin_[i];
    quads_.resize(begin_[tiles]);
    std::vector<QuadId> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < stream.quads.size(); ++i)
        if (stream.quads[i].alive != 0) quads_[next[tile_of(stream.quads[i])]++] = static_cast<QuadId>(i);
}

TileLists::PixelLists::PixelLists(const TileLists& tiles, std::size_t tile)
    : x(static_cast<std::uint32_t>(tile % tiles.tiles_in_row_) * tile_width),
      y(static_cast<std::uint32_t>(tile / tiles.tiles_in_row_) * tile_width) {
    const std::span<const QuadId> mine(tiles.quads_.data() + tiles.begin_[tile],
                                       tiles.quads_.data() + tiles.begin_[tile + 1]);
    const auto visit = [&](auto&& use) {
        for (const QuadId id : mine) {
            const Quad& quad = tiles.stream_.quads[id];
            for (std::uint32_t lane = 0; lane < 4; ++lane)
                if (((quad.alive >> lane) & 1U) != 0)
                    use((quad.y - y + lane / 2) * tile_width + (quad.x - x + lane % 2), id);
        }
    };
    visit([&](std::uint32_t pixel, QuadId) { ++begin[pixel + 1]; });
    for (std::size_t pixel = 0; pixel + 1 < begin.size(); ++pixel) begin[pixel + 1] += begin[pixel];
    quads.resize(begin.back());
    auto next = begin;
    visit([&](std::uint32_t pixel, QuadId id) { quads[next[pixel]++] = id; });
}

} // namespace pipeline
