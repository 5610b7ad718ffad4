// Light that surfaces send out, in the bits that G-buffers leave free.
// Source: specification 003, T3.1: 16 bits of the third target are unused. Its split is ours.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace traces {

/// A number of 0 to 1 in `most` steps, rounded to the nearest; halves go up.
inline std::uint32_t emission_code(float value, std::uint32_t most) {
    return static_cast<std::uint32_t>(std::floor(std::clamp(value, 0.0F, 1.0F) * static_cast<float>(most) + 0.5F));
}

/// Of 5 bits red, 6 green and 5 blue.
inline std::uint32_t emission_16(const glm::vec3& light) {
    return emission_code(light.r, 31) << 11U | emission_code(light.g, 63) << 5U | emission_code(light.b, 31);
}
inline glm::vec3 emission_of_16(std::uint32_t code) {
    return {static_cast<float>(code >> 11U & 31U) / 31.0F, static_cast<float>(code >> 5U & 63U) / 63.0F,
            static_cast<float>(code & 31U) / 31.0F};
}
/// As two channels of 8 bits, the upper byte first.
inline glm::vec2 emission_channels(const glm::vec3& light) {
    const std::uint32_t code = emission_16(light);
    return {static_cast<float>(code >> 8U) / 255.0F, static_cast<float>(code & 255U) / 255.0F};
}
inline glm::vec3 emission_of_channels(const glm::vec2& channels) {
    return emission_of_16(emission_code(channels.x, 255) << 8U | emission_code(channels.y, 255));
}

/// Of 4 bits each.
inline std::uint32_t emission_12(const glm::vec3& light) {
    return emission_code(light.r, 15) << 8U | emission_code(light.g, 15) << 4U | emission_code(light.b, 15);
}
inline glm::vec3 emission_of_12(std::uint32_t code) {
    return glm::vec3(code >> 8U & 15U, code >> 4U & 15U, code & 15U) / 15.0F;
}

/// Scale and round three parts, and gather them by a dot product; and the way back.
inline constexpr std::uint32_t slots_to_pack_emission = 3, slots_to_unpack_emission = 3;

} // namespace traces
