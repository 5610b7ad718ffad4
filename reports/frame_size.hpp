// The size of a frame, and the samples of its pixels, as users write them.
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

/// Samples of a pixel: "1", "4" or "8"; nothing for any other text.
std::optional<std::uint32_t> sample_count(std::string_view text);

} // namespace reports
