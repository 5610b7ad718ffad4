// Blending: factors and equations against plain arithmetic, formats, write masks.
#include "pipeline/functional/fragment_operations.hpp"
#include "sim/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace blending_test {

using namespace pipeline;

using Codes = glm::tvec4<std::uint8_t>;

constexpr std::array equations{BlendEquation::add, BlendEquation::subtract, BlendEquation::reverse_subtract,
                               BlendEquation::least, BlendEquation::greatest};

/// Factor number `factor` of a channel, in units where 1 is `one`; OpenGL 4.5, table 17.2.
double factor_value(std::size_t factor, int channel, const glm::dvec4& s, const glm::dvec4& d, const glm::dvec4& c,
                    double one) {
    const double saturate = channel == 3 ? one : std::min(s.a, one - d.a);
    const std::array table{0.0, one,       s[channel], one - s[channel], d[channel], one - d[channel],
                           s.a, one - s.a, d.a,        one - d.a,        c[channel], one - c[channel],
                           c.a, one - c.a, saturate};
    return table[factor];
}

/// Exact but for the rounding of `product`, and what becomes of the result.
template <class Product>
double expected(const BlendPart& part, int channel, const glm::dvec4& s, const glm::dvec4& d, const glm::dvec4& c,
                double one, Product product) {
    const double of_source =
        product(s[channel], factor_value(static_cast<std::size_t>(part.source), channel, s, d, c, one));
    const double of_target =
        product(d[channel], factor_value(static_cast<std::size_t>(part.target), channel, s, d, c, one));
    const std::array results{of_source + of_target, of_source - of_target, of_target - of_source,
                             std::min(s[channel], d[channel]), std::max(s[channel], d[channel])};
    return results[static_cast<std::size_t>(part.equation)];
}

glm::vec4 random_colour(sim::Random& random) {
    glm::vec4 colour;
    for (int i = 0; i < 4; ++i) colour[i] = static_cast<float>(random.uniform());
    return colour;
}

template <class Check>
void for_every_part(Check check) {
    for (std::size_t source = 0; source < 15; ++source)
        for (std::size_t target = 0; target < 15; ++target)
            for (const BlendEquation equation : equations)
                check(BlendPart{static_cast<BlendFactor>(source), static_cast<BlendFactor>(target), equation});
}

TEST(Blending, EveryFactorAndEquationInFloat) {
    sim::Random random(1, "blend");
    for_every_part([&](const BlendPart& part) {
        const glm::vec4 s = random_colour(random), d = random_colour(random);
        BlendState blend = blends::of(part, {BlendFactor::zero, BlendFactor::one, BlendEquation::add});
        blend.constant = random_colour(random);
        const glm::vec4 colour_only = blended(blend, s, d);
        std::swap(blend.colour, blend.alpha);
        const glm::vec4 alpha_only = blended(blend, s, d);
        const auto product = [](double a, double b) { return a * b; };
        for (int i = 0; i < 4; ++i) {
            const double want = expected(part, i, s, d, blend.constant, 1.0, product);
            EXPECT_NEAR(static_cast<double>(i == 3 ? alpha_only.a : colour_only[i]), want, 4e-7);
            EXPECT_EQ(i == 3 ? colour_only.a : alpha_only[i], d[i]); // the other part keeps the target
        }
    });
}

TEST(Blending, EveryFactorAndEquationInEightBits) {
    sim::Random random(2, "blend");
    const auto product = [](double a, double b) { return std::floor((2.0 * a * b + 255.0) / 510.0); };
    for (int round = 0; round < 4; ++round)
        for_every_part([&](const BlendPart& part) {
            glm::vec4 s, d, c;
            for (int i = 0; i < 4; ++i) {
                s[i] = static_cast<float>(random.below(256));
                d[i] = static_cast<float>(random.below(256));
                c[i] = static_cast<float>(random.below(256));
            }
            BlendState blend = blends::of(part);
            blend.constant = c / 255.0F;
            const Codes result = blended(blend, Codes(s), Codes(d));
            const glm::vec4 written = write_colour(SurfaceFormat::rgba8, blend, 15, s / 255.0F, d / 255.0F) * 255.0F;
            for (int i = 0; i < 4; ++i) {
                const double want = std::clamp(expected(part, i, s, d, c, 255.0, product), 0.0, 255.0);
                EXPECT_EQ(result[i], want);
                EXPECT_NEAR(static_cast<double>(written[i]), want, 1e-4);
            }
        });
}

TEST(Blending, SourceOverInEightBitsIsExactAtTheEnds) {
    for (int c = 0; c < 256; ++c) {
        const auto code = static_cast<std::uint8_t>(c);
        const Codes target(code, 255 - code, 7, 9);
        EXPECT_EQ(blended(blends::over(), Codes(1, 2, 3, 0), target), target);
        EXPECT_EQ(blended(blends::over(), Codes(code, 2, 3, 255), target), Codes(code, 2, 3, 255));
    }
}

TEST(Blending, EightBitProductsAreRoundedToNearest) {
    for (unsigned a = 0; a < 256; ++a)
        for (unsigned b = 0; b < 256; ++b) {
            const auto alpha = static_cast<std::uint8_t>(a), value = static_cast<std::uint8_t>(b);
            const Codes result = blended(blends::over(), Codes(value, 0, 0, alpha), Codes(0, 0, 0, 0));
            EXPECT_EQ(result.r, (a * b + 127) / 255);
        }
}

TEST(Blending, KnownResults) {
    const Codes a(200, 10, 0, 255), b(100, 20, 0, 1);
    EXPECT_EQ(blended(blends::of(blends::sum), a, b), Codes(255, 30, 0, 255));
    EXPECT_EQ(blended(blends::of(blends::least), a, b), Codes(100, 10, 0, 1));
    EXPECT_EQ(blended(blends::of(blends::greatest), a, b), Codes(200, 20, 0, 255));
    EXPECT_EQ(blended(BlendState{}, a, b), a);
    const glm::vec4 s(2.0F, -1.0F, 0.0F, 0.5F), t(1.0F, 1.0F, 1.0F, 1.0F);
    EXPECT_EQ(blended(blends::over(), s, t), glm::vec4(1.5F, 0.0F, 0.5F, 1.0F));
    EXPECT_EQ(blended(blends::of(blends::sum), s, t), glm::vec4(3.0F, 0.0F, 1.0F, 1.5F));
    EXPECT_EQ(blended(blends::of(blends::least), s, t), glm::vec4(1.0F, -1.0F, 0.0F, 0.5F));
    EXPECT_EQ(blended(blends::of(blends::greatest), s, t), glm::vec4(2.0F, 1.0F, 1.0F, 1.0F));
}

TEST(Blending, OfSrgbHappensInLinearLight) {
    BlendState half = blends::of({BlendFactor::constant_alpha, BlendFactor::constant_alpha, BlendEquation::add});
    half.constant = glm::vec4(0.5F);
    const glm::vec4 result =
        write_colour(SurfaceFormat::srgb8a8, half, 15, glm::vec4(1.0F), glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    EXPECT_NEAR(result.r, 0.5F, 0.003F); // code 188; blending of codes would give 128, which is a light of 0.216
    EXPECT_EQ(result.a, 1.0F);
}

TEST(Blending, FixedPointFormatsClampSourceAndConstantFirst) {
    BlendState blend = blends::of({BlendFactor::constant_colour, BlendFactor::one, BlendEquation::subtract});
    blend.constant = glm::vec4(2.0F);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (const SurfaceFormat format :
         {SurfaceFormat::rgba8, SurfaceFormat::srgb8a8, SurfaceFormat::rgb10a2, SurfaceFormat::rgba16f}) {
        const glm::vec4 stored = through_format(format, glm::vec4(0.0F, 1.0F, 0.0F, 1.0F));
        const glm::vec4 result = write_colour(format, blend, 15, {3.0F, 0.5F, nan, -1.0F}, stored);
        const bool fixed = format != SurfaceFormat::rgba16f;
        EXPECT_EQ(result, fixed ? glm::vec4(1.0F, 0.0F, 0.0F, 0.0F) : glm::vec4(6.0F, 0.0F, 0.0F, -3.0F))
            << info_of(format).name;
    }
}

TEST(Blending, MissingAlphaOfTheTargetIsOne) {
    const BlendState blend = blends::of({BlendFactor::target_alpha, BlendFactor::zero, BlendEquation::add});
    for (const SurfaceFormat format : {SurfaceFormat::r8, SurfaceFormat::rg16f, SurfaceFormat::r11g11b10f}) {
        const glm::vec4 stored = through_format(format, glm::vec4(0.0F));
        EXPECT_EQ(write_colour(format, blend, 15, glm::vec4(1.0F), stored).r, 1.0F);
        EXPECT_EQ(write_colour(format, blend, 15, glm::vec4(0.0F), stored).a, 1.0F);
    }
}

TEST(Blending, ChannelsBeyondTheRangeOfHalvesAreCounted) {
    const float below = std::nextafter(65520.0F, 0.0F);
    const auto count = [](SurfaceFormat format, const BlendState& blend, std::uint8_t mask, const glm::vec4& source,
                          float stored, Fp16Overflow overflow) {
        std::uint64_t channels = 0;
        write_colour(format, blend, mask, source, glm::vec4(stored), overflow, &channels);
        return channels;
    };
    for (const Fp16Overflow overflow : {Fp16Overflow::saturate, Fp16Overflow::infinity}) {
        const auto written = [&](SurfaceFormat format, const glm::vec4& colour, std::uint8_t mask = 15) {
            return count(format, {}, mask, colour, 0.0F, overflow);
        };
        const glm::vec4 colour(below, 65520.0F, -65520.0F, std::numeric_limits<float>::infinity());
        EXPECT_EQ(written(SurfaceFormat::rgba16f, colour), 3U);
        EXPECT_EQ(written(SurfaceFormat::rg16f, colour), 1U);
        EXPECT_EQ(written(SurfaceFormat::r16f, colour), 0U);
        EXPECT_EQ(written(SurfaceFormat::rgba16f, colour, 0b1011), 2U);
        EXPECT_EQ(written(SurfaceFormat::rgba16f, glm::vec4(std::numeric_limits<float>::quiet_NaN())), 0U);
        for (const SurfaceFormat format : {SurfaceFormat::rgba32f, SurfaceFormat::r11g11b10f, SurfaceFormat::rgba8})
            EXPECT_EQ(written(format, colour), 0U);
        const auto sum = [&](float more) {
            return count(SurfaceFormat::rgba16f, blends::of(blends::sum), 15, glm::vec4(more), 65504.0F, overflow);
        };
        EXPECT_EQ(sum(below - 65504.0F), 0U);
        EXPECT_EQ(sum(16.0F), 4U);
        EXPECT_EQ(sum(65504.0F), 4U);
    }
}

TEST(WriteMask, KeepsWhatItLeavesOut) {
    const glm::vec4 stored = through_format(SurfaceFormat::rgba8, {0.1F, 0.2F, 0.3F, 0.4F}), source(1.0F);
    for (const bool enabled : {false, true})
        for (std::uint8_t mask = 0; mask < 16; ++mask) {
            BlendState blend = blends::of(blends::sum);
            blend.enabled = enabled;
            const glm::vec4 result = write_colour(SurfaceFormat::rgba8, blend, mask, source, stored);
            for (int i = 0; i < 4; ++i) EXPECT_EQ(result[i], (mask >> i & 1) != 0 ? 1.0F : stored[i]);
        }
}

TEST(SurfaceUse, OnlyWhatIsCombinedWithTheStoredColourNeedsIt) {
    const auto use = [](const BlendState& blend, std::uint8_t mask, SurfaceFormat format = SurfaceFormat::rgba8) {
        RasterState state;
        state.blend[0] = blend;
        state.write_mask[0] = mask;
        const std::optional<SurfaceFormat> target = format;
        return use_of(state, SurfaceFormat::d24, std::span(&target, 1));
    };
    EXPECT_TRUE(use({}, 15).colour);
    EXPECT_FALSE(use({}, 15).keeps_colour);
    EXPECT_FALSE(use({}, 0).colour);
    EXPECT_FALSE(use({}, 0).keeps_colour);
    EXPECT_TRUE(use({}, 7).keeps_colour);
    EXPECT_FALSE(use({}, 7, SurfaceFormat::r11g11b10f).keeps_colour);
    EXPECT_TRUE(use(blends::over(), 15).keeps_colour);
    EXPECT_TRUE(use(blends::of(blends::least), 15).keeps_colour);
    EXPECT_FALSE(use(blends::of({BlendFactor::source_alpha, BlendFactor::zero, BlendEquation::add}), 15).keeps_colour);
    // Whatever does not read it gives the same for every stored colour.
    sim::Random random(3, "blend");
    for_every_part([&](const BlendPart& part) {
        if (reads_target(blends::of(part))) return;
        const glm::vec4 source = random_colour(random);
        EXPECT_EQ(blended(blends::of(part), source, random_colour(random)),
                  blended(blends::of(part), source, random_colour(random)));
    });
}

} // namespace blending_test
