// How much of a square light a point sees, from a layered shadow map: texels near its way to the light are projected
// back onto the light, and what they cover is subtracted.
//
// Source: Bavoil 2007, sections 5.3.2 to 5.3.5 (specification 004, A20, A21, A23 to A25). Everything is single
// precision, as the shaders of the time computed it, except for the place of the point; z z_s / (z - z_s) is formed as
// a ratio first, so that no product of two depths can overflow. Guards: a receiver at or before the near plane, or no
// farther than the least depth around it, is lit; z - z_s must be positive; a point light is a hard shadow.
#pragma once

#include "traces/shadows/shadow_map.hpp"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>

namespace traces {

enum class ShadowMethod : std::uint8_t {
    layered, ///< back-projection
    hard,    ///< one texel of the first layer
    pcf      ///< the share of a square of texels of the first layer that lie before the receiver
};
/// How far apart samples are when a region has more than `most_samples` texels.
enum class SampleStep : std::uint8_t {
    even,   ///< sqrt(texels / most): as many samples as allowed
    literal ///< texels / most, as printed
};
/// Where a sample is taken to lie.
enum class SampleOffset : std::uint8_t {
    integer, ///< its number of steps away from the projected point
    exact    ///< the middle of its texel
};

struct ShadowKernelOptions {
    ShadowMethod method = ShadowMethod::layered;
    std::uint32_t most_samples = 441; ///< max_nspp
    std::uint32_t iterations = 2;     ///< narrowings of the search region; 0: no hierarchy is read
    SampleStep step = SampleStep::even;
    SampleOffset offset = SampleOffset::integer;
    bool width_as_radius = false; ///< takes kr for a radius: four times the texels
    bool jittered = false;        ///< samples that skip texels are moved by up to half a step, pixel by pixel
    bool gap_filling = false;     ///< samples reach to the next one on their left and below
    std::uint32_t pcf_radius = 2; ///< texels on either side
};

/// Kernel width in texels for a receiver at z and an occluder at z_s, both distances from the light's plane: Eq. 5.1,
/// kr = r l (n/w) (1/z_s - 1/z). Not negative, finite; at most four times the map.
float search_width(const AreaLight& light, std::uint32_t resolution, float z_s, float z);
/// Level of the hierarchy for a width: ceil(log2(kr)) + 1, at most the last.
std::uint32_t search_level(float width, std::uint32_t levels);

/// Share of the light that a texel covers, 0 to 1 (Eq. 5.3): du, dv from the projected receiver to the middle of the
/// texel, which reaches `half` to either side, in texels. 0 unless z_s < z.
float covered_share(const AreaLight& light, std::uint32_t resolution, float du, float dv, float half, float z_s,
                    float z);

/// What the kernel does for one point, before it reads a sample.
struct SearchRegion {
    float u = 0, v = 0;           ///< projected point, texels from the upper left corner of the map
    float z = 0;                  ///< distance from the light's plane
    float width = 0;              ///< kr, in texels
    bool lit = true;              ///< nothing can lie between the point and the light
    std::uint32_t narrowings = 0; ///< times the hierarchy was read
    std::uint32_t across = 0;     ///< samples along one side; 0: nothing is sampled, the point is lit
    float step = 1;               ///< texels between two samples
};

struct ShadowSample {
    int x = 0, y = 0;     ///< texel, perhaps outside of the map
    float du = 0, dv = 0; ///< from the projected point, in texels
};

/// The texel of a sample, and those that its occluders may reach to; see BackProjection::fills_gaps().
struct SampledTexels {
    LayeredTexel here, left, above;
};

/// The formulas of the kernel, one texel and one place of the hierarchy at a time, whoever reads them.
class BackProjection {
  public:
    BackProjection(const AreaLight& light, const ShadowMapOptions& map, const ShadowKernelOptions& options);

    const ShadowLayers& layers() const { return layers_; }
    const ShadowKernelOptions& options() const { return options_; }

    // How far is searched: project(); then as long as narrows(), what lies around the place on the region's level();
    // then spread_samples().
    SearchRegion project(const glm::dvec3& world) const;
    bool narrows(const SearchRegion& region) const {
        return !region.lit && levels_ > 0 && region.narrowings < options_.iterations;
    }
    std::uint32_t level(const SearchRegion& region) const { return search_level(region.width, levels_); }
    void narrow(SearchRegion& region, float least) const;
    void spread_samples(SearchRegion& region) const;

    /// Added to the offsets of all samples of a pixel, in texels.
    std::array<float, 2> jitter(const SearchRegion& region, std::uint64_t pixel) const;
    /// Sample `number` of across^2, row by row.
    ShadowSample sample(const SearchRegion& region, const std::array<float, 2>& jitter, std::uint32_t number) const;
    /// Some layer is an occluder, and its share depends on the texels one stride() to the left and up.
    bool fills_gaps(const SearchRegion& region, const LayeredTexel& here) const;
    static int stride(const SearchRegion& region) { return std::max(1, static_cast<int>(region.step)); }
    /// What a sample takes of the light; of filters by a share of texels, 1 or 0.
    float covered(const SearchRegion& region, const ShadowSample& sample, const SampledTexels& texels) const;
    /// What is left of the light, 0 to 1, where all samples together take `covered`.
    float visibility(const SearchRegion& region, float covered) const;

    /// Offset of sample i of a side, in texels from the projected point.
    static float offset_of(const SearchRegion& region, std::uint32_t i) {
        const float side = static_cast<float>(region.across) * region.step;
        return (static_cast<float>(i) + 0.5F) * region.step - side / 2.0F;
    }

  private:
    float share_of_layer(const SearchRegion& region, const ShadowSample& sample, const SampledTexels& texels,
                         std::uint32_t layer) const;
    bool occludes(const LayeredTexel& texel, std::uint32_t layer, float z) const {
        return texel.depths[layer] + layers_.bias(texel, layer) < z;
    }

    AreaLight light_;
    ShadowLayers layers_;
    ShadowKernelOptions options_;
    std::uint32_t levels_; ///< of the hierarchy; 0: it is not read
    float texel_on_light_;
};

/// The kernel on a map in memory.
class ShadowKernel {
  public:
    ShadowKernel(const ShadowMap& map, const ShadowKernelOptions& options)
        : map_(&map), formulas_(map.light(), map.options(), options) {}

    SearchRegion region(const glm::dvec3& world) const;
    /// 0 to 1. `pixel` seeds the jitter.
    float visibility(const SearchRegion& region, std::uint64_t pixel) const;
    static float offset_of(const SearchRegion& region, std::uint32_t i) { return BackProjection::offset_of(region, i); }

  private:
    const ShadowMap* map_;
    BackProjection formulas_;
};

} // namespace traces

template <>
struct sim::EnumNames<traces::ShadowMethod> {
    static constexpr std::array<std::string_view, 3> names{"layered", "hard", "pcf"};
};
template <>
struct sim::EnumNames<traces::SampleStep> {
    static constexpr std::array<std::string_view, 2> names{"even", "literal"};
};
template <>
struct sim::EnumNames<traces::SampleOffset> {
    static constexpr std::array<std::string_view, 2> names{"integer", "exact"};
};
