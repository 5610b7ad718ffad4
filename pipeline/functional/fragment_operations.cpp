#include "pipeline/functional/fragment_operations.hpp"

#include "pipeline/functional/surface_texel.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace pipeline {

namespace {

using Codes = glm::tvec4<std::uint8_t>;

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

glm::vec4 write_through(SurfaceFormat format, BlendMode mode, const glm::vec4& source, const glm::vec4& stored) {
    if (mode == BlendMode::replace) return through_format(format, source);
    if (format != SurfaceFormat::rgba8) return through_format(format, blend(mode, source, stored));
    std::array<std::byte, 4> bytes{};
    const auto code = [&bytes](const glm::vec4& colour) {
        pack_colour(SurfaceFormat::rgba8, colour, bytes.data());
        return std::bit_cast<glm::tvec4<std::uint8_t>>(bytes);
    };
    bytes = std::bit_cast<std::array<std::byte, 4>>(blend(mode, code(source), code(stored)));
    return unpack_texel(SurfaceFormat::rgba8, bytes.data());
}

} // namespace pipeline
