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

ShadowKernel::ShadowKernel(const ShadowMap& map, const ShadowKernelOptions& options)
    : map_(&map), options_(options), texel_on_light_(texel_on_light(map.light(), map.options().resolution)) {}

SearchRegion ShadowKernel::region(const glm::dvec3& world) const {
    const AreaLight& light = map_->light();
    const std::uint32_t r = map_->options().resolution;
    const glm::dvec3 seen = light.seen(world);
    SearchRegion region;
    region.z = static_cast<float>(seen.z);
    if (!(seen.z > light.near) || !(region.z > static_cast<float>(light.near))) return region;
    const double texels = r * light.near / (seen.z * light.near_width);
    const double bound = 4.0 * r; // so far outside of the map that nothing of it can be reached
    region.u = static_cast<float>(std::clamp(r / 2.0 + seen.x * texels, -bound, bound));
    region.v = static_cast<float>(std::clamp(r / 2.0 - seen.y * texels, -bound, bound));
    if (options_.method != ShadowMethod::layered) {
        region.across = options_.method == ShadowMethod::hard ? 1 : 2 * options_.pcf_radius + 1;
        return region;
    }
    region.width = search_width(light, r, static_cast<float>(light.near), region.z);
    for (; region.narrowings < options_.iterations && map_->levels() > 0; ++region.narrowings) {
        const std::uint32_t level = search_level(region.width, map_->levels());
        if (region.narrowings < region.level.size()) region.level[region.narrowings] = static_cast<std::uint8_t>(level);
        const float least = map_->least(level, region.u, region.v);
        if (!(least < region.z)) {
            ++region.narrowings;
            return region; // nothing is nearer to the light: lit
        }
        region.width = search_width(light, r, std::max(least, static_cast<float>(light.near)), region.z);
    }
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
    return region;
}

float ShadowKernel::share_of_layer(const SearchRegion& region, std::uint32_t layer, int x, int y, float du,
                                   float dv) const {
    if (!occludes(layer, x, y, region.z)) return 0.0F;
    const float half = region.step / 2.0F, z_s = map_->depth(layer, x, y);
    if (!options_.gap_filling || texel_on_light_ == INFINITY || !(region.z - z_s > 0.0F))
        return share_at(texel_on_light_, du, dv, half, z_s, region.z);
    // Up to the neighbour's edge on the light, where it is an occluder as well.
    const float scale = light_scale(texel_on_light_, z_s, region.z);
    Interval u = shadow_on_light(du, half, scale), v = shadow_on_light(dv, half, scale);
    const int stride = std::max(1, static_cast<int>(region.step));
    const auto edge = [&](int nx, int ny, float offset) {
        if (!map_->inside(nx, ny) || !occludes(layer, nx, ny, region.z)) return 0.5F;
        const float z_n = map_->depth(layer, nx, ny);
        return shadow_on_light(offset, half, light_scale(texel_on_light_, z_n, region.z)).high;
    };
    u.low = std::min(u.low, edge(x - stride, y, du - region.step));
    v.low = std::min(v.low, edge(x, y - stride, dv - region.step));
    return (u.high - u.low) * (v.high - v.low);
}

// A24, steps 2 to 4: of the layers that lie before the receiver, the deepest that covers some of the light.
float ShadowKernel::share_of(const SearchRegion& region, float i, float j) const {
    const auto x = static_cast<int>(std::floor(region.u + i)), y = static_cast<int>(std::floor(region.v + j));
    if (!map_->inside(x, y)) return 0.0F;
    const bool exact = options_.offset == SampleOffset::exact;
    const float du = exact ? static_cast<float>(x) + 0.5F - region.u : i;
    const float dv = exact ? static_cast<float>(y) + 0.5F - region.v : j;
    for (std::uint32_t layer = map_->options().layers; layer-- > 0;)
        if (const float share = share_of_layer(region, layer, x, y, du, dv); share > 0.0F) return share;
    return 0.0F;
}

float ShadowKernel::filtered(const SearchRegion& region) const {
    const int x = static_cast<int>(std::floor(region.u)), y = static_cast<int>(std::floor(region.v));
    const int radius = static_cast<int>(region.across / 2);
    int lit = 0;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i)
            lit += map_->inside(x + i, y + j) && occludes(0, x + i, y + j, region.z) ? 0 : 1;
    return static_cast<float>(lit) / static_cast<float>(region.across * region.across);
}

float ShadowKernel::visibility(const SearchRegion& region, std::uint64_t pixel) const {
    if (region.across == 0) return 1.0F;
    if (options_.method != ShadowMethod::layered) return filtered(region);
    std::array<float, 2> moved{0.0F, 0.0F};
    if (options_.jittered && region.step > 1.0F) {
        moved = jitter_of(pixel);
        for (float& offset : moved) offset *= region.step;
    }
    float covered = 0.0F;
    for (std::uint32_t j = 0; j < region.across; ++j)
        for (std::uint32_t i = 0; i < region.across; ++i)
            covered += share_of(region, offset_of(region, i) + moved[0], offset_of(region, j) + moved[1]);
    return std::max(1.0F - covered, 0.0F);
}

} // namespace traces
