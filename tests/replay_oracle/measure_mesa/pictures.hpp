// Pixels of what is drawn to.
#pragma once

#include <cstdint>
#include <vector>

namespace measure {

struct Picture {
    std::uint32_t width = 0, height = 0; ///< 0: there is none
    std::vector<std::uint8_t> rgba;      ///< bottom row first
};

/// Of the first colour that is drawn to now; none where there is no colour, or it has several samples.
Picture picture_of_draw_buffer();
/// Of what the window is about to show.
Picture picture_of_window();

} // namespace measure
