#include "traces/shadows/shadow_kernel.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cmath>

namespace traces {

namespace {

// Two independent numbers in [-0.5, 0.5) for a pixel (SplitMix64).
std::array<float, 2> jitter_of(std::uint64_t pixel) {
    std::uint64_t bits = (pixel + 1) * 0x9E3779B97F4A7C15ULL;
    bits = (bits ^ bits >> 30U) * 0xBF58476D1CE4E5B9ULL;
    bits = (bits ^ bits >> 27U) * 0x94D049BB133111EBULL;
    bits ^= bits >> 31U;
    constexpr float unit = 0x1p-24F;
    return {static_cast<float>(bits >> 40U) * unit - 0.5F, static_cast<float>(bits >> 8U & 0xFFFFFFU) * unit - 0.5F};
}

float texel_slope(const AreaLight& light, std::uint32_t resolution) { // w / (n r)
    return static_cast<float>(light.near_width / light.near / resolution);
}

struct Interval {
    float low = 0, high = 0;
};

// Of one axis, in widths of the light, clamped to it.
Interval shadow_on_light(float offset, float half, float scale) {
    return {std::clamp((offset - half) * scale, -0.5F, 0.5F), std::clamp((offset + half) * scale, -0.5F, 0.5F)};
}

// Light widths per texel and unit of z_s z / (z - z_s); infinite for a point light, which any texel covers whole.
float texel_on_light(const AreaLight& light, std::uint32_t resolution) {
    return light.width > 0.0 ? texel_slope(light, resolution) / static_cast<float>(light.width) : INFINITY;
}

// Light widths per texel at depth z_s, thrown onto the light from z > z_s.
float light_scale(float texel_on_light, float z_s, float z) {
    constexpr float largest = 1e30F; // beyond every texel that is not the receiver's own, and finite times any offset
    const float scale = texel_on_light * z_s * (z / (z - z_s));
    return scale < largest ? scale : largest;
}

float share_at(float texel_on_light, float du, float dv, float half, float z_s, float z) {
    if (!(z - z_s > 0.0F)) return 0.0F;
    if (texel_on_light == INFINITY) return 1.0F;
    const float scale = light_scale(texel_on_light, z_s, z);
    const Interval u = shadow_on_light(du, half, scale), v = shadow_on_light(dv, half, scale);
    return (u.high - u.low) * (v.high - v.low);
}

} // namespace

float search_width(const AreaLight& light, std::uint32_t resolution, float z_s, float z) {
    if (!(z_s < z) || !(z_s > 0.0F)) return 0.0F;
    const float slope = static_cast<float>(light.width) / texel_slope(light, resolution); // r l n / w
    // 1 / z_s - 1 / z, without the difference of two rounded quotients; 1 of what is infinitely far, where z / z is not
    // a number.
    const float width = slope * (std::min(1.0F, (z - z_s) / z) / z_s);
    return std::min(width, 4.0F * static_cast<float>(resolution));
}

std::uint32_t search_level(float width, std::uint32_t levels) {
    CHECK(levels > 0);
    const float level = width > 1.0F ? std::ceil(std::log2(width)) + 1.0F : 1.0F;
    return std::min(static_cast<std::uint32_t>(level), levels - 1);
}

float covered_share(const AreaLight& light, std::uint32_t resolution, float du, float dv, float half, float z_s,
                    float z) {
    return share_at(texel_on_light(light, resolution), du, dv, half, z_s, z);
}

BackProjection::BackProjection(const AreaLight& light, const ShadowMapOptions& map, const ShadowKernelOptions& options)
    : light_(light),
      layers_(light, map),
      options_(options),
      levels_(map.hierarchy && options.method == ShadowMethod::layered ? hierarchy_levels(map.resolution) : 0),
      texel_on_light_(texel_on_light(light, map.resolution)) {}

SearchRegion BackProjection::project(const glm::dvec3& world) const {
    const std::uint32_t r = layers_.options().resolution;
    const glm::dvec3 seen = light_.seen(world);
    SearchRegion region;
    region.z = static_cast<float>(seen.z);
    if (!(seen.z > light_.near) || !(region.z > static_cast<float>(light_.near))) return region;
    region.lit = false;
    const double texels = r * light_.near / (seen.z * light_.near_width);
    const double bound = 4.0 * r; // so far outside of the map that nothing of it can be reached
    region.u = static_cast<float>(std::clamp(r / 2.0 + seen.x * texels, -bound, bound));
    region.v = static_cast<float>(std::clamp(r / 2.0 - seen.y * texels, -bound, bound));
    if (options_.method == ShadowMethod::layered)
        region.width = search_width(light_, r, static_cast<float>(light_.near), region.z);
    else
        region.across = options_.method == ShadowMethod::hard ? 1 : 2 * options_.pcf_radius + 1;
    return region;
}

void BackProjection::narrow(SearchRegion& region, float least) const {
    ++region.narrowings;
    region.lit = !(least < region.z); // nothing is nearer to the light
    if (!region.lit)
        region.width = search_width(light_, layers_.options().resolution,
                                    std::max(least, static_cast<float>(light_.near)), region.z);
}

void BackProjection::spread_samples(SearchRegion& region) const {
    if (region.lit || options_.method != ShadowMethod::layered) return;
    const float radius = options_.width_as_radius ? region.width : region.width / 2.0F;
    const std::uint32_t side = 2 * static_cast<std::uint32_t>(std::ceil(radius)) + 1;
    const auto most = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(options_.most_samples)));
    region.across = side;
    if (std::uint64_t{side} * side > options_.most_samples) {
        const float texels_per_sample =
            static_cast<float>(side) * static_cast<float>(side) / static_cast<float>(options_.most_samples);
        region.across = options_.step == SampleStep::even
                            ? most
                            : static_cast<std::uint32_t>(std::ceil(static_cast<float>(side) / texels_per_sample));
        region.step = static_cast<float>(side) / static_cast<float>(region.across);
    }
}

std::array<float, 2> BackProjection::jitter(const SearchRegion& region, std::uint64_t pixel) const {
    if (!options_.jittered || !(region.step > 1.0F)) return {0.0F, 0.0F};
    std::array<float, 2> moved = jitter_of(pixel);
    for (float& offset : moved) offset *= region.step;
    return moved;
}

ShadowSample BackProjection::sample(const SearchRegion& region, const std::array<float, 2>& jitter,
                                    std::uint32_t number) const {
    const std::uint32_t column = number % region.across, row = number / region.across;
    if (options_.method != ShadowMethod::layered) {
        const int radius = static_cast<int>(region.across / 2);
        return {.x = static_cast<int>(std::floor(region.u)) + static_cast<int>(column) - radius,
                .y = static_cast<int>(std::floor(region.v)) + static_cast<int>(row) - radius};
    }
    const float i = offset_of(region, column) + jitter[0], j = offset_of(region, row) + jitter[1];
    const auto x = static_cast<int>(std::floor(region.u + i)), y = static_cast<int>(std::floor(region.v + j));
    if (options_.offset == SampleOffset::integer) return {x, y, i, j};
    return {x, y, static_cast<float>(x) + 0.5F - region.u, static_cast<float>(y) + 0.5F - region.v};
}

bool BackProjection::fills_gaps(const SearchRegion& region, const LayeredTexel& here) const {
    if (!options_.gap_filling || options_.method != ShadowMethod::layered || texel_on_light_ == INFINITY ||
        here.depths == nullptr)
        return false;
    for (std::uint32_t layer = 0; layer < layers_.options().layers; ++layer)
        if (occludes(here, layer, region.z)) return true;
    return false;
}

float BackProjection::share_of_layer(const SearchRegion& region, const ShadowSample& sample,
                                     const SampledTexels& texels, std::uint32_t layer) const {
    if (!occludes(texels.here, layer, region.z)) return 0.0F;
    const float half = region.step / 2.0F, z_s = texels.here.depths[layer];
    if (!options_.gap_filling || texel_on_light_ == INFINITY || !(region.z - z_s > 0.0F))
        return share_at(texel_on_light_, sample.du, sample.dv, half, z_s, region.z);
    // Up to the neighbour's edge on the light, where it is an occluder as well.
    const float scale = light_scale(texel_on_light_, z_s, region.z);
    Interval u = shadow_on_light(sample.du, half, scale), v = shadow_on_light(sample.dv, half, scale);
    const auto edge = [&](const LayeredTexel& neighbour, float offset) {
        if (neighbour.depths == nullptr || !occludes(neighbour, layer, region.z)) return 0.5F;
        return shadow_on_light(offset, half, light_scale(texel_on_light_, neighbour.depths[layer], region.z)).high;
    };
    u.low = std::min(u.low, edge(texels.left, sample.du - region.step));
    v.low = std::min(v.low, edge(texels.above, sample.dv - region.step));
    return (u.high - u.low) * (v.high - v.low);
}

// A24, steps 2 to 4: of the layers that lie before the receiver, the deepest that covers some of the light.
float BackProjection::covered(const SearchRegion& region, const ShadowSample& sample,
                              const SampledTexels& texels) const {
    if (texels.here.depths == nullptr) return 0.0F;
    if (options_.method != ShadowMethod::layered) return occludes(texels.here, 0, region.z) ? 1.0F : 0.0F;
    for (std::uint32_t layer = layers_.options().layers; layer-- > 0;)
        if (const float share = share_of_layer(region, sample, texels, layer); share > 0.0F) return share;
    return 0.0F;
}

float BackProjection::visibility(const SearchRegion& region, float covered) const {
    if (region.across == 0) return 1.0F;
    if (options_.method == ShadowMethod::layered) return std::max(1.0F - covered, 0.0F);
    const auto samples = static_cast<float>(region.across * region.across);
    return (samples - covered) / samples;
}

SearchRegion ShadowKernel::region(const glm::dvec3& world) const {
    SearchRegion region = formulas_.project(world);
    while (formulas_.narrows(region))
        formulas_.narrow(region, map_->least(formulas_.level(region), region.u, region.v));
    formulas_.spread_samples(region);
    return region;
}

float ShadowKernel::visibility(const SearchRegion& region, std::uint64_t pixel) const {
    const std::array<float, 2> jitter = formulas_.jitter(region, pixel);
    const int stride = BackProjection::stride(region);
    float covered = 0.0F;
    for (std::uint32_t number = 0; number < region.across * region.across; ++number) {
        const ShadowSample sample = formulas_.sample(region, jitter, number);
        covered += formulas_.covered(region, sample,
                                     {map_->texel(sample.x, sample.y), map_->texel(sample.x - stride, sample.y),
                                      map_->texel(sample.x, sample.y - stride)});
    }
    return formulas_.visibility(region, covered);
}

} // namespace traces
