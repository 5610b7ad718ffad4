#include "traces/shadows/shadow_passes.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces {

namespace {

// Surfaces that the passes read, each with lines of its own.
enum class Surface : std::uint64_t { kbuffer, packed, slopes, positions, colours, hierarchy };

constexpr std::uint64_t lines_of_surface = std::uint64_t{1} << 26U; ///< the largest map has fewer
constexpr std::uint32_t parts_of_surface = 64;

// 64-byte lines of square blocks of texels, or of blocks twice as wide as high.
std::uint64_t line_of(Surface surface, std::uint32_t part, std::uint32_t width, std::uint32_t texel_bytes,
                      std::uint32_t x, std::uint32_t y) {
    const std::uint32_t texels = 64 / texel_bytes, high = texels >= 16 ? 4 : 2, wide = texels / high;
    const std::uint64_t per_row = (width + wide - 1) / wide;
    return (static_cast<std::uint64_t>(surface) * parts_of_surface + part) * lines_of_surface + (y / high) * per_row +
           x / wide;
}

std::uint32_t packs_of(std::uint32_t layers) { return (layers + 3) / 4; }

struct Shape {
    Surface surface;
    std::uint32_t width, texel_bytes;
};

// A pass whose quads all do the same: fetches of the texels around their own place, scaled.
class PlainShader final : public pipeline::ScreenShader {
  public:
    struct Tap {
        std::uint32_t part;
        int dx, dy; ///< from the quad's own place, in texels of what is read
    };
    PlainShader(const Shape& source, std::uint32_t scale, std::uint32_t alu, std::vector<Tap> taps)
        : source_(source), scale_(scale), alu_(alu), taps_(std::move(taps)) {}

    std::uint32_t alu(std::uint32_t, std::uint32_t) const override { return alu_; }
    std::uint32_t fetches(std::uint32_t, std::uint32_t) const override {
        return static_cast<std::uint32_t>(taps_.size());
    }
    std::uint64_t line(std::uint32_t x, std::uint32_t y, std::uint32_t fetch) const override {
        const Tap& tap = taps_[fetch];
        const auto place = [&](std::uint32_t at, int offset) {
            const auto last = static_cast<std::int64_t>(source_.width) - 1;
            return static_cast<std::uint32_t>(std::clamp<std::int64_t>(std::int64_t{at} * scale_ + offset, 0, last));
        };
        return line_of(source_.surface, tap.part, source_.width, source_.texel_bytes, place(x, tap.dx),
                       place(y, tap.dy));
    }

  private:
    Shape source_;
    std::uint32_t scale_, alu_;
    std::vector<Tap> taps_;
};

// Instructions of the kernel (A20 to A24), each on vectors of four.
constexpr std::uint32_t kernel_setup = 14;    // unpack, 4 dots into the light's space, divide, bounds, result, modulate
constexpr std::uint32_t kernel_narrowing = 9; // 3 minima, compare, 2 reciprocals, subtract, log2, ceil
constexpr std::uint32_t kernel_region = 6;    // ceil, side, square, compare, root, step
constexpr std::uint32_t kernel_sample = 4;    // count and compare, coordinate, distance from the centre, sum
// Bias, compare, z - z_s, reciprocal, two products, bounds, clamp (two), extents, area with selection.
constexpr std::uint32_t kernel_layer = 11;
constexpr std::uint32_t filter_sample = 5; // coordinate, bias, compare, count and compare of the loop

class KernelShader final : public pipeline::ScreenShader {
  public:
    KernelShader(const ShadowPassSetup& setup, const std::vector<KernelWork>& work)
        : setup_(setup),
          packs_(packs_of(setup.map.captured)),
          slope_packs_(setup.map.gscale > 0.0F ? packs_of(setup.map.layers) : 0) {
        for (std::uint32_t y = 0; y < setup.height; y += 2)
            for (std::uint32_t x = 0; x < setup.width; x += 2) longest_.push_back(longest(work, x, y));
    }

    std::uint32_t alu(std::uint32_t x, std::uint32_t y) const override { return instructions(at(x, y)); }
    std::uint32_t fetches(std::uint32_t x, std::uint32_t y) const override { return count(at(x, y)); }

    std::uint64_t line(std::uint32_t x, std::uint32_t y, std::uint32_t fetch) const override {
        const std::uint32_t bytes = shadow_texel_bytes(setup_.map.format);
        if (fetch < g_buffer) {
            const Surface target = fetch == 0 ? Surface::colours : Surface::positions;
            return line_of(target, 0, setup_.width, bytes, x, y);
        }
        const KernelWork& work = at(x, y);
        fetch -= g_buffer;
        if (fetch < taps_per_level * work.narrowings) return level_line(work, fetch);
        fetch -= taps_per_level * work.narrowings;
        const std::uint32_t per_sample = packs_ + slope_packs_;
        const std::uint32_t sample = fetch / per_sample, part = fetch % per_sample;
        const float reach = static_cast<float>(work.across) * work.step / 2.0F;
        const auto texel = [&](float centre, std::uint32_t number) {
            const float place = centre + (static_cast<float>(number) + 0.5F) * work.step - reach;
            return static_cast<std::uint32_t>(
                std::clamp(place, 0.0F, static_cast<float>(setup_.map.resolution) - 1.0F));
        };
        const bool packed = part < packs_;
        return line_of(packed ? Surface::packed : Surface::slopes, packed ? part : part - packs_, setup_.map.resolution,
                       bytes, texel(work.u, sample % work.across), texel(work.v, sample / work.across));
    }

  private:
    static constexpr std::uint32_t g_buffer = 2, taps_per_level = 4;

    const KernelWork& at(std::uint32_t x, std::uint32_t y) const {
        return longest_[std::size_t{y / 2} * ((setup_.width + 1) / 2) + x / 2];
    }

    std::uint32_t count(const KernelWork& work) const {
        if (work.skipped) return 1; // black and background tell by their colour
        return g_buffer + taps_per_level * work.narrowings +
               std::uint32_t{work.across} * work.across * (packs_ + slope_packs_);
    }

    std::uint32_t instructions(const KernelWork& work) const {
        if (work.skipped) return 2; // compare, leave
        const std::uint32_t samples = std::uint32_t{work.across} * work.across;
        if (setup_.kernel.method != ShadowMethod::layered) return kernel_setup + samples * filter_sample;
        const std::uint32_t slopes = setup_.map.gscale > 0.0F ? 1 : 0; // one maximum for each
        return kernel_setup + work.narrowings * kernel_narrowing + kernel_region +
               samples * (kernel_sample + setup_.map.layers * (kernel_layer + slopes));
    }

    std::uint64_t level_line(const KernelWork& work, std::uint32_t fetch) const {
        const std::uint32_t narrowing = std::min<std::uint32_t>(fetch / taps_per_level, 3),
                            tap = fetch % taps_per_level;
        const std::uint32_t level = work.level[narrowing], size = setup_.map.resolution >> level;
        const auto texel = [&](float centre, std::uint32_t further) {
            const float place = centre / static_cast<float>(1U << level) - 0.5F + static_cast<float>(further);
            return static_cast<std::uint32_t>(std::clamp(place, 0.0F, static_cast<float>(size) - 1.0F));
        };
        return line_of(Surface::hierarchy, level, size, shadow_texel_bytes(setup_.map.format), texel(work.u, tap % 2),
                       texel(work.v, tap / 2));
    }

    /// Of the quad's pixels, the one that executes most.
    KernelWork longest(const std::vector<KernelWork>& work, std::uint32_t x, std::uint32_t y) const {
        const KernelWork* longest = nullptr;
        for (std::uint32_t i = 0; i < 4; ++i) {
            if (x + i % 2 >= setup_.width || y + i / 2 >= setup_.height) continue;
            const KernelWork& one = work[std::size_t{y + i / 2} * setup_.width + x + i % 2];
            if (longest == nullptr || instructions(one) > instructions(*longest)) longest = &one;
        }
        return *longest;
    }

    ShadowPassSetup setup_;
    std::uint32_t packs_, slope_packs_;
    std::vector<KernelWork> longest_; ///< by quad, row by row
};

std::vector<PlainShader::Tap> taps_of_parts(std::uint32_t parts, std::initializer_list<std::array<int, 2>> places) {
    std::vector<PlainShader::Tap> taps;
    for (const auto& place : places)
        for (std::uint32_t part = 0; part < parts; ++part) taps.push_back({part, place[0], place[1]});
    return taps;
}

Shape kbuffer_shape(const ShadowPassSetup& setup) { return {Surface::kbuffer, setup.map.resolution, 16}; }

// From depths of the k-buffer, four in a target, to distances in the map's format.
pipeline::ScreenPass pack_pass(const ShadowPassSetup& setup) {
    const std::uint32_t parts = packs_of(setup.map.captured);
    const std::uint32_t alu = parts * 3 + 1; // multiply-add, reciprocal of four, bound; address
    return {"pack",
            setup.map.resolution,
            setup.map.resolution,
            parts * shadow_texel_bytes(setup.map.format),
            16,
            4,
            std::make_shared<PlainShader>(kbuffer_shape(setup), 1, alu, taps_of_parts(parts, {{0, 0}}))};
}

pipeline::ScreenPass slope_pass(const ShadowPassSetup& setup) {
    const std::uint32_t parts = packs_of(setup.map.layers);
    const std::uint32_t alu = parts * (3 * 2 + 6) + 2; // as above three times; differences, maxima, scale, bound
    return {
        "slopes",
        setup.map.resolution,
        setup.map.resolution,
        parts * shadow_texel_bytes(setup.map.format),
        16,
        6,
        std::make_shared<PlainShader>(kbuffer_shape(setup), 1, alu, taps_of_parts(parts, {{0, 0}, {1, 0}, {0, 1}}))};
}

// The first level is read from the packed depths, whose first channel it is.
pipeline::ScreenPass hierarchy_pass(const ShadowPassSetup& setup, std::uint32_t level) {
    const std::uint32_t size = setup.map.resolution >> level, bytes = shadow_texel_bytes(setup.map.format);
    Shape source{Surface::packed, size * 2, bytes};
    const std::uint32_t part = level == 1 ? 0 : level - 1;
    if (level > 1) source.surface = Surface::hierarchy;
    std::vector<PlainShader::Tap> taps = taps_of_parts(1, {{0, 0}, {1, 0}, {0, 1}, {1, 1}});
    for (PlainShader::Tap& tap : taps) tap.part = part;
    return {fmt::format("least depths {}", size),
            size,
            size,
            bytes,
            bytes,
            4,
            std::make_shared<PlainShader>(source, 2, 4, std::move(taps))};
}

std::uint32_t levels_of(std::uint32_t resolution) {
    std::uint32_t levels = 0;
    for (; resolution > 1; resolution /= 2) ++levels;
    return levels;
}

std::uint64_t map_bytes(const ShadowPassSetup& setup) {
    return std::uint64_t{setup.map.resolution} * setup.map.resolution * shadow_texel_bytes(setup.map.format);
}

} // namespace

KernelWork kernel_work(const SearchRegion& region) {
    return {.u = region.u,
            .v = region.v,
            .step = region.step,
            .across = static_cast<std::uint16_t>(region.across),
            .narrowings = static_cast<std::uint8_t>(std::min(region.narrowings, 255U)),
            .skipped = false,
            .level = region.level};
}

std::vector<pipeline::ScreenPass> shadow_passes(const ShadowPassSetup& setup, const std::vector<KernelWork>& work) {
    std::vector<pipeline::ScreenPass> passes;
    passes.push_back(pack_pass(setup));
    if (setup.map.gscale > 0.0F) passes.push_back(slope_pass(setup));
    if (setup.map.hierarchy)
        for (std::uint32_t level = 1; level <= levels_of(setup.map.resolution); ++level)
            passes.push_back(hierarchy_pass(setup, level));
    constexpr std::uint32_t picture_bytes = 4, registers = 12;
    passes.push_back({"shadow kernel", setup.width, setup.height, picture_bytes, shadow_texel_bytes(setup.map.format),
                      registers, std::make_shared<KernelShader>(setup, work)});
    return passes;
}

std::vector<SavedPass> saved_passes(const ShadowPassSetup& setup) {
    std::vector<SavedPass> saved;
    if (setup.map.gscale <= 0.0F)
        saved.push_back({"slopes", "no slope bias: gscale is 0",
                         packs_of(setup.map.layers) *
                             (map_bytes(setup) + std::uint64_t{16} * setup.map.resolution * setup.map.resolution)});
    if (!setup.map.hierarchy) // each level is written once and read once
        saved.push_back({"least depths", "the search region is not narrowed: iterations is 0",
                         map_bytes(setup) + 2 * (map_bytes(setup) / 3)});
    return saved;
}

} // namespace traces
