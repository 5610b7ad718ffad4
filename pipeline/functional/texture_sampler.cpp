#include "pipeline/functional/texture_sampler.hpp"

#include "pipeline/functional/number_formats.hpp"
#include "pipeline/functional/texture_addressing.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pipeline {

namespace {

/// The texel that the coordinate itself lies in; beside a border, the nearest one inside.
std::uint64_t nearest(const AxisReads& reads, bool linear, std::size_t pixel, std::uint32_t size) {
    const std::int32_t texel = linear && reads.share[pixel] >= 0.5F ? reads.high[pixel] : reads.low[pixel];
    return static_cast<std::uint64_t>(std::clamp(texel, 0, static_cast<std::int32_t>(size) - 1));
}

bool beyond(const Texture::Level& image, std::int32_t column, std::int32_t row) {
    return column < 0 || row < 0 || column >= static_cast<std::int32_t>(image.width) ||
           row >= static_cast<std::int32_t>(image.height);
}

/// Exactly `a` where both are equal: an image of one colour stays one, whatever the weights.
Lanes between(Lanes a, Lanes b, float t) {
    Lanes result;
    for (std::size_t i = 0; i < 4; ++i) result[i] = a[i] + (b[i] - a[i]) * t;
    return result;
}

/// Number of the 64-byte line of a texel.
std::uint32_t line_of(const Texture::Level& level, std::uint64_t column, std::uint64_t row) {
    const std::uint64_t tiles_in_row = (std::uint64_t{level.width} + 3) / 4;
    return static_cast<std::uint32_t>(level.address / 64 + row / 4 * tiles_in_row + column / 4);
}

} // namespace

TextureSampler::TextureSampler(const Texture& texture)
    : texture_(texture),
      colour_((texture.srgb ? srgb_decode_table() : unorm8_decode_table()).data()),
      alpha_(unorm8_decode_table().data()),
      bordered_(texture.wrap_u == Wrap::border || texture.wrap_v == Wrap::border) {}

float TextureSampler::level_of_detail(const QuadTexcoords& coordinates) const {
    const auto width = static_cast<double>(texture_.levels.front().width);
    const auto height = static_cast<double>(texture_.levels.front().height);
    const auto squared_distance_to = [&](std::size_t pixel) {
        const double du = (static_cast<double>(coordinates.u[pixel]) - static_cast<double>(coordinates.u[0])) * width;
        const double dv = (static_cast<double>(coordinates.v[pixel]) - static_cast<double>(coordinates.v[0])) * height;
        return du * du + dv * dv;
    };
    const double texels = std::max(squared_distance_to(1), squared_distance_to(2));
    if (!(texels > 1.0)) return 0.0F;
    const auto last = static_cast<double>(texture_.levels.size() - 1);
    // Above 0 in any case: the minification filter applies however small the excess.
    return std::max(static_cast<float>(std::min(0.5 * std::log2(texels), last)), 0x1p-24F);
}

TextureFootprint TextureSampler::footprint(float level_of_detail) const {
    if (level_of_detail <= 0.0F) return {0, 0.0F, texture_.mag_filter != Filter::nearest};
    const auto last = static_cast<std::uint32_t>(texture_.levels.size() - 1);
    const Filter filter = texture_.min_filter;
    const bool linear =
        filter == Filter::linear || filter == Filter::linear_mip_nearest || filter == Filter::linear_mip_linear;
    if (filter == Filter::nearest || filter == Filter::linear) return {0, 0.0F, linear};
    const auto floor = static_cast<std::uint32_t>(level_of_detail);
    const float above = level_of_detail - static_cast<float>(floor);
    if (filter == Filter::nearest_mip_nearest || filter == Filter::linear_mip_nearest)
        return {std::min(above > 0.5F ? floor + 1 : floor, last), 0.0F, linear}; // halves go down
    if (floor >= last) return {last, 0.0F, linear};
    return {floor, above, linear};
}

std::uint32_t TextureSampler::filter(std::uint32_t level, bool linear, const QuadTexcoords& wrapped, unsigned pixels,
                                     std::array<Lanes, 4>& colours) const {
    const Texture::Level& image = texture_.levels[level];
    const AxisReads x = reads_along(texture_.wrap_u, linear, wrapped.u, image.width);
    const AxisReads y = reads_along(texture_.wrap_v, linear, wrapped.v, image.height);
    for (std::size_t i = 0; i < 4; ++i) {
        if (((pixels >> i) & 1U) == 0) continue;
        const auto at = [&](std::int32_t column, std::int32_t row) {
            if (bordered_ && beyond(image, column, row))
                return Lanes{texture_.border.r, texture_.border.g, texture_.border.b, texture_.border.a};
            const std::size_t index = static_cast<std::size_t>(row) * image.width + static_cast<std::size_t>(column);
            return texel(image.rgba.data() + index * 4);
        };
        colours[i] = at(x.low[i], y.low[i]);
        if (!linear) continue;
        const Lanes top = between(colours[i], at(x.high[i], y.low[i]), x.share[i]);
        const Lanes bottom = between(at(x.low[i], y.high[i]), at(x.high[i], y.high[i]), x.share[i]);
        colours[i] = between(top, bottom, y.share[i]);
    }
    const auto first = static_cast<std::size_t>(std::countr_zero(pixels));
    return line_of(image, nearest(x, linear, first, image.width), nearest(y, linear, first, image.height));
}

std::uint32_t TextureSampler::sample(const QuadTexcoords& coordinates, const TextureFootprint& footprint,
                                     unsigned pixels, std::array<glm::vec4, 4>& colours) const {
    const QuadTexcoords place{wrapped(texture_.wrap_u, coordinates.u), wrapped(texture_.wrap_v, coordinates.v)};
    std::array<Lanes, 4> fine, coarse;
    const std::uint32_t line = filter(footprint.level, footprint.linear, place, pixels, fine);
    const bool two_levels = footprint.blend != 0.0F;
    if (two_levels) filter(footprint.level + 1, footprint.linear, place, pixels, coarse);
    for (std::size_t i = 0; i < 4; ++i) {
        if (((pixels >> i) & 1U) == 0) continue;
        const Lanes c = two_levels ? between(fine[i], coarse[i], footprint.blend) : fine[i];
        colours[i] = glm::vec4(c[0], c[1], c[2], c[3]);
    }
    return line;
}

} // namespace pipeline
