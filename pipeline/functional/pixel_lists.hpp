// The fragments of a stream sorted by pixel: which quads touch a pixel, in raster order.
#pragma once

#include "pipeline/fragment_stream.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pipeline {

/// Quads binned by screen tile. Tiles do not share pixels, so they can be worked on at the same time.
class TileLists {
  public:
    static constexpr std::uint32_t tile_width = 16; ///< pixels

    explicit TileLists(const FragmentStream& stream);

    std::size_t count() const { return begin_.size() - 1; }

    /// Calls visit(x, y, quads) for every pixel of a tile that an alive fragment touches; `quads` are those in raster
    /// order.
    template <class Visit>
    void for_each_pixel(std::size_t tile, Visit&& visit) const {
        const PixelLists lists(*this, tile);
        for (std::uint32_t pixel = 0; pixel < tile_width * tile_width; ++pixel)
            if (!lists.of(pixel).empty())
                visit(lists.x + pixel % tile_width, lists.y + pixel / tile_width, lists.of(pixel));
    }

  private:
    struct PixelLists {
        PixelLists(const TileLists& tiles, std::size_t tile);
        std::span<const QuadId> of(std::uint32_t pixel) const {
            return {quads.data() + begin[pixel], quads.data() + begin[pixel + 1]};
        }
        std::uint32_t x, y; ///< of the tile's first pixel
        std::array<std::uint32_t, tile_width * tile_width + 1> begin{};
        std::vector<QuadId> quads;
    };

    const FragmentStream& stream_;
    std::uint32_t tiles_in_row_;
    std::vector<QuadId> begin_; ///< of each tile's quads in quads_, and the end
    std::vector<QuadId> quads_;
};

} // namespace pipeline
