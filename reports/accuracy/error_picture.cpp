#include "reports/accuracy/error_picture.hpp"

#include "reports/colours.hpp"
#include "reports/legend.hpp"
#include "reports/pictures.hpp"

#include <fmt/format.h>

namespace reports {

namespace {

constexpr Colour acne_colour{255, 60, 60}, dark_colour{70, 110, 255}, bright_colour{255, 214, 40};
constexpr Colour silhouette_colour{0, 84, 70};

Colour grey(float visible) { return encode_srgb(visible, visible, visible); }

Colour error_colour(float seen, float truth, PixelKind kind) {
    if (kind == PixelKind::background) return {0, 0, 0};
    if (kind == PixelKind::silhouette) return silhouette_colour;
    switch (shadow_error_kind(seen, truth)) {
    case ShadowErrorKind::acne:
        return acne_colour;
    case ShadowErrorKind::too_dark:
        return dark_colour;
    case ShadowErrorKind::too_bright:
        return bright_colour;
    case ShadowErrorKind::small:
        break;
    }
    return grey(0.1F * truth);
}

// Calls paint(pixel, panel) for the pixels of three panels.
template <class Paint>
Picture three_panels(std::uint32_t width, std::uint32_t height, Paint paint) {
    Picture result(3 * width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t panel = 0; panel < 3; ++panel)
            for (std::uint32_t x = 0; x < width; ++x)
                result.pixels[(std::size_t{y} * 3 + panel) * width + x] = paint(std::size_t{y} * width + x, panel);
    return result;
}

} // namespace

Picture shadow_error_picture(const pipeline::View& view, std::span<const float> picture, std::span<const float> truth,
                             std::span<const PixelKind> kinds, const std::string& title) {
    const Picture panels = three_panels(view.width, view.height, [&](std::size_t pixel, std::uint32_t panel) {
        const float seen = picture[4 * pixel + 3];
        if (panel == 0) return grey(seen);
        return panel == 1 ? grey(truth[pixel]) : error_colour(seen, truth[pixel], kinds[pixel]);
    });
    Legend legend;
    legend.title = title + ": visible light, by ray tracing, errors";
    legend.swatches = {{acne_colour, "acne: a lit point lost more than a quarter"},
                       {dark_colour, "too dark by more than a tenth"},
                       {bright_colour, "too bright by more than a tenth"},
                       {silhouette_colour, "silhouettes, not compared"}};
    return with_legend(panels, legend);
}

Picture picture_error_picture(std::span<const float> picture, const Truth& truth, const std::string& title) {
    const Picture panels = three_panels(truth.width, truth.height, [&](std::size_t pixel, std::uint32_t panel) {
        if (panel < 2) {
            const float* rgb = panel == 0 ? &picture[4 * pixel] : &truth.colours[4 * pixel];
            return encode_srgb(rgb[0], rgb[1], rgb[2]);
        }
        if (truth.doubtful(pixel))
            return empty_colour(static_cast<std::uint32_t>(pixel % truth.width),
                                static_cast<std::uint32_t>(pixel / truth.width));
        return heat(difference_gain * pixel_difference(picture, truth.colours, pixel));
    });
    Legend legend;
    legend.title = fmt::format("{}: picture, by ray tracing, difference x {}", title, difference_gain);
    legend.ramp = heat;
    for (const double at : {0.0, 0.5, 1.0})
        legend.ticks.push_back({at, fmt::format("{}{:.3g}", at == 1.0 ? ">=" : "", at / difference_gain)});
    legend.swatches = {{empty_colour(0, 0), "chequered: at silhouettes, not compared"}};
    return with_legend(panels, legend);
}

} // namespace reports
