#include "reports/colours.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace reports {

namespace {

// Control points at equal distances.
constexpr std::array<Colour, 7> heat_points{
    {{10, 10, 28}, {48, 24, 110}, {128, 38, 128}, {206, 62, 88}, {244, 128, 44}, {250, 200, 84}, {255, 255, 224}}};
constexpr std::array<Colour, 3> depth_points{{{255, 250, 238}, {236, 160, 84}, {84, 26, 34}}};

Colour interpolate(std::span<const Colour> points, double position) {
    const double scaled = std::clamp(position, 0.0, 1.0) * static_cast<double>(points.size() - 1);
    const auto left = std::min(static_cast<std::size_t>(scaled), points.size() - 2);
    const double right = scaled - static_cast<double>(left);
    Colour colour{};
    for (std::size_t i = 0; i < 3; ++i)
        colour[i] =
            static_cast<std::uint8_t>(std::lround((1.0 - right) * points[left][i] + right * points[left + 1][i]));
    return colour;
}

} // namespace

std::uint8_t encode_srgb(float linear) {
    if (!(linear > 0.0F)) return 0;
    if (linear >= 1.0F) return 255;
    const double value = linear;
    const double encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(encoded * 255.0));
}

Colour encode_srgb(float red, float green, float blue) {
    return {encode_srgb(red), encode_srgb(green), encode_srgb(blue)};
}

Colour heat(double position) { return interpolate(heat_points, std::isnan(position) ? 1.0 : position); }

Colour depth_shade(double position) { return interpolate(depth_points, std::isnan(position) ? 1.0 : position); }

Colour empty_colour(std::uint32_t x, std::uint32_t y) {
    constexpr std::uint32_t cell = 8;
    return (x / cell + y / cell) % 2 == 0 ? Colour{66, 72, 86} : Colour{78, 84, 100};
}

} // namespace reports
