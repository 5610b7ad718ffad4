#include "traces/shadows/shadow_map.hpp"

#include "pipeline/functional/eye_depth.hpp"
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

ShadowMap::ShadowMap(const AreaLight& light, std::span<const float> kbuffer, std::size_t floats_per_texel,
                     const ShadowMapOptions& options)
    : light_(light), options_(options), sentinel_(shadow_sentinel(options.format)) {
    const std::size_t texels = std::size_t{options.resolution} * options.resolution;
    CHECK(std::has_single_bit(options.resolution) && options.layers >= 1 && options.layers <= options.captured);
    CHECK(kbuffer.size() == texels * floats_per_texel && options.captured <= floats_per_texel);
    const pipeline::EyeDepth distance(light.view(options.resolution).projection);
    std::vector<float> distances(texels * options.captured);
    depths_.resize(distances.size());
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const float window = kbuffer[i / options.captured * floats_per_texel + i % options.captured];
        const bool surface = window >= 0.0F && window <= 1.0F;
        distances[i] = surface ? static_cast<float>(distance.distance(window)) : sentinel_;
        depths_[i] = through_shadow_format(options.format, std::min(distances[i], sentinel_));
    }
    if (options.gscale > 0.0F) keep_slopes(distances);
    if (options.hierarchy) build_hierarchy();
}

// A22, Eq. 5.2: differences to the next texel on either axis, of depths as they were before the format rounded them. A
// neighbour without a surface says nothing about the slope of this one.
float ShadowMap::slope(std::span<const float> distances, std::uint32_t layer, std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t r = options_.resolution;
    const auto at = [&](std::uint32_t column, std::uint32_t row) {
        return distances[(std::size_t{row} * r + column) * options_.captured + layer];
    };
    const float here = at(x, y);
    if (here >= sentinel_) return 0.0F;
    float steepest = 0.0F;
    for (const float next : {at(x + 1 < r ? x + 1 : x, y), at(x, y + 1 < r ? y + 1 : y)})
        if (next < sentinel_) steepest = std::max(steepest, std::abs(next - here));
    const float bias = options_.gscale * steepest;
    return std::min(bias, options_.gmax > 0.0F ? options_.gmax : sentinel_); // finite, however steep
}

void ShadowMap::keep_slopes(std::span<const float> distances) {
    const std::uint32_t r = options_.resolution;
    slopes_.reserve(std::size_t{r} * r * options_.layers);
    for (std::uint32_t y = 0; y < r; ++y)
        for (std::uint32_t x = 0; x < r; ++x)
            for (std::uint32_t layer = 0; layer < options_.layers; ++layer)
                slopes_.push_back(through_shadow_format(options_.format, slope(distances, layer, x, y)));
}

float ShadowMap::bias(std::uint32_t layer, int x, int y) const {
    const std::size_t at = texel(x, y);
    float bias = 0.0F;
    const bool last = layer + 1 == options_.captured;
    const float* depth = depths_.data() + at * options_.captured + layer;
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
    return slopes_.empty() ? bias : std::max(bias, slopes_[at * options_.layers + layer]);
}

void ShadowMap::build_hierarchy() {
    std::uint32_t size = options_.resolution;
    least_.emplace_back(std::size_t{size} * size);
    for (std::size_t i = 0; i < least_[0].size(); ++i) least_[0][i] = depths_[i * options_.captured];
    for (; size > 1; size /= 2) {
        const std::vector<float>& finer = least_.back();
        std::vector<float> coarser(std::size_t{size / 2} * (size / 2));
        for (std::uint32_t y = 0; y < size / 2; ++y)
            for (std::uint32_t x = 0; x < size / 2; ++x) {
                const float* upper = finer.data() + std::size_t{2} * y * size + std::size_t{2} * x;
                coarser[std::size_t{y} * (size / 2) + x] =
                    std::min(std::min(upper[0], upper[1]), std::min(upper[size], upper[size + 1]));
            }
        least_.push_back(std::move(coarser));
    }
}

float ShadowMap::least(std::uint32_t level, float u, float v) const {
    CHECK(level < least_.size());
    const auto size = static_cast<int>(options_.resolution >> level);
    const float texel = static_cast<float>(1U << level);
    // The four whose centres surround the place; the border's texels repeat.
    const auto left = static_cast<int>(std::floor(u / texel - 0.5F)),
               top = static_cast<int>(std::floor(v / texel - 0.5F));
    float least = sentinel_;
    for (int i = 0; i < 4; ++i) {
        const int x = std::clamp(left + i % 2, 0, size - 1), y = std::clamp(top + i / 2, 0, size - 1);
        least = std::min(
            least,
            least_[level][static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x)]);
    }
    return least;
}

std::array<float, 2> ShadowMap::range() const {
    std::array<float, 2> range{INFINITY, -INFINITY};
    for (const float depth : depths_)
        if (depth < sentinel_) range = {std::min(range[0], depth), std::max(range[1], depth)};
    if (range[0] <= range[1]) return range;
    return {static_cast<float>(light_.near), static_cast<float>(light_.far)};
}

} // namespace traces
