// The walk over the tiles of a triangle for pixels of several samples: each sample is rasterized like a pixel centre,
// by the same edge functions, and what the samples of a quad cover is put together.
#pragma once

#include "pipeline/functional/raster_triangle.hpp"

namespace pipeline {
namespace detail {

class SampleWalk {
  public:
    SampleWalk(const std::array<ScreenVertex, 3>& corners, const Viewport& viewport, std::uint32_t samples) {
        for (const SampleOffset& offset : sample_pattern(samples))
            triangles_[samples_++] = set_up(corners[0], corners[1], corners[2], viewport, offset);
    }

    template <class Emit>
    std::uint32_t run(Emit& emit) {
        std::int32_t first_x = viewport_end, first_y = viewport_end, last_x = -1, last_y = -1;
        for (std::uint32_t sample = 0; sample < samples_; ++sample) {
            const RasterTriangle& t = triangles_[sample];
            if (t.first_x > t.last_x || t.first_y > t.last_y) continue; // between the samples of this kind
            first_x = std::min(first_x, t.first_x);
            first_y = std::min(first_y, t.first_y);
            last_x = std::max(last_x, t.last_x);
            last_y = std::max(last_y, t.last_y);
        }
        if (last_y < 0) return 1;
        std::uint32_t tiles = 0;
        for (std::int32_t row = first_y / tile_size; row <= last_y / tile_size; ++row)
            tiles += walk_row(first_x / tile_size, last_x / tile_size, row, emit);
        return std::max(tiles, 1U);
    }

  private:
    static constexpr std::int32_t viewport_end = largest_viewport;
    static constexpr std::size_t quads_across = tile_size / 2;

    /// What one sample covers of the tile at hand.
    struct Collect {
        std::array<std::uint32_t, quads_across * quads_across>* masks;
        std::uint32_t sample;
        void operator()(std::int32_t x, std::int32_t y, unsigned mask) const {
            const auto column = static_cast<std::size_t>(x % tile_size / 2),
                       row = static_cast<std::size_t>(y % tile_size / 2);
            (*masks)[row * quads_across + column] |= mask << 4 * sample;
        }
    };

    template <class Emit>
    std::uint32_t walk_row(std::int32_t left, std::int32_t right, std::int32_t row, Emit& emit) {
        std::array<TileSpan, most_samples> spans;
        TileSpan all{right - left + 1, -1};
        for (std::uint32_t sample = 0; sample < samples_; ++sample) {
            Collect collect{&masks_, sample};
            spans[sample] = TileWalk(triangles_[sample], collect).span(left, right, row);
            if (spans[sample].first > spans[sample].last) continue;
            all = {std::min(all.first, spans[sample].first), std::max(all.last, spans[sample].last)};
        }
        std::uint32_t tiles = 0;
        for (std::int64_t tile = all.first; tile <= all.last; ++tile)
            tiles += walk_tile(tile, left + static_cast<std::int32_t>(tile), row, spans, emit) ? 1U : 0U;
        return tiles;
    }

    template <class Emit>
    bool walk_tile(std::int64_t number, std::int32_t tile_x, std::int32_t tile_y,
                   const std::array<TileSpan, most_samples>& spans, Emit& emit) {
        bool visited = false;
        masks_ = {};
        for (std::uint32_t sample = 0; sample < samples_; ++sample) {
            if (number < spans[sample].first || number > spans[sample].last) continue;
            Collect collect{&masks_, sample};
            TileWalk(triangles_[sample], collect).walk_tile(tile_x, tile_y);
            visited = true;
        }
        for (std::size_t quad = 0; quad < masks_.size(); ++quad)
            if (masks_[quad] != 0)
                emit(tile_x * tile_size + static_cast<std::int32_t>(quad % quads_across) * 2,
                     tile_y * tile_size + static_cast<std::int32_t>(quad / quads_across) * 2, masks_[quad]);
        return visited;
    }

    std::array<RasterTriangle, most_samples> triangles_;
    std::uint32_t samples_ = 0;
    std::array<std::uint32_t, quads_across * quads_across> masks_{};
};

} // namespace detail

/// for_each_quad for pixels of 4 or 8 samples: emit(x, y, mask), where bit 4 * s + i says that sample s of pixel i is
/// covered. Returns the tiles that the coarse test rejects for some samples at most, at least 1.
template <class Emit>
std::uint32_t for_each_sampled_quad(const std::array<ScreenVertex, 3>& corners, const Viewport& viewport,
                                    std::uint32_t samples, Emit&& emit) {
    return detail::SampleWalk(corners, viewport, samples).run(emit);
}

} // namespace pipeline
