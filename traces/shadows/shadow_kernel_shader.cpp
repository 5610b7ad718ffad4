// The kernel as a shader. The four pixels of a quad run in lockstep: each read is one fetch by those that still have
// something to read there, of one surface. Of a sample all layers are issued, as a choice between them is no branch.
#include "traces/shader_names.hpp"
#include "traces/shadows/shadow_shaders.hpp"

#include <algorithm>
#include <bit>

namespace traces {

namespace {

// Instructions (A20 to A24), each on vectors of four.
constexpr std::uint32_t kernel_leave = 2;     // compare, leave
constexpr std::uint32_t kernel_setup = 14;    // unpack, 4 dots into the light's space, divide, bounds, result, modulate
constexpr std::uint32_t kernel_narrowing = 9; // 3 minima, compare, 2 reciprocals, subtract, log2, ceil
constexpr std::uint32_t kernel_region = 6;    // ceil, side, square, compare, root, step
constexpr std::uint32_t kernel_sample = 4;    // count and compare, coordinate, distance from the centre, sum
// Bias, compare, z - z_s, reciprocal, two products, bounds, clamp (two), extents, area with selection.
constexpr std::uint32_t kernel_layer = 11;
constexpr std::uint32_t kernel_gap = 7; // of a neighbour's layer: bias, compare, z - z_s, reciprocal, product, bound,
                                        // minimum
constexpr std::uint32_t filter_sample = 5; // coordinate, bias, compare, count and compare of the loop

constexpr std::uint32_t colours_slot = 0, places_slot = 1, first_pack = 2;

constexpr bool has(unsigned pixels, std::size_t i) { return (pixels >> i & 1U) != 0; }

/// Texels of the map at one place for each pixel of a quad.
class QuadLayers {
  public:
    /// `pixels` read `packs` surfaces of layers from `slot` on, and `slopes` behind them.
    void read(SurfaceAccess& surfaces, const ShadowKernelReads& reads, const LaneIndices& x, const LaneIndices& y,
              unsigned pixels) {
        const auto size = static_cast<std::int32_t>(surfaces.info(first_pack).width);
        take(surfaces, first_pack, reads.packs, x, y, pixels, depths_);
        take(surfaces, reads.first_slope(), reads.slopes, x, y, pixels, slopes_);
        for (std::size_t i = 0; i < 4; ++i) {
            const bool inside = has(pixels, i) && x[i] >= 0 && y[i] >= 0 && x[i] < size && y[i] < size;
            texels_[i].depths = inside ? depths_[i].data() : nullptr;
            texels_[i].slopes = reads.slopes != 0 ? slopes_[i].data() : nullptr;
        }
    }
    const LayeredTexel& operator[](std::size_t i) const { return texels_[i]; }

  private:
    using Layers = std::array<std::array<float, ShadowLayers::most>, 4>;

    static void take(SurfaceAccess& surfaces, std::uint32_t slot, std::uint32_t packs, const LaneIndices& x,
                     const LaneIndices& y, unsigned pixels, Layers& layers) {
        for (std::uint32_t pack = 0; pack < packs; ++pack) {
            const QuadTexels four = surfaces.fetch(slot + pack, x, y, pixels);
            for (std::size_t i = 0; i < 4; ++i)
                for (int channel = 0; channel < 4; ++channel)
                    layers[i][std::size_t{pack} * 4 + static_cast<std::size_t>(channel)] = four[i][channel];
        }
    }

    Layers depths_{}, slopes_{};
    std::array<LayeredTexel, 4> texels_;
};

using QuadRegions = std::array<SearchRegion, 4>;

/// What the kernel and its picture of samples have in common.
class ShadowSearch : public pipeline::Shader {
  public:
    explicit ShadowSearch(const ShadowSetup& setup)
        : setup_(setup), formulas_(setup.light, setup.map, setup.kernel), reads_(setup) {}

    ShaderShape shape() const override { return {.reads = reads_.count(), .registers = 12, .discards = false}; }

  protected:
    static bool is_surface(const glm::vec4& colour) { return colour.a > 0.0F; }
    /// Those that light can change.
    static unsigned not_black(const QuadTexels& colours, unsigned pixels) {
        unsigned result = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec4& rgba = colours[i];
            if (has(pixels, i) && is_surface(rgba) && (rgba.r > 0.0F || rgba.g > 0.0F || rgba.b > 0.0F))
                result |= 1U << i;
        }
        return result;
    }

    QuadRegions regions(const QuadPlaces& at, unsigned pixels, SurfaceAccess& surfaces) const {
        const QuadTexels places = surfaces.fetch(places_slot, at.x, at.y, pixels);
        surfaces.issue(kernel_setup, pixels);
        QuadRegions regions;
        for (std::size_t i = 0; i < 4; ++i)
            if (has(pixels, i)) regions[i] = formulas_.project(glm::dvec3(places[i]));
        while (const unsigned narrowing =
                   pixels_that(regions, [this](const auto& one) { return formulas_.narrows(one); }))
            narrow(regions, narrowing, surfaces);
        if (formulas_.options().method == ShadowMethod::layered)
            surfaces.issue(kernel_region, pixels_that(regions, [](const auto& one) { return !one.lit; }));
        for (SearchRegion& region : regions) formulas_.spread_samples(region);
        return regions;
    }

    template <class Predicate>
    static unsigned pixels_that(const QuadRegions& regions, Predicate predicate) {
        unsigned pixels = 0;
        for (std::size_t i = 0; i < 4; ++i) pixels |= predicate(regions[i]) ? 1U << i : 0U;
        return pixels;
    }

    const ShadowSetup& setup() const { return setup_; }
    const BackProjection& formulas() const { return formulas_; }
    const ShadowKernelReads& reads() const { return reads_; }

  private:
    /// Pixels that look at different levels look at different surfaces, one after the other.
    void narrow(QuadRegions& regions, unsigned pixels, SurfaceAccess& surfaces) const {
        surfaces.issue(kernel_narrowing, pixels);
        while (pixels != 0) {
            const std::uint32_t level = formulas_.level(regions[static_cast<std::size_t>(std::countr_zero(pixels))]);
            const unsigned alike = pixels & pixels_that(regions, [&](const auto& one) {
                                       return formulas_.narrows(one) && formulas_.level(one) == level;
                                   });
            pixels &= ~alike;
            narrow_on(level, regions, alike, surfaces);
        }
    }

    void narrow_on(std::uint32_t level, QuadRegions& regions, unsigned pixels, SurfaceAccess& surfaces) const {
        std::array<std::array<glm::ivec2, 4>, 4> around{};
        for (std::size_t i = 0; i < 4; ++i)
            if (has(pixels, i)) around[i] = texels_around(setup_.map.resolution, level, regions[i].u, regions[i].v);
        const std::uint32_t slot = level == 0 ? first_pack : reads_.first_level() + level - 1;
        std::array<std::array<float, 4>, 4> depths{};
        for (std::size_t tap = 0; tap < 4; ++tap) {
            LaneIndices x{}, y{};
            for (std::size_t i = 0; i < 4; ++i) {
                x[i] = around[i][tap].x;
                y[i] = around[i][tap].y;
            }
            const QuadTexels texels = surfaces.fetch(slot, x, y, pixels);
            for (std::size_t i = 0; i < 4; ++i) depths[i][tap] = texels[i].r;
        }
        for (std::size_t i = 0; i < 4; ++i)
            if (has(pixels, i)) formulas_.narrow(regions[i], least_of(depths[i]));
    }

    ShadowSetup setup_;
    BackProjection formulas_;
    ShadowKernelReads reads_;
};

class ShadowKernelShader final : public ShadowSearch {
  public:
    using ShadowSearch::ShadowSearch;

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const QuadPlaces at(input);
        const QuadTexels colours = surfaces.fetch(colours_slot, at.x, at.y, input.pixels);
        const unsigned shaded = not_black(colours, input.pixels);
        surfaces.issue(kernel_leave, input.pixels & ~shaded);
        for (std::size_t i = 0; i < 4; ++i)
            output.colours[0][i] = glm::vec4(is_surface(colours[i]) ? glm::vec3(0.0F) : setup().background, 1.0F);
        if (shaded == 0) return;
        const QuadRegions seen = regions(at, shaded, surfaces);
        const std::array<float, 4> covered = cover(at, seen, surfaces);
        for (std::size_t i = 0; i < 4; ++i) {
            if (!has(shaded, i)) continue;
            const float visible = formulas().visibility(seen[i], covered[i]);
            const float light = setup().ambient + (1.0F - setup().ambient) * visible;
            output.colours[0][i] = glm::vec4(light * glm::vec3(colours[i]), visible);
        }
    }

  private:
    using QuadSamples = std::array<ShadowSample, 4>;

    std::array<float, 4> cover(const QuadPlaces& at, const QuadRegions& regions, SurfaceAccess& surfaces) const {
        std::array<std::array<float, 2>, 4> jitter{};
        std::array<std::uint32_t, 4> count{};
        for (std::size_t i = 0; i < 4; ++i) {
            const auto x = static_cast<std::uint64_t>(at.x[i]), y = static_cast<std::uint64_t>(at.y[i]);
            jitter[i] = formulas().jitter(regions[i], y * setup().eye.width + x);
            count[i] = regions[i].across * regions[i].across;
        }
        std::array<float, 4> covered{};
        Texels texels;
        const std::uint32_t longest = *std::max_element(count.begin(), count.end());
        for (std::uint32_t number = 0; number < longest; ++number) {
            unsigned pixels = 0;
            QuadSamples samples;
            for (std::size_t i = 0; i < 4; ++i) {
                if (number >= count[i]) continue;
                pixels |= 1U << i;
                samples[i] = formulas().sample(regions[i], jitter[i], number);
            }
            read(regions, samples, pixels, texels, surfaces);
            for (std::size_t i = 0; i < 4; ++i)
                if (has(pixels, i))
                    covered[i] +=
                        formulas().covered(regions[i], samples[i], {texels.here[i], texels.left[i], texels.above[i]});
        }
        return covered;
    }

    struct Texels {
        QuadLayers here, left, above;
    };

    void read(const QuadRegions& regions, const QuadSamples& samples, unsigned pixels, Texels& texels,
              SurfaceAccess& surfaces) const {
        LaneIndices x{}, y{}, left{}, above{};
        for (std::size_t i = 0; i < 4; ++i) {
            x[i] = samples[i].x;
            y[i] = samples[i].y;
            left[i] = x[i] - BackProjection::stride(regions[i]);
            above[i] = y[i] - BackProjection::stride(regions[i]);
        }
        texels.here.read(surfaces, reads(), x, y, pixels);
        surfaces.issue(instructions_of_sample(), pixels);
        unsigned gaps = 0;
        for (std::size_t i = 0; i < 4; ++i)
            if (has(pixels, i) && formulas().fills_gaps(regions[i], texels.here[i])) gaps |= 1U << i;
        if (gaps == 0) return;
        texels.left.read(surfaces, reads(), left, y, gaps);
        texels.above.read(surfaces, reads(), x, above, gaps);
        surfaces.issue(2 * (1 + setup().map.layers * kernel_gap), gaps); // 1: coordinate
    }

    std::uint32_t instructions_of_sample() const {
        if (formulas().options().method != ShadowMethod::layered) return filter_sample;
        const std::uint32_t slopes = setup().map.gscale > 0.0F ? 1 : 0; // one maximum for each
        return kernel_sample + setup().map.layers * (kernel_layer + slopes);
    }
};

class ShadowSamplesShader final : public ShadowSearch {
  public:
    using ShadowSearch::ShadowSearch;

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const QuadPlaces at(input);
        const QuadTexels colours = surfaces.fetch(colours_slot, at.x, at.y, input.pixels);
        const unsigned shaded = not_black(colours, input.pixels);
        const QuadRegions seen = regions(at, shaded, surfaces);
        for (std::size_t i = 0; i < 4; ++i)
            output.colours[0][i].r = static_cast<float>(seen[i].across * seen[i].across);
    }
};

class ShadowBiasShader final : public pipeline::Shader {
  public:
    explicit ShadowBiasShader(const ShadowSetup& setup) : layers_(setup.light, setup.map) {}

    ShaderShape shape() const override { return {.reads = has_slopes() ? 2U : 1U, .discards = false}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const QuadPlaces at(input);
        const QuadTexels depths = surfaces.fetch(0, at.x, at.y, input.pixels);
        const QuadTexels slopes = has_slopes() ? surfaces.fetch(1, at.x, at.y, input.pixels) : QuadTexels{};
        for (std::size_t i = 0; i < 4; ++i) {
            if (!has(input.pixels, i) || depths[i].r >= layers_.sentinel()) continue;
            const std::array<float, 2> layers{depths[i][0], depths[i][1]};
            const float slope = slopes[i][0];
            output.colours[0][i].r = layers_.bias({layers.data(), has_slopes() ? &slope : nullptr}, 0);
        }
    }

  private:
    bool has_slopes() const { return layers_.options().gscale > 0.0F; }

    ShadowLayers layers_;
};

} // namespace

ShadowKernelReads::ShadowKernelReads(const ShadowSetup& setup) {
    const ShadowLayers layers(setup.light, setup.map);
    const bool layered = setup.kernel.method == ShadowMethod::layered;
    const std::uint32_t thrown = layered ? setup.map.layers : 1;
    packs = packs_of(std::min(thrown + (layers.reads_next_layer() ? 1U : 0U), setup.map.captured));
    slopes = setup.map.gscale > 0.0F ? packs_of(thrown) : 0;
    levels = setup.map.hierarchy && layered ? hierarchy_levels(setup.map.resolution) - 1 : 0;
}

std::shared_ptr<const pipeline::Shader> shadow_kernel_shader(const ShadowSetup& setup) {
    return std::make_shared<const ShadowKernelShader>(setup);
}

std::shared_ptr<const pipeline::Shader> shadow_samples_shader(const ShadowSetup& setup) {
    return std::make_shared<const ShadowSamplesShader>(setup);
}

std::shared_ptr<const pipeline::Shader> shadow_bias_shader(const ShadowSetup& setup) {
    return std::make_shared<const ShadowBiasShader>(setup);
}

} // namespace traces
