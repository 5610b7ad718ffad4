#include "pipeline/functional/mip_levels.hpp"

#include <algorithm>
#include <cmath>

namespace pipeline {

namespace {

bool is_linear(Filter filter) {
    return filter == Filter::linear || filter == Filter::linear_mip_nearest || filter == Filter::linear_mip_linear;
}

} // namespace

FootprintLevel footprint_level(const PixelFootprint& footprint, float anisotropy) {
    const double longer = std::max(footprint.right, footprint.down);
    FootprintLevel level{.probes_down = footprint.down > footprint.right};
    if (anisotropy > 1.0F && longer > 1.0) {
        const double shorter = std::min(footprint.right, footprint.down);
        const double most = std::floor(std::min(static_cast<double>(anisotropy), static_cast<double>(most_probes)));
        const double ratio = std::ceil(std::sqrt(longer / shorter));
        level.probes = static_cast<std::uint32_t>(ratio < most ? ratio : most); // infinite and NaN: as many as may be
    }
    level.lod = static_cast<float>(0.5 * std::log2(longer) - std::log2(static_cast<double>(level.probes)));
    return level;
}

float bounded_lod(const SamplerState& sampler, float lod) {
    const float bounded = std::min(std::max(lod + sampler.lod_bias, sampler.least_lod), sampler.most_lod);
    return std::isnan(bounded) ? 0.0F : bounded;
}

LevelReads reads_of_levels(const SamplerState& sampler, float lod, std::uint32_t base, std::uint32_t last) {
    const Filter filter = sampler.min_filter;
    const bool from_half = sampler.mag_filter == Filter::linear &&
                           (filter == Filter::nearest_mip_nearest || filter == Filter::nearest_mip_linear);
    if (lod <= (from_half ? 0.5F : 0.0F)) return {base, 0.0F, is_linear(sampler.mag_filter)};
    const bool linear = is_linear(filter);
    if (filter == Filter::nearest || filter == Filter::linear) return {base, 0.0F, linear};
    const float above = std::min(lod, static_cast<float>(last - base));
    if (filter == Filter::nearest_mip_nearest || filter == Filter::linear_mip_nearest)
        return {base + static_cast<std::uint32_t>(std::ceil(above - 0.5F)), 0.0F, linear}; // halves go down
    const auto whole = static_cast<std::uint32_t>(above);
    return {base + whole, above - static_cast<float>(whole), linear};
}

} // namespace pipeline
