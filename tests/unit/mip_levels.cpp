// From footprints to levels and filters.
#include "pipeline/functional/mip_levels.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace mip_levels_test {

using namespace pipeline;

constexpr double infinity = std::numeric_limits<double>::infinity();

LevelReads reads(Filter min, Filter mag, float lod, std::uint32_t base = 0, std::uint32_t last = 3) {
    SamplerState sampler;
    sampler.min_filter = min;
    sampler.mag_filter = mag;
    return reads_of_levels(sampler, lod, base, last);
}

TEST(MipLevelReads, MagnificationGoesOnToOneHalfWhereItIsTheSmootherFilter) {
    for (const Filter min : {Filter::nearest_mip_nearest, Filter::nearest_mip_linear}) {
        EXPECT_TRUE(reads(min, Filter::linear, 0.5F).linear);
        EXPECT_FALSE(reads(min, Filter::linear, 0.51F).linear);
        EXPECT_FALSE(reads(min, Filter::nearest, 0.5F).linear);
    }
    for (const Filter min : {Filter::linear, Filter::linear_mip_nearest, Filter::linear_mip_linear}) {
        EXPECT_FALSE(reads(min, Filter::nearest, 0.0F).linear);
        EXPECT_TRUE(reads(min, Filter::nearest, 0.01F).linear);
    }
    EXPECT_TRUE(reads(Filter::nearest, Filter::linear, -1.0F).linear);
    EXPECT_FALSE(reads(Filter::nearest, Filter::linear, 0.25F).linear);
}

TEST(MipLevelReads, EveryMinificationFilter) {
    constexpr Filter mag = Filter::nearest;
    EXPECT_EQ(reads(Filter::nearest, mag, 2.7F), (LevelReads{0, 0, false}));
    EXPECT_EQ(reads(Filter::linear, mag, 2.7F), (LevelReads{0, 0, true}));
    EXPECT_EQ(reads(Filter::nearest_mip_nearest, mag, 1.5F), (LevelReads{1, 0, false}));
    EXPECT_EQ(reads(Filter::nearest_mip_nearest, mag, 1.75F), (LevelReads{2, 0, false}));
    EXPECT_EQ(reads(Filter::linear_mip_nearest, mag, 0.25F), (LevelReads{0, 0, true}));
    EXPECT_EQ(reads(Filter::nearest_mip_linear, mag, 1.75F), (LevelReads{1, 0.75F, false}));
    EXPECT_EQ(reads(Filter::linear_mip_linear, mag, 2.0F), (LevelReads{2, 0, true}));
}

TEST(MipLevelReads, ReadsStayBetweenBaseAndLast) {
    constexpr Filter mag = Filter::linear;
    EXPECT_EQ(reads(Filter::linear_mip_linear, mag, 1000.0F, 1, 3), (LevelReads{3, 0, true}));
    EXPECT_EQ(reads(Filter::linear_mip_linear, mag, 1.5F, 1, 2), (LevelReads{2, 0, true}));
    EXPECT_EQ(reads(Filter::linear_mip_linear, mag, 0.5F, 1, 2), (LevelReads{1, 0.5F, true}));
    EXPECT_EQ(reads(Filter::nearest_mip_nearest, mag, 1000.0F, 2, 2), (LevelReads{2, 0, false}));
    EXPECT_EQ(reads(Filter::nearest, mag, 1000.0F, 2, 3), (LevelReads{2, 0, false}));
}

TEST(MipLevelReads, BiasThenBounds) {
    SamplerState sampler;
    sampler.lod_bias = 1;
    sampler.least_lod = -2;
    sampler.most_lod = 4;
    EXPECT_EQ(bounded_lod(sampler, 0.5F), 1.5F);
    EXPECT_EQ(bounded_lod(sampler, 9), 4.0F);
    EXPECT_EQ(bounded_lod(sampler, -std::numeric_limits<float>::infinity()), -2.0F);
    EXPECT_EQ(bounded_lod(sampler, std::numeric_limits<float>::quiet_NaN()), 0.0F);
    sampler.least_lod = 5; // beyond the most
    EXPECT_EQ(bounded_lod(sampler, 0), 4.0F);
}

TEST(MipLevelReads, IsotropicLevelsFollowFromTheLongerAxis) {
    EXPECT_EQ(footprint_level({64, 16}, 1).lod, 3.0F);
    EXPECT_EQ(footprint_level({1, 16}, 1).lod, 2.0F);
    EXPECT_EQ(footprint_level({0.25, 0.0625}, 1).lod, -1.0F);
    EXPECT_EQ(footprint_level({0, 0}, 1).lod, -std::numeric_limits<float>::infinity());
    EXPECT_EQ(footprint_level({64, 16}, 1).probes, 1U);
}

TEST(MipLevelReads, ProbesAreAsManyAsTheAxesDiffer) {
    const FootprintLevel four = footprint_level({256, 16}, 8);
    EXPECT_EQ(four.probes, 4U);
    EXPECT_EQ(four.lod, 2.0F);
    EXPECT_FALSE(four.probes_down);
    const FootprintLevel two = footprint_level({16, 256}, 2);
    EXPECT_EQ(two.probes, 2U);
    EXPECT_EQ(two.lod, 3.0F);
    EXPECT_TRUE(two.probes_down);
    EXPECT_EQ(footprint_level({17, 16}, 8).probes, 2U);
    EXPECT_EQ(footprint_level({16, 16}, 8).probes, 1U);
    EXPECT_EQ(footprint_level({1, 0.01}, 8).probes, 1U); // magnified
    EXPECT_EQ(footprint_level({16, 0}, 8).probes, 8U);
    EXPECT_EQ(footprint_level({infinity, infinity}, 8).probes, 8U);
    EXPECT_EQ(footprint_level({16, 0}, 1e9F).probes, most_probes);
}

} // namespace mip_levels_test
