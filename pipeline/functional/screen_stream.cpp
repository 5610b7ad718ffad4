#include "pipeline/functional/screen_stream.hpp"

#include <algorithm>
#include <bit>

namespace pipeline {

namespace {

constexpr std::uint32_t raster_tile = 8;

void add_tile(FragmentStream& stream, std::uint32_t left, std::uint32_t top) {
    for (std::uint32_t y = top; y < std::min(top + raster_tile, stream.height); y += 2)
        for (std::uint32_t x = left; x < std::min(left + raster_tile, stream.width); x += 2) {
            Quad quad;
            quad.x = static_cast<std::uint16_t>(x);
            quad.y = static_cast<std::uint16_t>(y);
            const unsigned row = x + 1 < stream.width ? 3U : 1U;
            quad.covered = static_cast<std::uint8_t>(y + 1 < stream.height ? row | row << 2U : row);
            quad.alive = quad.covered;
            stream.quads.own().push_back(quad);
        }
}

} // namespace

FragmentStream screen_stream(std::uint32_t width, std::uint32_t height, std::uint32_t draw) {
    FragmentStream stream;
    stream.width = width;
    stream.height = height;
    std::uint32_t tiles = 0;
    for (std::uint32_t top = 0; top < height; top += raster_tile)
        for (std::uint32_t left = 0; left < width; left += raster_tile, ++tiles) add_tile(stream, left, top);
    const auto quads = static_cast<std::uint32_t>(stream.quads.size());
    stream.depths.own().resize(quads);
    stream.fragments = std::uint64_t{width} * height;
    stream.triangles = {{.draw = draw, .primitive = 0, .first_quad = 0, .quads = quads, .tiles = tiles}};
    stream.primitives = {{.first_triangle = 0, .triangles = 1}};
    stream.draws = {{.draw = draw, .primitives = 1, .quads = quads}};
    return stream;
}

} // namespace pipeline
