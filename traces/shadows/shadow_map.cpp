#include "traces/shadows/shadow_map.hpp"

#include "pipeline/functional/number_formats.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace traces {

namespace {

constexpr float largest_half = 65504.0F;

} // namespace

float through_shadow_format(ShadowFormat format, float value) {
    if (format == ShadowFormat::rgba32f) return value;
    return pipeline::half_to_float(pipeline::float_to_half(std::clamp(value, -largest_half, largest_half)));
}

float shadow_sentinel(ShadowFormat format) { return format == ShadowFormat::rgba16f ? largest_half : 1e30F; }

ShadowLayers::ShadowLayers(const AreaLight& light, const ShadowMapOptions& options)
    : options_(options),
      window_(light.view(options.resolution).projection),
      sentinel_(shadow_sentinel(options.format)) {
    CHECK(std::has_single_bit(options.resolution) && options.layers >= 1 && options.layers <= options.captured &&
          options.captured <= most);
}

float ShadowLayers::distance(float window) const {
    const bool surface = window >= 0.0F && window <= 1.0F;
    return surface ? static_cast<float>(window_.distance(window)) : sentinel_;
}

float ShadowLayers::stored(float distance) const {
    return through_shadow_format(options_.format, std::min(distance, sentinel_));
}

// Eq. 5.2, of depths as they were before the format rounded them. A neighbour without a surface says nothing about the
// slope of this one.
float ShadowLayers::slope(float here, float right, float below) const {
    if (here >= sentinel_) return 0.0F;
    float steepest = 0.0F;
    for (const float next : {right, below})
        if (next < sentinel_) steepest = std::max(steepest, std::abs(next - here));
    const float bias = options_.gscale * steepest;
    const float bounded = std::min(bias, options_.gmax > 0.0F ? options_.gmax : sentinel_); // finite, however steep
    return through_shadow_format(options_.format, bounded);
}

float ShadowLayers::bias(const LayeredTexel& texel, std::uint32_t layer) const {
    float bias = 0.0F;
    const bool last = layer + 1 == options_.captured;
    const float* depth = texel.depths + layer;
    switch (options_.bias) {
    case ShadowBias::none:
        break;
    case ShadowBias::uniform:
        bias = options_.uniform_bias;
        break;
    case ShadowBias::midpoint: // the last captured layer has no successor
        bias = last ? 0.0F : (depth[1] - depth[0]) / 2.0F;
        break;
    case ShadowBias::second_depth:
        bias = last ? 0.0F : depth[1] - depth[0];
        break;
    }
    // Layers that a torn read left unsorted would shadow themselves and what lies in front of them.
    bias = std::max(bias, 0.0F);
    return texel.slopes == nullptr ? bias : std::max(bias, texel.slopes[layer]);
}

std::uint32_t hierarchy_levels(std::uint32_t resolution) {
    return static_cast<std::uint32_t>(std::bit_width(resolution));
}

float least_of(const std::array<float, 4>& finer) {
    return std::min(std::min(finer[0], finer[1]), std::min(finer[2], finer[3]));
}

std::array<glm::ivec2, 4> texels_around(std::uint32_t resolution, std::uint32_t level, float u, float v) {
    const auto last = static_cast<int>(resolution >> level) - 1;
    const float texel = static_cast<float>(1U << level);
    const auto left = static_cast<int>(std::floor(u / texel - 0.5F)),
               top = static_cast<int>(std::floor(v / texel - 0.5F));
    std::array<glm::ivec2, 4> around;
    for (int i = 0; i < 4; ++i)
        around[static_cast<std::size_t>(i)] = {std::clamp(left + i % 2, 0, last), std::clamp(top + i / 2, 0, last)};
    return around;
}

ShadowMap::ShadowMap(const AreaLight& light, std::span<const float> kbuffer, std::size_t floats_per_texel,
                     const ShadowMapOptions& options)
    : light_(light), layers_(light, options) {
    const std::size_t texels = std::size_t{options.resolution} * options.resolution;
    CHECK(kbuffer.size() == texels * floats_per_texel && options.captured <= floats_per_texel);
    std::vector<float> distances(texels * options.captured);
    depths_.resize(distances.size());
    for (std::size_t i = 0; i < distances.size(); ++i) {
        distances[i] = layers_.distance(kbuffer[i / options.captured * floats_per_texel + i % options.captured]);
        depths_[i] = layers_.stored(distances[i]);
    }
    if (options.gscale > 0.0F) keep_slopes(distances);
    if (options.hierarchy) build_hierarchy();
}

LayeredTexel ShadowMap::texel(int x, int y) const {
    const auto r = static_cast<int>(options().resolution);
    if (x < 0 || y < 0 || x >= r || y >= r) return {};
    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(r) + static_cast<std::size_t>(x);
    return {depths_.data() + at * options().captured, slopes_.empty() ? nullptr : &slopes_[at * options().layers]};
}

void ShadowMap::keep_slopes(std::span<const float> distances) {
    const std::uint32_t r = options().resolution;
    const auto at = [&](std::uint32_t x, std::uint32_t y, std::uint32_t layer) {
        return distances[(std::size_t{y} * r + x) * options().captured + layer];
    };
    slopes_.reserve(std::size_t{r} * r * options().layers);
    for (std::uint32_t y = 0; y < r; ++y)
        for (std::uint32_t x = 0; x < r; ++x)
            for (std::uint32_t layer = 0; layer < options().layers; ++layer)
                slopes_.push_back(layers_.slope(at(x, y, layer), at(std::min(x + 1, r - 1), y, layer),
                                                at(x, std::min(y + 1, r - 1), layer)));
}

void ShadowMap::build_hierarchy() {
    std::uint32_t size = options().resolution;
    least_.emplace_back(std::size_t{size} * size);
    for (std::size_t i = 0; i < least_[0].size(); ++i) least_[0][i] = depths_[i * options().captured];
    for (; size > 1; size /= 2) {
        const std::vector<float>& finer = least_.back();
        std::vector<float> coarser(std::size_t{size / 2} * (size / 2));
        for (std::uint32_t y = 0; y < size / 2; ++y)
            for (std::uint32_t x = 0; x < size / 2; ++x) {
                const float* upper = finer.data() + std::size_t{2} * y * size + std::size_t{2} * x;
                coarser[std::size_t{y} * (size / 2) + x] = least_of({upper[0], upper[1], upper[size], upper[size + 1]});
            }
        least_.push_back(std::move(coarser));
    }
}

float ShadowMap::least(std::uint32_t level, float u, float v) const {
    CHECK(level < least_.size());
    const std::size_t size = options().resolution >> level;
    std::array<float, 4> around{};
    const auto places = texels_around(options().resolution, level, u, v);
    for (std::size_t i = 0; i < 4; ++i)
        around[i] = least_[level][static_cast<std::size_t>(places[i].y) * size + static_cast<std::size_t>(places[i].x)];
    return least_of(around);
}

} // namespace traces
