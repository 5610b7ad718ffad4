#include "reports/frame_size.hpp"

#include <charconv>

namespace reports {

namespace {

std::optional<std::uint32_t> side_of(std::string_view text) {
    std::uint32_t side = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if (side < 1 || side > largest_side) return std::nullopt;
    return side;
}

} // namespace

std::optional<FrameSize> frame_size(std::string_view text) {
    const std::size_t x = text.find('x');
    if (x == std::string_view::npos) return std::nullopt;
    const auto width = side_of(text.substr(0, x)), height = side_of(text.substr(x + 1));
    if (!width || !height) return std::nullopt;
    return FrameSize{*width, *height};
}

} // namespace reports
