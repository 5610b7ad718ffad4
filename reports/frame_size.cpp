#include "reports/frame_size.hpp"

#include "pipeline/functional/sample_pattern.hpp"

#include <charconv>

namespace reports {

namespace {

std::optional<std::uint32_t> number_of(std::string_view text) {
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::optional<std::uint32_t> side_of(std::string_view text) {
    const auto side = number_of(text);
    return side && *side >= 1 && *side <= largest_side ? side : std::nullopt;
}

} // namespace

std::optional<FrameSize> frame_size(std::string_view text) {
    const std::size_t x = text.find('x');
    if (x == std::string_view::npos) return std::nullopt;
    const auto width = side_of(text.substr(0, x)), height = side_of(text.substr(x + 1));
    if (!width || !height) return std::nullopt;
    return FrameSize{*width, *height};
}

std::optional<std::uint32_t> sample_count(std::string_view text) {
    const auto samples = number_of(text);
    return samples && pipeline::is_sample_count(*samples) ? samples : std::nullopt;
}

} // namespace reports
