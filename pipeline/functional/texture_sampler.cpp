#include "pipeline/functional/texture_sampler.hpp"

#include "pipeline/functional/number_formats.hpp"

#include <algorithm>
#include <cmath>

namespace pipeline {

namespace {

/// Largest integer not above `value`, |value| < 2^31.
std::int32_t floor_of(float value) {
    const auto truncated = static_cast<std::int32_t>(value);
    return truncated - (value < static_cast<float>(truncated) ? 1 : 0);
}

/// value - floor(value), in [0,1]; 1 only for a negative value that rounds up to it.
float fraction(float value) {
    if (!(std::fabs(value) < 0x1p23F)) return 0.0F; // has no fraction bits
    return value - static_cast<float>(floor_of(value));
}

/// Maps a coordinate to [0,1].
float wrapped(Wrap wrap, float value) {
    switch (wrap) {
    case Wrap::clamp:
        return std::clamp(value, 0.0F, 1.0F);
    case Wrap::mirror: {
        const float phase = 2.0F * fraction(value * 0.5F);
        return phase > 1.0F ? 2.0F - phase : phase;
    }
    case Wrap::repeat:
        break;
    }
    return fraction(value);
}

/// Brings a texel index that is at most one texel outside back in.
std::int32_t wrapped_texel(Wrap wrap, std::int32_t index, std::int32_t size) {
    if (wrap == Wrap::repeat) {
        if (index < 0) return index + size;
        return index >= size ? index - size : index;
    }
    return std::clamp(index, 0, size - 1); // a mirror repeats its last texel
}

std::int32_t nearest_texel(Wrap wrap, float coordinate, std::uint32_t size) {
    const std::int32_t index = floor_of(coordinate * static_cast<float>(size));
    return wrapped_texel(wrap, index, static_cast<std::int32_t>(size));
}

/// Exactly `a` where both are equal: an image of one colour stays one, whatever the weights.
glm::vec4 between(const glm::vec4& a, const glm::vec4& b, float t) { return a + (b - a) * t; }

} // namespace

TextureSampler::TextureSampler(const Texture& texture)
    : texture_(texture),
      decode_(texture.srgb ? srgb_decode_table() : unorm8_decode_table()),
      alpha_(unorm8_decode_table()) {}

float TextureSampler::level_of_detail(const std::array<glm::vec2, 4>& coordinates) const {
    const auto width = static_cast<double>(texture_.levels.front().width);
    const auto height = static_cast<double>(texture_.levels.front().height);
    const auto squared = [&](const glm::vec2& to) {
        const double du = (static_cast<double>(to.x) - static_cast<double>(coordinates[0].x)) * width;
        const double dv = (static_cast<double>(to.y) - static_cast<double>(coordinates[0].y)) * height;
        return du * du + dv * dv;
    };
    const double texels = std::max(squared(coordinates[1]), squared(coordinates[2]));
    if (!(texels > 1.0)) return 0.0F;
    const auto last = static_cast<double>(texture_.levels.size() - 1);
    // Above 0 in any case: the minification filter applies however small the excess.
    return std::max(static_cast<float>(std::min(0.5 * std::log2(texels), last)), 0x1p-24F);
}

TextureSampler::Footprint TextureSampler::footprint(float level_of_detail) const {
    if (level_of_detail <= 0.0F) return {0, 0.0F, texture_.mag_filter != Filter::nearest};
    const std::size_t last = texture_.levels.size() - 1;
    const Filter filter = texture_.min_filter;
    const bool linear =
        filter == Filter::linear || filter == Filter::linear_mip_nearest || filter == Filter::linear_mip_linear;
    if (filter == Filter::nearest || filter == Filter::linear) return {0, 0.0F, linear};
    if (filter == Filter::nearest_mip_nearest || filter == Filter::linear_mip_nearest) {
        const auto level = static_cast<std::size_t>(std::ceil(level_of_detail + 0.5F) - 1.0F); // halves go down
        return {std::min(level, last), 0.0F, linear};
    }
    const float floor = std::floor(level_of_detail);
    const auto level = static_cast<std::size_t>(floor);
    if (level >= last) return {last, 0.0F, linear};
    return {level, level_of_detail - floor, linear};
}

glm::vec4 TextureSampler::texel(const Texture::Level& level, std::int32_t x, std::int32_t y) const {
    const std::uint8_t* code =
        level.rgba.data() + (static_cast<std::size_t>(y) * level.width + static_cast<std::size_t>(x)) * 4;
    return {decode_[code[0]], decode_[code[1]], decode_[code[2]], alpha_[code[3]]};
}

glm::vec4 TextureSampler::nearest(const Texture::Level& level, const glm::vec2& wrapped) const {
    return texel(level, nearest_texel(texture_.wrap_u, wrapped.x, level.width),
                 nearest_texel(texture_.wrap_v, wrapped.y, level.height));
}

glm::vec4 TextureSampler::bilinear(const Texture::Level& level, const glm::vec2& wrapped) const {
    const auto width = static_cast<std::int32_t>(level.width);
    const auto height = static_cast<std::int32_t>(level.height);
    const float u = wrapped.x * static_cast<float>(width) - 0.5F;
    const float v = wrapped.y * static_cast<float>(height) - 0.5F;
    const std::int32_t x = floor_of(u), y = floor_of(v);
    const float right = u - static_cast<float>(x), below = v - static_cast<float>(y);
    const std::int32_t x0 = wrapped_texel(texture_.wrap_u, x, width), x1 = wrapped_texel(texture_.wrap_u, x + 1, width);
    const std::int32_t y0 = wrapped_texel(texture_.wrap_v, y, height);
    const std::int32_t y1 = wrapped_texel(texture_.wrap_v, y + 1, height);
    const glm::vec4 top = between(texel(level, x0, y0), texel(level, x1, y0), right);
    const glm::vec4 bottom = between(texel(level, x0, y1), texel(level, x1, y1), right);
    return between(top, bottom, below);
}

glm::vec4 TextureSampler::filtered(std::size_t level, bool linear, const glm::vec2& wrapped) const {
    const Texture::Level& image = texture_.levels[level];
    return linear ? bilinear(image, wrapped) : nearest(image, wrapped);
}

glm::vec4 TextureSampler::sample(const glm::vec2& coordinates, float level_of_detail) const {
    const Footprint reads = footprint(level_of_detail);
    const glm::vec2 place(wrapped(texture_.wrap_u, coordinates.x), wrapped(texture_.wrap_v, coordinates.y));
    const glm::vec4 fine = filtered(reads.level, reads.linear, place);
    if (reads.blend == 0.0F) return fine;
    return between(fine, filtered(reads.level + 1, reads.linear, place), reads.blend);
}

std::uint32_t TextureSampler::line(const glm::vec2& coordinates, float level_of_detail) const {
    const Texture::Level& level = texture_.levels[footprint(level_of_detail).level];
    const std::int32_t x = nearest_texel(texture_.wrap_u, wrapped(texture_.wrap_u, coordinates.x), level.width);
    const std::int32_t y = nearest_texel(texture_.wrap_v, wrapped(texture_.wrap_v, coordinates.y), level.height);
    const std::uint64_t tiles_in_row = (std::uint64_t{level.width} + 3) / 4;
    const std::uint64_t tile = static_cast<std::uint64_t>(y / 4) * tiles_in_row + static_cast<std::uint64_t>(x / 4);
    return static_cast<std::uint32_t>(level.address / 64 + tile);
}

} // namespace pipeline
