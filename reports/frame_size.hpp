// The size of a frame as users write it.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace reports {

constexpr std::uint32_t largest_side = 16384; ///< pixels

struct FrameSize {
    std::uint32_t width = 0, height = 0; ///< pixels
};

/// "512x256"; nothing for any other text, and for a side that is not 1 to largest_side pixels.
std::optional<FrameSize> frame_size(std::string_view text);

} // namespace reports
