#include "pipeline/functional/colour_format.hpp"

#include "pipeline/functional/number_formats.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace pipeline {

namespace {

using Codes = glm::tvec4<std::uint8_t>;

float saturated(float value, float largest) {
    if (std::isnan(value)) return 0.0F;
    return std::clamp(value, -largest, largest);
}

std::uint8_t product(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t t = a * b + 128U;
    return static_cast<std::uint8_t>((t + (t >> 8U)) >> 8U);
}

std::uint8_t sum(std::uint32_t a, std::uint32_t b) { return static_cast<std::uint8_t>(std::min(a + b, 255U)); }

Codes over(const Codes& source, const Codes& target) {
    const std::uint8_t alpha = source.a;
    const auto rest = static_cast<std::uint8_t>(255 - alpha);
    Codes result;
    for (int i = 0; i < 3; ++i) result[i] = sum(product(source[i], alpha), product(target[i], rest));
    result.a = sum(alpha, product(target.a, rest));
    return result;
}

glm::vec4 over(const glm::vec4& source, const glm::vec4& target) {
    const float alpha = source.a;
    const float rest = 1.0F - alpha;
    glm::vec4 result;
    for (int i = 0; i < 3; ++i) result[i] = source[i] * alpha + target[i] * rest;
    result.a = alpha + target.a * rest;
    return result;
}

} // namespace

void pack_colour(ColourFormat format, const glm::vec4& colour, std::byte* target) {
    if (format == ColourFormat::rgba8) {
        for (int i = 0; i < 4; ++i) target[i] = static_cast<std::byte>(float_to_unorm8(colour[i]));
    } else if (format == ColourFormat::rgba16f) {
        std::array<std::uint16_t, 4> halves{};
        for (int i = 0; i < 4; ++i) halves[static_cast<std::size_t>(i)] = float_to_half(saturated(colour[i], 65504.0F));
        std::memcpy(target, halves.data(), sizeof(halves));
    } else {
        std::array<float, 4> floats{};
        for (int i = 0; i < 4; ++i)
            floats[static_cast<std::size_t>(i)] = saturated(colour[i], std::numeric_limits<float>::max());
        std::memcpy(target, floats.data(), sizeof(floats));
    }
}

glm::vec4 unpack_colour(ColourFormat format, const std::byte* source) {
    glm::vec4 colour;
    if (format == ColourFormat::rgba8) {
        for (int i = 0; i < 4; ++i) colour[i] = unorm8_to_float(static_cast<std::uint8_t>(source[i]));
    } else if (format == ColourFormat::rgba16f) {
        std::array<std::uint16_t, 4> halves{};
        std::memcpy(halves.data(), source, sizeof(halves));
        for (int i = 0; i < 4; ++i) colour[i] = half_to_float(halves[static_cast<std::size_t>(i)]);
    } else {
        std::array<float, 4> floats{};
        std::memcpy(floats.data(), source, sizeof(floats));
        for (int i = 0; i < 4; ++i) colour[i] = floats[static_cast<std::size_t>(i)];
    }
    return colour;
}

glm::vec4 through_format(ColourFormat format, const glm::vec4& colour) {
    std::array<std::byte, 16> bytes{};
    pack_colour(format, colour, bytes.data());
    return unpack_colour(format, bytes.data());
}

glm::vec4 blend(BlendMode mode, const glm::vec4& source, const glm::vec4& target) {
    glm::vec4 result = source;
    switch (mode) {
    case BlendMode::replace:
        break;
    case BlendMode::over:
        return over(source, target);
    case BlendMode::add:
        for (int i = 0; i < 4; ++i) result[i] = source[i] + target[i];
        break;
    case BlendMode::least:
        for (int i = 0; i < 4; ++i) result[i] = std::min(source[i], target[i]);
        break;
    case BlendMode::greatest:
        for (int i = 0; i < 4; ++i) result[i] = std::max(source[i], target[i]);
        break;
    }
    return result;
}

Codes blend(BlendMode mode, const Codes& source, const Codes& target) {
    Codes result = source;
    switch (mode) {
    case BlendMode::replace:
        break;
    case BlendMode::over:
        return over(source, target);
    case BlendMode::add:
        for (int i = 0; i < 4; ++i) result[i] = sum(source[i], target[i]);
        break;
    case BlendMode::least:
        for (int i = 0; i < 4; ++i) result[i] = std::min(source[i], target[i]);
        break;
    case BlendMode::greatest:
        for (int i = 0; i < 4; ++i) result[i] = std::max(source[i], target[i]);
        break;
    }
    return result;
}

glm::vec4 write_through(ColourFormat format, BlendMode mode, const glm::vec4& source, const glm::vec4& stored) {
    if (mode == BlendMode::replace) return through_format(format, source);
    if (format != ColourFormat::rgba8) return through_format(format, blend(mode, source, stored));
    std::array<std::byte, 4> bytes{};
    const auto code = [&bytes](const glm::vec4& colour) {
        pack_colour(ColourFormat::rgba8, colour, bytes.data());
        return std::bit_cast<glm::tvec4<std::uint8_t>>(bytes);
    };
    bytes = std::bit_cast<std::array<std::byte, 4>>(blend(mode, code(source), code(stored)));
    return unpack_colour(ColourFormat::rgba8, bytes.data());
}

} // namespace pipeline
