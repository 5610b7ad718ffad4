// Number formats, depth and colour surfaces.
#include "pipeline/functional/number_formats.hpp"
#include "pipeline/functional/surface_texel.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace pipeline {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const float not_a_number = std::numeric_limits<float>::quiet_NaN();

TEST(HalfFloat, EveryFiniteValueSurvivesBothWays) {
    for (std::uint32_t code = 0; code < 65536; ++code) {
        const auto half = static_cast<std::uint16_t>(code);
        const float value = half_to_float(half);
        if (std::isnan(value)) continue;
        EXPECT_EQ(float_to_half(value), half) << code;
    }
}

TEST(HalfFloat, KnownValues) {
    EXPECT_EQ(half_to_float(0x3C00), 1.0F);
    EXPECT_EQ(half_to_float(0x0001), 0x1p-24F);
    EXPECT_EQ(half_to_float(0x7BFF), 65504.0F);
    EXPECT_EQ(half_to_float(0xFC00), -infinity);
    EXPECT_TRUE(std::isnan(half_to_float(0x7E00)));
    EXPECT_EQ(float_to_half(not_a_number), 0x7E00);
}

TEST(HalfFloat, RoundsToNearestEven) {
    EXPECT_EQ(float_to_half(1.0F + 0x1p-11F), 0x3C00);        // halfway between 1 and the next: even is 1
    EXPECT_EQ(float_to_half(1.0F + 3.0F * 0x1p-11F), 0x3C02); // halfway, even is above
    EXPECT_EQ(float_to_half(0x1p-25F), 0x0000);               // half of the smallest subnormal
    EXPECT_EQ(float_to_half(std::nextafter(0x1p-25F, 1.0F)), 0x0001);
    EXPECT_EQ(float_to_half(std::nextafter(65520.0F, 0.0F)), 0x7BFF);
    EXPECT_EQ(float_to_half(65520.0F), 0x7C00);
}

TEST(Unorm8, RoundsClampsAndSwallowsNaN) {
    for (unsigned code = 0; code < 256; ++code)
        EXPECT_EQ(float_to_unorm8(unorm8_to_float(static_cast<std::uint8_t>(code))), code);
    EXPECT_EQ(float_to_unorm8(-0.1F), 0);
    EXPECT_EQ(float_to_unorm8(7.0F), 255);
    EXPECT_EQ(float_to_unorm8(infinity), 255);
    EXPECT_EQ(float_to_unorm8(not_a_number), 0);
    EXPECT_EQ(float_to_unorm8(0.5F), 128); // 127.5: to even
}

TEST(Srgb, EveryCodeSurvivesBothWays) {
    for (unsigned code = 0; code < 256; ++code) EXPECT_EQ(srgb_encode(srgb_decode_table()[code]), code);
    EXPECT_EQ(srgb_encode(-1.0F), 0);
    EXPECT_EQ(srgb_encode(2.0F), 255);
    EXPECT_EQ(srgb_encode(not_a_number), 0);
    EXPECT_NEAR(srgb_decode_table()[188], 0.5F, 0.004F); // half the light is code 188
}

TEST(DepthCodes, CodesAreNearestAndOrdered) {
    EXPECT_EQ(depth_code(SurfaceFormat::d16, 1.0F), 65535U);
    EXPECT_EQ(depth_code(SurfaceFormat::d24, 1.0F), 16777215U);
    EXPECT_EQ(depth_code(SurfaceFormat::d24, 0.5F), 8388608U); // 8388607.5: to even
    EXPECT_EQ(depth_code(SurfaceFormat::d16, 0.0F), 0U);
    for (const SurfaceFormat format : {SurfaceFormat::d16, SurfaceFormat::d24, SurfaceFormat::d32f}) {
        EXPECT_EQ(depth_code(format, -1.0F), depth_code(format, 0.0F));
        EXPECT_EQ(depth_code(format, -0.0F), depth_code(format, 0.0F));
        EXPECT_EQ(depth_code(format, 2.0F), farthest_depth(format));
        EXPECT_EQ(depth_code(format, not_a_number), depth_code(format, 0.0F));
        DepthCode last = 0;
        for (float depth = 0.0F; depth <= 1.0F; depth += 0x1p-12F) {
            const DepthCode code = depth_code(format, depth);
            EXPECT_LE(last, code);
            EXPECT_EQ(depth_code(format, depth_value(format, code)), code);
            last = code;
        }
    }
}

TEST(DepthCodes, CompareInTheFormatNotInFloat) {
    const auto less = [](DepthCode a, DepthCode b) { return a < b; };
    const float near = 0.4F, far = 0.4F + 0x1p-20F; // differ in D24 and D32F, not in D16
    EXPECT_FALSE(less(depth_code(SurfaceFormat::d16, near), depth_code(SurfaceFormat::d16, far)));
    EXPECT_TRUE(less(depth_code(SurfaceFormat::d24, near), depth_code(SurfaceFormat::d24, far)));
    const float closer = std::nextafter(near, 0.0F); // less than a unit of D24
    EXPECT_FALSE(less(depth_code(SurfaceFormat::d24, closer), depth_code(SurfaceFormat::d24, closer)));
    EXPECT_TRUE(less(depth_code(SurfaceFormat::d32f, closer), depth_code(SurfaceFormat::d32f, near)));
}

TEST(ColourTexels, WhatIsReadBackIsTheNearestStorableColour) {
    const glm::vec4 colour(0.1F, 1.5F, -0.25F, 0.5F);
    EXPECT_EQ(through_format(SurfaceFormat::rgba32f, colour), colour);
    EXPECT_EQ(through_format(SurfaceFormat::rgba8, colour), glm::vec4(26.0F / 255.0F, 1.0F, 0.0F, 128.0F / 255.0F));
    EXPECT_EQ(through_format(SurfaceFormat::rgba16f, colour),
              glm::vec4(half_to_float(float_to_half(0.1F)), 1.5F, -0.25F, 0.5F));
}

TEST(ColourTexels, AlphaTestsTellAsManyStepsAsTheFormatStores) {
    EXPECT_EQ(alpha_steps(SurfaceFormat::rgba8), 255U);
    EXPECT_EQ(alpha_steps(SurfaceFormat::srgb8a8), 255U);
    EXPECT_EQ(alpha_steps(SurfaceFormat::rgb10a2), 3U);
    EXPECT_EQ(alpha_steps(SurfaceFormat::rgba16), 65535U);
    EXPECT_EQ(alpha_steps(SurfaceFormat::rg8), 255U); // has none
    for (const SurfaceFormat format : {SurfaceFormat::rgba16f, SurfaceFormat::rgba32f, SurfaceFormat::r11g11b10f,
                                       SurfaceFormat::rgba8s, SurfaceFormat::rgba8u, SurfaceFormat::d24s8})
        EXPECT_EQ(alpha_steps(format), 0U);
}

TEST(ColourTexels, NothingInfiniteIsStored) {
    for (const SurfaceFormat format : {SurfaceFormat::rgba8, SurfaceFormat::rgba16f, SurfaceFormat::rgba32f}) {
        const glm::vec4 back = through_format(format, glm::vec4(infinity, -infinity, not_a_number, 1e30F));
        for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isfinite(back[i]));
        EXPECT_EQ(back[2], 0.0F);
    }
}

} // namespace
} // namespace pipeline
