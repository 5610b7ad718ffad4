#include "tests/support/oracle_textures.hpp"

#include <algorithm>
#include <cmath>

namespace tests {

using traces::spirv::ImageDimension;
using traces::spirv::Texels;
using traces::spirv::TextureFetch;
using traces::spirv::TextureSample;
using traces::spirv::TextureSize;

namespace {

constexpr std::int32_t texels = oracle_texture_size;

/// OpenGL 4.5 core, section 8.13.
std::array<std::int32_t, 3> cube(float x, float y, float z) {
    const float ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
    float s = 0, t = 0, major = 0;
    std::int32_t face = 0;
    if (ax >= ay && ax >= az) {
        face = x > 0 ? 0 : 1, major = ax, s = x > 0 ? -z : z, t = -y;
    } else if (ay >= az) {
        face = y > 0 ? 2 : 3, major = ay, s = x, t = y > 0 ? z : -z;
    } else {
        face = z > 0 ? 4 : 5, major = az, s = z > 0 ? x : -x, t = -y;
    }
    const auto index = [&](float v) {
        return std::clamp(static_cast<std::int32_t>(std::floor((v / major + 1) / 2 * texels)), 0, texels - 1);
    };
    return {index(s), index(t), face};
}

} // namespace

/// A number in [0,1) that follows from a name.
float random_of(const std::string& name, std::uint32_t i) {
    std::uint32_t hash = 2166136261U; // FNV-1a
    for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619U;
    hash = (hash ^ i) * 2654435761U;
    hash = (hash ^ hash >> 15U) * 2246822519U;
    return static_cast<float>((hash ^ hash >> 13U) >> 8U) * 0x1p-24F;
}

float oracle_texel(std::uint32_t unit, std::uint32_t x, std::uint32_t y, std::uint32_t layer, std::uint32_t component) {
    return random_of("texel", (((unit * 16 + layer) * 16 + y) * 16 + x) * 4 + component);
}

Texels OracleTextures::sample(const TextureSample& call) {
    Texels result{};
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const auto at = [&](std::size_t i) { return call.place[i][lane]; };
        const auto wrapped = [&](std::size_t i, float shift = 0) {
            const auto index = static_cast<std::int32_t>(std::floor(at(i) * texels + shift)) + call.offset[i][lane];
            return (index % texels + texels) % texels;
        };
        std::array<std::int32_t, 3> place{};
        switch (call.image->dimension) {
        case ImageDimension::cube:
            place = cube(at(0), at(1), at(2));
            break;
        case ImageDimension::rectangle:
            for (std::size_t i = 0; i < 2; ++i)
                place[i] = std::clamp(static_cast<std::int32_t>(std::floor(at(i))), 0, texels - 1);
            break;
        default:
            place = {wrapped(0), call.image->dimension == ImageDimension::d1 ? 0 : wrapped(1),
                     call.image->dimension == ImageDimension::d3 ? wrapped(2) : 0};
            if (call.image->arrayed)
                place[2] = std::clamp(static_cast<std::int32_t>(std::floor(at(2) + 0.5F)), 0, texels - 1);
        }
        if (call.gathers) {
            const std::int32_t x = wrapped(0, -0.5F), y = wrapped(1, -0.5F), x1 = (x + 1) % texels,
                               y1 = (y + 1) % texels;
            const std::array<std::array<std::int32_t, 2>, 4> four{{{x, y1}, {x1, y1}, {x1, y}, {x, y}}};
            for (std::size_t i = 0; i < 4; ++i)
                result[i][lane] = texel(call.texture, {four[i][0], four[i][1], 0}, call.component);
            continue;
        }
        for (std::uint32_t c = 0; c < 4; ++c) result[c][lane] = texel(call.texture, place, c);
        if (call.compares) result[0][lane] = call.reference[lane] <= result[0][lane] ? 1.0F : 0.0F;
    }
    return result;
}
Texels OracleTextures::fetch(const TextureFetch& call) {
    Texels result{};
    for (std::size_t lane = 0; lane < 4; ++lane)
        for (std::uint32_t c = 0; c < 4; ++c)
            result[c][lane] = texel(call.texture, {call.place[0][lane], call.place[1][lane], call.place[2][lane]}, c);
    return result;
}

TextureSize OracleTextures::size(std::uint32_t, std::uint32_t, std::int32_t) {
    return {texels, texels, texels, texels};
}

float OracleTextures::texel(std::uint32_t texture, const std::array<std::int32_t, 3>& place,
                            std::uint32_t component) const {
    const auto at = [&](std::size_t i) { return static_cast<std::uint32_t>(place[i]); };
    return oracle_texel(units_.at(texture), at(0), at(1), at(2), component);
}

} // namespace tests
