// Legends below pictures: text, colour samples and scales with numbers. The picture itself keeps its pixel positions.
#pragma once

#include "reports/images.hpp"

#include <string>
#include <string_view>

namespace reports {

/// A sample of a colour and what it means.
struct Swatch {
    Colour colour{};
    std::string text;
};

/// A number on a scale; `position` in [0, 1].
struct Tick {
    double position = 0;
    std::string text;
};

struct Legend {
    std::string title;
    Colour (*ramp)(double position) = nullptr; ///< drawn as a bar when given
    std::vector<Tick> ticks;                   ///< below the bar
    std::vector<Swatch> swatches;              ///< one a line
};

/// A copy of `picture` with the legend below it; made wider when the text needs it.
Picture with_legend(const Picture& picture, const Legend& legend);

/// Draws text with its top left dot at (x, y), each dot `scale` x `scale` pixels; what lies outside is cut off.
void draw_text(Picture& picture, std::uint32_t x, std::uint32_t y, std::string_view text, std::uint32_t scale,
               Colour colour);
/// Pixels that the text takes.
std::uint32_t text_width(std::string_view text, std::uint32_t scale);

} // namespace reports
