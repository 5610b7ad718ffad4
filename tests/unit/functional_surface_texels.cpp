// Every surface format at its quanta: below, at and above the middle of two codes, largest values, NaN and infinity.
#include "pipeline/functional/surface_texel.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>

namespace surface_texel_test {

using namespace pipeline;

constexpr float infinity = std::numeric_limits<float>::infinity();
const float not_a_number = std::numeric_limits<float>::quiet_NaN();

using Bytes = std::array<std::byte, largest_texel>;

std::uint32_t packed(SurfaceFormat format, const glm::vec4& colour) {
    Bytes bytes{};
    pack_colour(format, colour, bytes.data());
    std::uint32_t code = 0;
    std::memcpy(&code, bytes.data(), sizeof(code));
    return code;
}

glm::vec4 only(int channel, float value) {
    glm::vec4 colour(0.0F);
    colour[channel] = value;
    return colour;
}

/// One channel whose code n stands for value(n), n from 0 to last, ascending.
struct Channel {
    SurfaceFormat format;
    int channel;
    unsigned shift; ///< of its code within the texel
    std::uint32_t last;
    double (*value)(std::uint32_t code);

    std::uint32_t code_of(float x) const { return packed(format, only(channel, x)) >> shift & mask(); }
    std::uint32_t mask() const { return std::bit_ceil(last + 1) - 1; }
};

double unorm8(std::uint32_t code) { return code / 255.0; }
double unorm16(std::uint32_t code) { return code / 65535.0; }
double unorm10(std::uint32_t code) { return code / 1023.0; }
double unorm2(std::uint32_t code) { return code / 3.0; }
/// OpenGL 4.5, section 2.3.4.3 and 2.3.4.4.
template <int bits>
double small_float(std::uint32_t code) {
    const int exponent = static_cast<int>(code >> bits);
    const double fraction = static_cast<double>(code & ((1U << bits) - 1)) / (1 << bits);
    return exponent == 0 ? std::ldexp(fraction, -14) : std::ldexp(1.0 + fraction, exponent - 15);
}
double half(std::uint32_t code) { return small_float<10>(code); }

const std::array channels{
    Channel{SurfaceFormat::r8, 0, 0, 255, unorm8},
    Channel{SurfaceFormat::rg8, 1, 8, 255, unorm8},
    Channel{SurfaceFormat::rgba8, 2, 16, 255, unorm8},
    Channel{SurfaceFormat::srgb8a8, 3, 24, 255, unorm8},
    Channel{SurfaceFormat::r16, 0, 0, 65535, unorm16},
    Channel{SurfaceFormat::rg16, 1, 16, 65535, unorm16},
    Channel{SurfaceFormat::rgb10a2, 0, 0, 1023, unorm10},
    Channel{SurfaceFormat::rgb10a2, 1, 10, 1023, unorm10},
    Channel{SurfaceFormat::rgb10a2, 2, 20, 1023, unorm10},
    Channel{SurfaceFormat::rgb10a2, 3, 30, 3, unorm2},
    Channel{SurfaceFormat::r11g11b10f, 0, 0, 0x7BF, small_float<6>},
    Channel{SurfaceFormat::r11g11b10f, 1, 11, 0x7BF, small_float<6>},
    Channel{SurfaceFormat::r11g11b10f, 2, 22, 0x3DF, small_float<5>},
    Channel{SurfaceFormat::r16f, 0, 0, 0x7BFF, half},
    Channel{SurfaceFormat::rg16f, 1, 16, 0x7BFF, half},
};

TEST(SurfaceTexel, EveryCodeStandsForItsValueAndComesBack) {
    for (const Channel& channel : channels)
        for (std::uint32_t code = 0; code <= channel.last; ++code) {
            const std::uint32_t texel = code << channel.shift;
            Bytes bytes{};
            std::memcpy(bytes.data(), &texel, sizeof(texel));
            const float value = unpack_texel(channel.format, bytes.data())[channel.channel];
            EXPECT_EQ(value, static_cast<float>(channel.value(code)));
            EXPECT_EQ(channel.code_of(value), code) << info_of(channel.format).name;
        }
}

TEST(SurfaceTexel, RoundsToTheNearestCodeAndTiesToTheEvenOne) {
    for (const Channel& channel : channels)
        for (std::uint32_t code = 0; code < channel.last; ++code) {
            const double middle = (channel.value(code) + channel.value(code + 1)) / 2.0;
            const auto nearest = static_cast<float>(middle);
            const float below = std::nextafter(nearest, -1.0F), above = std::nextafter(nearest, infinity);
            EXPECT_EQ(channel.code_of(below), code) << info_of(channel.format).name << ' ' << code;
            EXPECT_EQ(channel.code_of(above), code + 1) << info_of(channel.format).name << ' ' << code;
            // The middles of float formats are floats; of normalised integers only 1/2 is.
            if (static_cast<double>(nearest) != middle) continue;
            EXPECT_EQ(channel.code_of(nearest), code + code % 2) << info_of(channel.format).name << ' ' << code;
        }
}

TEST(SurfaceTexel, SaturatesAndStoresNothingInfinite) {
    for (const Channel& channel : channels) {
        const bool has_sign = channel.last == 0x7BFF;
        const auto largest = static_cast<float>(channel.value(channel.last));
        for (const float x : {largest, std::nextafter(largest, infinity), 1e30F, infinity})
            EXPECT_EQ(channel.code_of(x), channel.last) << info_of(channel.format).name;
        for (const float x : {not_a_number, -not_a_number, 0.0F}) EXPECT_EQ(channel.code_of(x), 0U);
        for (const float x : {-1.0F, -1e30F, -infinity}) {
            const std::uint32_t code = channel.code_of(x) & 0x7FFFU;
            if (has_sign)
                EXPECT_EQ(code, x == -1.0F ? 0x3C00U : channel.last);
            else
                EXPECT_EQ(channel.code_of(x), 0U);
        }
    }
    for (const SurfaceFormat format : {SurfaceFormat::r32f, SurfaceFormat::rg32f, SurfaceFormat::rgba32f}) {
        constexpr float largest = std::numeric_limits<float>::max();
        EXPECT_EQ(through_format(format, glm::vec4(infinity)).r, largest);
        EXPECT_EQ(through_format(format, glm::vec4(-infinity)).r, -largest);
        EXPECT_EQ(through_format(format, glm::vec4(not_a_number)).r, 0.0F);
        EXPECT_EQ(through_format(format, glm::vec4(0.1F)).r, 0.1F);
    }
}

// IEEE 754-2008, section 4.3.1: from 65504 + 16 on, the middle between the largest finite half and what would be the
// next, numbers round to infinity.
TEST(SurfaceTexel, HalvesOverflowAsTheyAreAskedTo) {
    const float below = std::nextafter(65520.0F, 0.0F);
    struct Expected {
        float value;
        std::uint32_t saturated, infinite;
    };
    const std::array cases{Expected{65504.0F, 0x7BFF, 0x7BFF},  Expected{below, 0x7BFF, 0x7BFF},
                           Expected{65520.0F, 0x7BFF, 0x7C00},  Expected{1e30F, 0x7BFF, 0x7C00},
                           Expected{infinity, 0x7BFF, 0x7C00},  Expected{-below, 0xFBFF, 0xFBFF},
                           Expected{-65520.0F, 0xFBFF, 0xFC00}, Expected{-infinity, 0xFBFF, 0xFC00},
                           Expected{not_a_number, 0, 0x7E00},   Expected{-not_a_number, 0, 0x7E00}};
    for (const SurfaceFormat format : {SurfaceFormat::r16f, SurfaceFormat::rg16f, SurfaceFormat::rgba16f})
        for (const Expected& expected : cases) {
            SCOPED_TRACE(expected.value);
            for (int channel = 0; channel < info_of(format).channels; ++channel) {
                const auto code = [&](Fp16Overflow overflow) {
                    Bytes bytes{};
                    pack_colour(format, only(channel, expected.value), bytes.data(), overflow);
                    std::uint16_t half = 0;
                    std::memcpy(&half, bytes.data() + std::ptrdiff_t{2} * channel, sizeof(half));
                    return half;
                };
                EXPECT_EQ(code(Fp16Overflow::saturate), expected.saturated);
                EXPECT_EQ(code(Fp16Overflow::infinity), expected.infinite);
            }
        }
    for (const SurfaceFormat format : {SurfaceFormat::r11g11b10f, SurfaceFormat::rgba32f, SurfaceFormat::rgba8})
        EXPECT_EQ(through_format(format, glm::vec4(infinity), Fp16Overflow::infinity),
                  through_format(format, glm::vec4(infinity)));
}

TEST(SurfaceTexel, StoredSrgbIsEncodedAndReadBackLinear) {
    for (std::uint32_t code = 0; code < 256; ++code) {
        const std::uint32_t texel = code * 0x01010101U;
        Bytes bytes{};
        std::memcpy(bytes.data(), &texel, sizeof(texel));
        const glm::vec4 colour = unpack_texel(SurfaceFormat::srgb8a8, bytes.data());
        const double encoded = code / 255.0;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        EXPECT_EQ(colour.g, static_cast<float>(linear));
        EXPECT_EQ(colour.a, static_cast<float>(encoded));
        EXPECT_EQ(packed(SurfaceFormat::srgb8a8, colour), texel);
    }
}

TEST(SurfaceTexel, MissingChannelsReadZeroAndOne) {
    const glm::vec4 colour(0.25F, 0.5F, 0.75F, 0.5F);
    for (std::size_t i = 0; i < surface_formats.size(); ++i) {
        const auto format = static_cast<SurfaceFormat>(i);
        if (!is_colour(format) || is_integer(format) || is_compressed(format)) continue;
        const glm::vec4 back = through_format(format, colour);
        for (int channel = info_of(format).channels; channel < 4; ++channel)
            EXPECT_EQ(back[channel], channel == 3 ? 1.0F : 0.0F) << info_of(format).name;
        EXPECT_NEAR(back.r, 0.25F, 0.002F) << info_of(format).name;
    }
}

TEST(SurfaceTexel, WritesTheBytesOfItsFormatAndNoMore) {
    for (std::size_t i = 0; i < surface_formats.size(); ++i) {
        const auto format = static_cast<SurfaceFormat>(i);
        if (is_compressed(format)) continue;
        std::array<std::byte, 2 * largest_texel> bytes{};
        bytes.fill(std::byte{0xA5});
        if (is_integer(format))
            pack_integers(format, glm::uvec4(1, 2, 3, 4), bytes.data());
        else if (is_colour(format))
            pack_colour(format, glm::vec4(0.5F), bytes.data());
        else
            pack_depth_stencil(format, {1, 2}, bytes.data());
        for (std::size_t at = bytes_of(format); at < bytes.size(); ++at) EXPECT_EQ(bytes[at], std::byte{0xA5});
    }
}

TEST(SurfaceTexel, IntegersAreKeptWhole) {
    for (const std::uint32_t value : {0U, 1U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
        Bytes bytes{};
        pack_integers(SurfaceFormat::rg32u, {value, ~value, 8, 9}, bytes.data());
        EXPECT_EQ(unpack_integers(SurfaceFormat::rg32u, bytes.data()), glm::uvec4(value, ~value, 0, 1));
        pack_integers(SurfaceFormat::r32u, {value, 7, 8, 9}, bytes.data());
        EXPECT_EQ(unpack_integers(SurfaceFormat::r32u, bytes.data()), glm::uvec4(value, 0, 0, 1));
        EXPECT_EQ(unpack_texel(SurfaceFormat::r32u, bytes.data()).r, static_cast<float>(value));
        EXPECT_EQ(unpack_texel(SurfaceFormat::r32i, bytes.data()).r,
                  static_cast<float>(static_cast<std::int32_t>(value)));
    }
}

TEST(SurfaceTexel, NarrowIntegersHaveTheirSign) {
    const auto kept = [](SurfaceFormat format, std::uint32_t value) {
        Bytes bytes{};
        pack_integers(format, glm::uvec4(value), bytes.data());
        return unpack_integers(format, bytes.data());
    };
    constexpr std::uint32_t minus_one = ~0U;
    EXPECT_EQ(kept(SurfaceFormat::rgba8i, minus_one), glm::uvec4(minus_one));
    EXPECT_EQ(kept(SurfaceFormat::rgba8u, minus_one), glm::uvec4(255));
    EXPECT_EQ(kept(SurfaceFormat::rg16i, 0x12348765U), glm::uvec4(0xFFFF8765U, 0xFFFF8765U, 0, 1));
    EXPECT_EQ(kept(SurfaceFormat::r16u, 0x12348765U), glm::uvec4(0x8765U, 0, 0, 1));
    Bytes bytes{};
    pack_integers(SurfaceFormat::r16i, glm::uvec4(minus_one), bytes.data());
    EXPECT_EQ(unpack_texel(SurfaceFormat::r16i, bytes.data()), glm::vec4(-1, 0, 0, 1));
}

// OpenGL 4.5, section 2.3.5.1: two codes stand for -1.
TEST(SurfaceTexel, SignedNormalisedCodes) {
    for (int code = -128; code <= 127; ++code) {
        const std::byte texel{static_cast<std::uint8_t>(code)};
        const float value = unpack_texel(SurfaceFormat::r8s, &texel).r;
        EXPECT_EQ(value, code == -128 ? -1.0F : static_cast<float>(code) / 127.0F);
        EXPECT_EQ(through_format(SurfaceFormat::rgba8s, glm::vec4(value)), glm::vec4(value));
    }
    EXPECT_EQ(through_format(SurfaceFormat::rg8s, {infinity, -infinity, 0, 0}), glm::vec4(1, -1, 0, 1));
    EXPECT_EQ(through_format(SurfaceFormat::r8s, glm::vec4(not_a_number)).r, 0.0F);
}

TEST(SurfaceTexel, DepthAndStencilShareATexel) {
    for (const SurfaceFormat format :
         {SurfaceFormat::d16, SurfaceFormat::d24, SurfaceFormat::d24s8, SurfaceFormat::d32f, SurfaceFormat::s8})
        for (const float depth : {0.0F, 0x1p-25F, 0.3F, 0.5F, std::nextafter(1.0F, 0.0F), 1.0F})
            for (const std::uint32_t stencil : {0U, 1U, 128U, 255U}) {
                const DepthStencil texel{has_depth(format) ? depth_code(format, depth) : 0,
                                         static_cast<std::uint8_t>(has_stencil(format) ? stencil : 0)};
                Bytes bytes{};
                pack_depth_stencil(format, texel, bytes.data());
                EXPECT_EQ(unpack_depth_stencil(format, bytes.data()), texel) << info_of(format).name;
                const float read = unpack_texel(format, bytes.data()).r;
                if (has_depth(format))
                    EXPECT_EQ(depth_code(format, read), texel.depth);
                else
                    EXPECT_EQ(read, static_cast<float>(stencil));
            }
    EXPECT_EQ(depth_code(SurfaceFormat::d24s8, 0.5F), depth_code(SurfaceFormat::d24, 0.5F));
}

} // namespace surface_texel_test
