// A layered shadow map: depths of the surfaces behind each other as a light sees them, what is added to them before a
// receiver is compared, and the least depths of ever larger squares.
//
// Source: Bavoil 2007, sections 5.3.1 to 5.3.5 and 5.5.1 (specification 004, A17 to A19 and A22). Depths are distances
// from the plane of the light in units of the scene, as the format of the map holds them.
#pragma once

#include "sim/field.hpp"
#include "traces/area_light.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace traces {

enum class ShadowFormat : std::uint8_t { rgba16f, rgba32f };
constexpr std::uint32_t shadow_texel_bytes(ShadowFormat format) { return format == ShadowFormat::rgba16f ? 8 : 16; }
/// To nearest even; magnitudes beyond what the format can hold become its largest finite value.
float through_shadow_format(ShadowFormat format, float value);
/// Depth of a layer without a surface: the largest half, or 1e30.
float shadow_sentinel(ShadowFormat format);

/// What keeps a layer from shadowing itself.
enum class ShadowBias : std::uint8_t {
    none,
    uniform,     ///< a constant
    midpoint,    ///< half way to the next layer
    second_depth ///< the next layer
};

struct ShadowMapOptions {
    std::uint32_t resolution = 1024; ///< texels along one side, a power of two
    std::uint32_t captured = 4;      ///< layers that were kept
    std::uint32_t layers = 3;        ///< those that throw shadows, at most `captured`
    ShadowFormat format = ShadowFormat::rgba16f;
    ShadowBias bias = ShadowBias::midpoint;
    float uniform_bias = 0.0F; ///< scene units
    float gscale = 0.0F;       ///< 0: no slope bias
    float gmax = 0.0F;         ///< bound of the slope bias; 0 = none
    bool hierarchy = true;
};

class ShadowMap {
  public:
    /// @param kbuffer window depths in the light's view, `floats_per_texel` per texel, the first `captured` of them in
    ///                use; a texel's depths that do not lie in [0,1] are layers without a surface
    ShadowMap(const AreaLight& light, std::span<const float> kbuffer, std::size_t floats_per_texel,
              const ShadowMapOptions& options);

    const ShadowMapOptions& options() const { return options_; }
    const AreaLight& light() const { return light_; }
    std::uint32_t levels() const { return static_cast<std::uint32_t>(least_.size()); } ///< of the hierarchy

    /// Texels outside of the map have no surface; x and y may be negative.
    float depth(std::uint32_t layer, int x, int y) const {
        return inside(x, y) ? depths_[texel(x, y) * options_.captured + layer] : sentinel_;
    }
    /// What is added to the depth of a layer for comparisons; inside the map, not negative.
    float bias(std::uint32_t layer, int x, int y) const;
    bool inside(int x, int y) const {
        const auto r = static_cast<int>(options_.resolution);
        return x >= 0 && y >= 0 && x < r && y < r;
    }
    bool empty(std::uint32_t layer, int x, int y) const { return depth(layer, x, y) >= sentinel_; }

    /// Least depth of the first layer in the four texels of a level around a place, given in texels of the map.
    float least(std::uint32_t level, float u, float v) const;
    /// Bounding values of the first layer and of all, for pictures; {near, far} of the light when the map is empty.
    std::array<float, 2> range() const;

  private:
    std::size_t texel(int x, int y) const {
        return static_cast<std::size_t>(y) * options_.resolution + static_cast<std::size_t>(x);
    }
    float slope(std::span<const float> distances, std::uint32_t layer, std::uint32_t x, std::uint32_t y) const;
    void keep_slopes(std::span<const float> distances);
    void build_hierarchy();

    AreaLight light_;
    ShadowMapOptions options_;
    float sentinel_;
    std::vector<float> depths_;             ///< texel by texel, `captured` each
    std::vector<float> slopes_;             ///< texel by texel, `layers` each; empty without slope bias
    std::vector<std::vector<float>> least_; ///< level by level, half the size each, the map itself first
};

} // namespace traces

template <>
struct sim::EnumNames<traces::ShadowFormat> {
    static constexpr std::array<std::string_view, 2> names{"rgba16f", "rgba32f"};
};
template <>
struct sim::EnumNames<traces::ShadowBias> {
    static constexpr std::array<std::string_view, 4> names{"none", "uniform", "midpoint", "second_depth"};
};
