#include "sim/random.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace {

std::vector<std::uint64_t> draws(std::uint64_t seed, std::string_view name) {
    sim::Random random(seed, name);
    std::vector<std::uint64_t> list(20);
    for (std::uint64_t& value : list) value = random.below(1'000'000);
    return list;
}

TEST(Random, IsEqualForEqualSeedAndName) { EXPECT_EQ(draws(7, "pipe0.rop"), draws(7, "pipe0.rop")); }

TEST(Random, DiffersByName) {
    EXPECT_NE(draws(7, "pipe0.rop"), draws(7, "pipe1.rop"));
    EXPECT_NE(draws(7, ""), draws(7, "a"));
}

TEST(Random, DiffersBySeed) {
    EXPECT_NE(draws(7, "pipe0.rop"), draws(8, "pipe0.rop"));
    EXPECT_NE(draws(0, "pipe0.rop"), draws(~std::uint64_t{0}, "pipe0.rop"));
}

// The numbers are part of every result, so no library and no compiler may change them.
TEST(Random, SequenceIsFixed) {
    sim::Random random(1, "tick order");
    EXPECT_EQ(random.below(1000), 323U);
    EXPECT_EQ(random.below(1000), 544U);
}

TEST(Random, StaysInRange) {
    sim::Random random(3, "range");
    for (int i = 0; i < 10'000; ++i) {
        EXPECT_EQ(random.below(1), 0U);
        EXPECT_LT(random.below(3), 3U);
        const double uniform = random.uniform();
        EXPECT_GE(uniform, 0.0);
        EXPECT_LT(uniform, 1.0);
    }
}

TEST(Random, IsSpreadEvenly) {
    sim::Random random(3, "spread");
    std::vector<int> bins(10);
    for (int i = 0; i < 100'000; ++i) ++bins[random.below(10)];
    for (const int bin : bins) EXPECT_NEAR(bin, 10'000, 500);
}

} // namespace
