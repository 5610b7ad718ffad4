// A layered shadow map: depths of the surfaces behind each other as a light sees them, what is added to them before a
// receiver is compared, and the least depths of ever larger squares.
//
// Source: Bavoil 2007, sections 5.3.1 to 5.3.5 and 5.5.1 (specification 004, A17 to A19 and A22). Depths are distances
// from the plane of the light in units of the scene, as the format of the map holds them.
#pragma once

#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/surface_format.hpp"
#include "sim/field.hpp"
#include "traces/area_light.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace traces {

enum class ShadowFormat : std::uint8_t { rgba16f, rgba32f };
constexpr pipeline::SurfaceFormat surface_format(ShadowFormat format) {
    return format == ShadowFormat::rgba16f ? pipeline::SurfaceFormat::rgba16f : pipeline::SurfaceFormat::rgba32f;
}
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
    std::uint32_t captured = 4;      ///< layers that were kept, at most ShadowLayers::most
    std::uint32_t layers = 3;        ///< those that throw shadows, at most `captured`
    ShadowFormat format = ShadowFormat::rgba16f;
    ShadowBias bias = ShadowBias::midpoint;
    float uniform_bias = 0.0F; ///< scene units
    float gscale = 0.0F;       ///< 0: no slope bias
    float gmax = 0.0F;         ///< bound of the slope bias; 0 = none
    bool hierarchy = true;
};

/// A texel's layers; `depths` is null outside of the map.
struct LayeredTexel {
    const float* depths = nullptr; ///< as the map stores them, `captured` of them
    const float* slopes = nullptr; ///< slope biases of `layers` of them; null: there are none
};

/// What a map stores of the depths in a texel of the k-buffer, and what it adds to them for comparisons.
class ShadowLayers {
  public:
    static constexpr std::uint32_t most = 16; ///< layers

    ShadowLayers(const AreaLight& light, const ShadowMapOptions& options);

    const ShadowMapOptions& options() const { return options_; }
    float sentinel() const { return sentinel_; }
    /// From the light's plane, of a window depth in the light's view; the sentinel where it is no surface.
    float distance(float window) const;
    /// A distance as the map holds it.
    float stored(float distance) const;
    /// A22, of distances in this texel and in the next ones on either axis, which are this one at the map's border.
    float slope(float here, float right, float below) const;
    /// What is added to the depth of a layer; not negative. The texel lies in the map.
    float bias(const LayeredTexel& texel, std::uint32_t layer) const;
    bool reads_next_layer() const {
        return options_.bias == ShadowBias::midpoint || options_.bias == ShadowBias::second_depth;
    }

  private:
    ShadowMapOptions options_;
    pipeline::EyeDepth window_;
    float sentinel_;
};

/// Levels of the hierarchy over a map, the map itself being the first.
std::uint32_t hierarchy_levels(std::uint32_t resolution);
/// What a level keeps of four texels of the finer one, row by row.
float least_of(const std::array<float, 4>& finer);
/// The four texels of a level whose centres surround a place, which is given in texels of the map; the border's texels
/// repeat.
std::array<glm::ivec2, 4> texels_around(std::uint32_t resolution, std::uint32_t level, float u, float v);

/// A map in memory.
class ShadowMap {
  public:
    /// @param kbuffer window depths in the light's view, `floats_per_texel` per texel, the first `captured` of them in
    ///                use; a texel's depths that do not lie in [0,1] are layers without a surface
    ShadowMap(const AreaLight& light, std::span<const float> kbuffer, std::size_t floats_per_texel,
              const ShadowMapOptions& options);

    const ShadowMapOptions& options() const { return layers_.options(); }
    const AreaLight& light() const { return light_; }
    std::uint32_t levels() const { return static_cast<std::uint32_t>(least_.size()); } ///< of the hierarchy

    /// x and y may be negative.
    LayeredTexel texel(int x, int y) const;
    /// Texels outside of the map have no surface.
    float depth(std::uint32_t layer, int x, int y) const {
        const LayeredTexel at = texel(x, y);
        return at.depths != nullptr ? at.depths[layer] : layers_.sentinel();
    }
    /// Inside the map.
    float bias(std::uint32_t layer, int x, int y) const { return layers_.bias(texel(x, y), layer); }
    bool empty(std::uint32_t layer, int x, int y) const { return depth(layer, x, y) >= layers_.sentinel(); }

    /// Least depth of the first layer in the four texels of a level around a place, given in texels of the map.
    float least(std::uint32_t level, float u, float v) const;

  private:
    void keep_slopes(std::span<const float> distances);
    void build_hierarchy();

    AreaLight light_;
    ShadowLayers layers_;
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
