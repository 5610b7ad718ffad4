#include "reports/pictures.hpp"

#include "reports/colours.hpp"
#include "reports/legend.hpp"
#include "reports/numbers.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace reports {

namespace {

constexpr std::array<Colour, 4> hazard_colours{{{255, 92, 60}, {255, 214, 40}, {56, 204, 255}, {236, 96, 255}}};
constexpr std::array<const char*, 4> hazard_texts{"H1 in flight", "H2 write path", "H3 stale line", "H4 torn read"};
constexpr Colour kbuffer_only{24, 140, 132};

Colour dimmed(std::span<const float> rgba, std::size_t pixel) {
    // Rec. 709 luminance; a tenth of the light leaves a third of the displayed brightness.
    const float* linear = &rgba[4 * pixel];
    const float grey = 0.1F * (0.2126F * linear[0] + 0.7152F * linear[1] + 0.0722F * linear[2]);
    return encode_srgb(grey, grey, grey);
}

Legend depth_legend(std::uint32_t layer, DepthRange range) {
    Legend legend;
    legend.title = fmt::format("Layer {}: window depth", layer);
    legend.ramp = depth_shade;
    for (const double at : {0.0, 0.25, 0.5, 0.75, 1.0})
        legend.ticks.push_back({at, fmt::format("{:.5g}", range.near + at * (range.far - range.near))});
    legend.swatches.push_back({empty_colour(0, 0), "chequered: no entry"});
    return legend;
}

Picture colour_layer(Size size, const KBufferLayout& layout, std::span<const float> kbuffer, std::uint32_t layer) {
    Picture picture(size.width, size.height);
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel) {
        const auto entry = layout.entry(kbuffer, pixel, layer);
        const auto x = static_cast<std::uint32_t>(pixel % size.width);
        const auto y = static_cast<std::uint32_t>(pixel / size.width);
        picture.pixels[pixel] =
            layout.is_empty(kbuffer, pixel, layer) ? empty_colour(x, y) : encode_srgb(entry[0], entry[1], entry[2]);
    }
    return picture;
}

Picture depth_layer(Size size, const KBufferLayout& layout, std::span<const float> kbuffer, std::uint32_t layer,
                    DepthRange range) {
    const double extent = std::max(range.far - range.near, 1e-30F);
    Picture picture(size.width, size.height);
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel) {
        const auto x = static_cast<std::uint32_t>(pixel % size.width);
        const auto y = static_cast<std::uint32_t>(pixel / size.width);
        const double z = layout.depth(kbuffer, pixel, layer);
        picture.pixels[pixel] =
            layout.is_empty(kbuffer, pixel, layer) ? empty_colour(x, y) : depth_shade((z - range.near) / extent);
    }
    return with_legend(picture, depth_legend(layer, range));
}

Legend hazard_legend(const pipeline::HazardCounts& counts, const std::string& design) {
    Legend legend;
    legend.title = counts.total() == 0 ? fmt::format("{}: no hazards", design)
                                       : fmt::format("{}: {}, {}", design, counted(counts.total(), "hazard"),
                                                     counted(counts.pixels, "pixel"));
    for (std::size_t cause = 0; cause < pipeline::hazard_classes; ++cause)
        legend.swatches.push_back(
            {hazard_colours[cause], fmt::format("{}: {}", hazard_texts[cause],
                                                with_commas(counts.of(static_cast<pipeline::HazardClass>(cause))))});
    return legend;
}

// A difference above 0 is never as dark as no difference.
Colour difference_heat(double position) { return heat(position <= 0.0 ? 0.0 : 0.35 + 0.65 * position); }

Legend difference_legend(std::uint32_t factor, std::size_t differing, std::size_t wrong, const std::string& design) {
    Legend legend;
    legend.title = fmt::format("{}: difference x {}, {} px", design, factor, with_commas(differing));
    legend.ramp = difference_heat;
    for (const double at : {0.0, 0.25, 0.5, 0.75, 1.0})
        legend.ticks.push_back({at, fmt::format("{}{:.3g}", at == 1.0 ? ">=" : "", at / factor)});
    if (wrong > 0) legend.swatches.push_back({kbuffer_only, fmt::format("k-buffer only: {} px", with_commas(wrong))});
    return legend;
}

struct Complexity {
    std::uint64_t covered = 0, fragments = 0;
    std::uint32_t highest = 0;
    std::uint32_t shown = 1; ///< number at the end of the scale
};

Complexity complexity_of(std::span<const std::uint32_t> counts) {
    Complexity result;
    std::vector<std::uint32_t> covered;
    for (const std::uint32_t count : counts)
        if (count > 0) covered.push_back(count);
    for (const std::uint32_t count : covered) result.fragments += count;
    result.covered = covered.size();
    if (covered.empty()) return result;
    result.highest = *std::max_element(covered.begin(), covered.end());
    const auto rank = static_cast<std::ptrdiff_t>((covered.size() - 1) * 999 / 1000);
    std::nth_element(covered.begin(), covered.begin() + rank, covered.end());
    // A few very deep pixels must not darken all others.
    const std::uint32_t usual = covered[static_cast<std::size_t>(rank)];
    result.shown = result.highest > 2 * usual ? usual : result.highest;
    return result;
}

Legend overlap_legend(const Complexity& complexity) {
    const double mean = complexity.covered == 0
                            ? 0.0
                            : static_cast<double>(complexity.fragments) / static_cast<double>(complexity.covered);
    Legend legend;
    legend.title = fmt::format("Fragments per pixel: mean {:.2f}, max {}", mean, complexity.highest);
    legend.ramp = heat;
    const std::uint32_t step = (complexity.shown + 9) / 10;
    for (std::uint32_t number = 0; number <= complexity.shown; number += step)
        legend.ticks.push_back({static_cast<double>(number) / complexity.shown, std::to_string(number)});
    if (complexity.shown < complexity.highest) legend.ticks.back().text.insert(0, ">=");
    return legend;
}

} // namespace

Colour hazard_colour(std::size_t kind) { return hazard_colours.at(kind); }

Picture composite_picture(Size size, std::span<const float> rgba) {
    CHECK(rgba.size() == 4 * size.pixels());
    Picture picture(size.width, size.height);
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel)
        picture.pixels[pixel] = encode_srgb(rgba[4 * pixel], rgba[4 * pixel + 1], rgba[4 * pixel + 2]);
    return picture;
}

DepthRange depth_range(const KBufferLayout& layout, std::span<const float> kbuffer, std::size_t pixels) {
    DepthRange range{INFINITY, -INFINITY};
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
        for (std::uint32_t layer = 0; layer < layout.layers(); ++layer)
            if (!layout.is_empty(kbuffer, pixel, layer)) {
                const float z = layout.depth(kbuffer, pixel, layer);
                range = {std::min(range.near, z), std::max(range.far, z)};
            }
    return range.near > range.far ? DepthRange{} : range;
}

Picture layer_picture(Size size, const KBufferLayout& layout, std::span<const float> kbuffer, std::uint32_t layer,
                      DepthRange range) {
    return layout.has_colour() ? colour_layer(size, layout, kbuffer, layer)
                               : depth_layer(size, layout, kbuffer, layer, range);
}

Picture hazard_picture(Size size, std::span<const float> rgba, std::span<const std::uint8_t> mask,
                       const pipeline::HazardCounts& counts, const std::string& design) {
    CHECK(mask.empty() || mask.size() == size.pixels());
    Picture picture(size.width, size.height);
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel) {
        const unsigned classes = mask.empty() ? 0U : mask[pixel];
        picture.pixels[pixel] = classes == 0
                                    ? dimmed(rgba, pixel)
                                    : hazard_colours[static_cast<std::size_t>(std::bit_width(classes & 15U)) - 1];
    }
    return with_legend(picture, hazard_legend(counts, design));
}

float pixel_difference(std::span<const float> rgba, std::span<const float> reference, std::size_t pixel) {
    float largest = 0;
    for (std::size_t i = 4 * pixel; i < 4 * pixel + 3; ++i)
        largest = std::max(largest, std::abs(std::clamp(rgba[i], 0.0F, 1.0F) - std::clamp(reference[i], 0.0F, 1.0F)));
    return largest;
}

void DifferenceScale::note(Size size, std::span<const float> rgba, std::span<const float> reference) {
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel) {
        const float difference = pixel_difference(rgba, reference, pixel);
        if (difference > 0)
            ++counts_[static_cast<std::size_t>(std::clamp(-std::ilogb(difference) - 1, 0, static_cast<int>(bins) - 1))];
    }
}

std::uint32_t DifferenceScale::factor() const {
    std::uint64_t total = 0;
    for (const std::uint64_t count : counts_) total += count;
    if (total == 0) return 1;
    // Differences in bin i, times 2^i, are at most 1.
    std::uint64_t larger = 0;
    std::uint32_t factor = 1;
    for (std::size_t bin = 0; bin + 2 < bins && 100 * (larger + counts_[bin]) <= total; ++bin) {
        larger += counts_[bin];
        factor *= 2;
    }
    return factor;
}

Picture difference_picture(Size size, std::span<const float> rgba, std::span<const float> reference,
                           std::span<const std::uint8_t> wrong, std::uint32_t factor, const std::string& design) {
    Picture picture(size.width, size.height);
    std::size_t differing = 0, only_stored = 0;
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel) {
        const double difference = pixel_difference(rgba, reference, pixel);
        const bool stored = difference == 0 && !wrong.empty() && wrong[pixel] != 0;
        picture.pixels[pixel] = stored ? kbuffer_only : difference_heat(difference * factor);
        differing += difference > 0;
        only_stored += stored;
    }
    return with_legend(picture, difference_legend(factor, differing, only_stored, design));
}

Picture value_picture(Size size, std::span<const float> values, const pipeline::SurfacePicture& shown) {
    const auto grey = [](double position) {
        const auto code = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(position, 0.0, 1.0)));
        return Colour{code, code, code};
    };
    const double extent = std::max(static_cast<double>(shown.high) - shown.low, 1e-30);
    Picture picture(size.width, size.height);
    CHECK(values.size() == picture.pixels.size());
    for (std::size_t pixel = 0; pixel < picture.pixels.size(); ++pixel)
        picture.pixels[pixel] = grey((values[pixel] - shown.low) / extent);
    Legend legend;
    legend.title = shown.title;
    legend.ramp = grey;
    for (const double at : {0.0, 0.25, 0.5, 0.75, 1.0})
        legend.ticks.push_back({at, fmt::format("{:.4g}", shown.low + at * extent)});
    return with_legend(picture, legend);
}

Picture overlap_picture(Size size, std::span<const std::uint32_t> depth_complexity) {
    CHECK(depth_complexity.size() == size.pixels());
    const Complexity complexity = complexity_of(depth_complexity);
    Picture picture(size.width, size.height);
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel)
        picture.pixels[pixel] = heat(static_cast<double>(depth_complexity[pixel]) / complexity.shown);
    return with_legend(picture, overlap_legend(complexity));
}

} // namespace reports
