#include "reports/legend.hpp"

#include "reports/glyphs.hpp"

#include <algorithm>
#include <cmath>

namespace reports {

namespace {

constexpr Colour paper{24, 24, 28};
constexpr Colour ink{236, 236, 240};
constexpr Colour frame_line{150, 150, 156};
constexpr std::uint32_t advance = glyph_width + 1;

void fill(Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
          Colour colour) {
    for (std::uint32_t row = y; row < std::min(y + height, picture.height); ++row)
        for (std::uint32_t column = x; column < std::min(x + width, picture.width); ++column)
            picture.at(column, row) = colour;
}

// Sizes in pixels, from the size of a dot.
struct Layout {
    std::uint32_t dot = 1;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t margin() const { return 6 * dot; }
    std::uint32_t line() const { return (glyph_height + 4) * dot; }
    std::uint32_t bar() const { return 10 * dot; }
    std::uint32_t sample() const { return 12 * dot; }
};

// Ticks closer than their texts are wide would overlap: the wider canvas makes room for all of them side by side.
std::uint32_t ticks_width(const std::vector<Tick>& ticks, std::uint32_t dot) {
    std::uint32_t width = 0;
    for (const Tick& tick : ticks) width += text_width(tick.text, dot) + 2 * advance * dot;
    return width;
}

Layout layout_of(const Picture& picture, const Legend& legend) {
    Layout layout;
    layout.dot = picture.width >= 400 ? 2 : 1;
    std::uint32_t widest = text_width(legend.title, layout.dot);
    for (const Swatch& swatch : legend.swatches)
        widest = std::max(widest, 2 * layout.sample() + text_width(swatch.text, layout.dot));
    if (legend.ramp != nullptr) widest = std::max(widest, ticks_width(legend.ticks, layout.dot));
    layout.width = std::max(picture.width, widest + 2 * layout.margin());
    layout.height = 2 * layout.margin() + layout.line() * static_cast<std::uint32_t>(legend.swatches.size());
    if (!legend.title.empty()) layout.height += layout.line();
    if (legend.ramp != nullptr) layout.height += layout.bar() + 3 * layout.dot + layout.line();
    return layout;
}

std::uint32_t draw_scale(Picture& canvas, const Layout& layout, std::uint32_t y, const Legend& legend) {
    const std::uint32_t left = layout.margin();
    const std::uint32_t width = layout.width - 2 * left;
    for (std::uint32_t x = 0; x < width; ++x)
        fill(canvas, left + x, y, 1, layout.bar(),
             legend.ramp(width == 1 ? 0.0 : static_cast<double>(x) / static_cast<double>(width - 1)));
    const std::uint32_t below = y + layout.bar();
    for (const Tick& tick : legend.ticks) {
        const double along = std::clamp(tick.position, 0.0, 1.0) * static_cast<double>(width - 1);
        const std::uint32_t at = left + static_cast<std::uint32_t>(std::lround(along));
        fill(canvas, at, below, layout.dot, 2 * layout.dot, frame_line);
        // Centred below its mark, but inside the bar's ends.
        const std::uint32_t text = text_width(tick.text, layout.dot);
        const std::uint32_t start = std::max(at, left + text / 2) - text / 2;
        draw_text(canvas, std::min(start, left + width - std::min(width, text)), below + 3 * layout.dot, tick.text,
                  layout.dot, ink);
    }
    return below + 3 * layout.dot + layout.line();
}

} // namespace

std::uint32_t text_width(std::string_view text, std::uint32_t scale) {
    return text.empty() ? 0 : (static_cast<std::uint32_t>(text.size()) * advance - 1) * scale;
}

void draw_text(Picture& picture, std::uint32_t x, std::uint32_t y, std::string_view text, std::uint32_t scale,
               Colour colour) {
    for (const char character : text) {
        const Glyph& glyph = glyph_of(character);
        for (std::uint32_t row = 0; row < glyph_height; ++row)
            for (std::uint32_t column = 0; column < glyph_width; ++column)
                if ((glyph[row] >> (glyph_width - 1 - column) & 1) != 0)
                    fill(picture, x + column * scale, y + row * scale, scale, scale, colour);
        x += advance * scale;
    }
}

Picture with_legend(const Picture& picture, const Legend& legend) {
    const Layout layout = layout_of(picture, legend);
    Picture canvas(layout.width, picture.height + layout.height, paper);
    for (std::uint32_t y = 0; y < picture.height; ++y) std::copy_n(&picture.at(0, y), picture.width, &canvas.at(0, y));
    std::uint32_t y = picture.height + layout.margin();
    if (!legend.title.empty()) {
        draw_text(canvas, layout.margin(), y, legend.title, layout.dot, ink);
        y += layout.line();
    }
    if (legend.ramp != nullptr) y = draw_scale(canvas, layout, y, legend);
    for (const Swatch& swatch : legend.swatches) {
        fill(canvas, layout.margin(), y, layout.sample(), glyph_height * layout.dot, swatch.colour);
        draw_text(canvas, layout.margin() + 2 * layout.sample() - 8 * layout.dot, y, swatch.text, layout.dot, ink);
        y += layout.line();
    }
    return canvas;
}

} // namespace reports
