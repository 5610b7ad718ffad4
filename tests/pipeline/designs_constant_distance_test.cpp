// The read-modify-write chain of a pixel when every read misses the last H - 1 quads: what survives, and how often a
// read is late. Source: specification 004, section 7.1 (lemmas L1 to L3) and checks K1, K4.
#include "tests/support/kbuffer_facts.hpp"
#include "tests/support/replay.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace designs_constant_distance_test {

using pipeline::QuadId;
using support::Replay;
using support::ReplayOptions;

/// Quads from the last one of a pixel back through what each has read: quad i reads what the quads up to i - H left.
std::vector<QuadId> chain_of(const std::vector<QuadId>& quads, QuadId distance) {
    std::vector<QuadId> chain;
    for (std::size_t at = quads.size(); at > 0;) {
        const QuadId quad = quads[at - 1];
        chain.push_back(quad);
        while (at > 0 && quads[at - 1] + distance > quad) --at;
    }
    return chain;
}

const Replay& stack_of_64(std::uint32_t k) {
    static std::map<std::uint32_t, Replay> made;
    const auto found = made.find(k);
    if (found != made.end()) return found->second;
    return made.emplace(k, Replay("gen:stack?n=64", {.width = 16, .height = 16, .knobs = {fmt::format("k={}", k)}}))
        .first->second;
}

TEST(ConstantDistance, K1_SurvivorsOfAStackOf64AreEveryHthFromTheLast) {
    const Replay& replay = stack_of_64(64);
    ASSERT_EQ(replay.kbuffer_stream().quads.size(), 64U);
    const std::map<QuadId, std::size_t> survivors_at{{1, 64}, {8, 8}, {16, 4}, {64, 1}, {128, 1}};
    for (const auto& [distance, survivors] : survivors_at) {
        const auto image = pipeline::run_reference(replay.frame, replay.streams, distance);
        for (const auto& [x, y] : {std::pair(8U, 8U), {9U, 8U}, {8U, 9U}, {9U, 9U}}) {
            const std::vector<float> depths = support::depths_at(replay.frame, image.kbuffer, x, y);
            ASSERT_EQ(depths.size(), survivors) << "H = " << distance;
            for (std::size_t i = 0; i < survivors; ++i) {
                // Depth grows with the index, so entry i is the i-th smallest index of 63, 63 - H, ...
                const QuadId quad = 63 - distance * static_cast<QuadId>(survivors - 1 - i);
                EXPECT_EQ(depths[i], replay.streams[0].depths[quad][(y - 8) * 2 + x - 8]) << "H = " << distance;
            }
        }
    }
}

TEST(ConstantDistance, K1_FourEntriesHoldTheFourNearestOfTheChain) {
    const Replay& replay = stack_of_64(4);
    for (const QuadId distance : {1U, 8U, 16U, 64U, 128U}) {
        const auto image = pipeline::run_reference(replay.frame, replay.streams, distance);
        std::vector<float> expected;
        for (std::uint32_t index = 63 % distance; index < 64 && expected.size() < 4; index += distance)
            expected.push_back(replay.streams[0].depths[distance > 63 ? 63 : index][0]);
        if (distance > 63) expected.resize(1);
        EXPECT_EQ(support::depths_at(replay.frame, image.kbuffer, 8, 8), expected) << "H = " << distance;
    }
}

RC_GTEST_PROP(ConstantDistance, L3_SurvivorsOfAStackAreItsLengthOverTheDistance, ()) {
    const auto n = *rc::gen::inRange<std::uint32_t>(1, 65);
    const auto distance = *rc::gen::inRange<QuadId>(1, 80);
    const Replay replay(fmt::format("gen:stack?n={}&order=random&seed={}", n, n + distance),
                        {.width = 16, .height = 16, .knobs = {"k=64"}});
    const auto image = pipeline::run_reference(replay.frame, replay.streams, distance);
    RC_ASSERT(support::depths_at(replay.frame, image.kbuffer, 8, 8).size() == (n - 1) / distance + 1);
    // A stack covers four pixels and nothing else.
    RC_ASSERT(image.missed_reads == (distance > 1 ? std::uint64_t{4} * (n - 1) : 0U));
    RC_ASSERT(image.missed_pixels == (distance > 1 && n > 1 ? 4U : 0U));
}

TEST(ConstantDistance, L1_StaleReadsOnlyRemoveFragments) {
    for (const char* entry : {"entry=rgbz", "entry=z"}) {
        const Replay replay("gen:discs?n=300&overlap=12&width=64&height=64",
                            {64, 64, "transparency", "auto", {"k=8", entry}});
        const support::TrueFragments fragments(replay);
        for (const QuadId distance : {128U, 512U}) {
            const auto image = pipeline::run_reference(replay.frame, replay.streams, distance);
            ASSERT_GT(image.missed_reads, 0U);
            EXPECT_NE(image.kbuffer, replay.reference.kbuffer);
            EXPECT_EQ(fragments.first_violation_of_l1(image.kbuffer), "") << entry << ", H = " << distance;
        }
    }
}

TEST(ConstantDistance, L2_SurvivorsAreTheNearestOfTheChainOfReads) {
    const Replay replay("gen:discs?n=300&overlap=12&width=64&height=64", {.width = 64, .height = 64});
    const auto quads = support::quads_by_pixel(replay.kbuffer_stream());
    for (const QuadId distance : {1U, 2U, 5U, 33U, 512U}) {
        const auto image = pipeline::run_reference(replay.frame, replay.streams, distance);
        std::size_t wrong = 0;
        for (std::size_t pixel = 0; pixel < quads.size(); ++pixel) {
            const auto chain = chain_of(quads[pixel], distance);
            if (support::pixel_of(replay, image.kbuffer, pixel) != support::entries_of_chain(replay, pixel, chain))
                ++wrong;
        }
        EXPECT_EQ(wrong, 0U) << "H = " << distance;
    }
}

TEST(ConstantDistance, DistanceOneIsTheReferenceForAnyNumberOfThreads) {
    const Replay replay("gen:discs?n=300&overlap=12&width=64&height=64", {.width = 64, .height = 64});
    for (const QuadId distance : {1U, 33U}) {
        const auto one = pipeline::run_reference(replay.frame, replay.streams, distance, 1);
        const auto two = pipeline::run_reference(replay.frame, replay.streams, distance, 2);
        EXPECT_EQ(one.kbuffer, two.kbuffer);
        EXPECT_EQ(one.missed_reads, two.missed_reads);
        EXPECT_EQ(one.missed_pixels, two.missed_pixels);
        EXPECT_EQ(one.accepted_insertions, two.accepted_insertions);
        if (distance == 1) {
            EXPECT_EQ(one.kbuffer, replay.reference.kbuffer);
            EXPECT_EQ(one.missed_reads, 0U);
        }
    }
}

namespace {

double hazard_fraction(std::uint32_t quads, std::uint32_t side, QuadId distance) {
    const Replay replay(fmt::format("gen:random-quads?n={}&area={}", quads, side * side),
                        {.width = side, .height = side, .knobs = {"entry=z"}});
    EXPECT_EQ(replay.kbuffer_stream().fragments, std::uint64_t{4} * quads);
    const auto image = pipeline::run_reference(replay.frame, replay.streams, distance);
    return static_cast<double>(image.missed_reads) / (4.0 * quads);
}

} // namespace

TEST(ConstantDistance, K4_HazardFractionOfRandomQuadsOver4096Pixels) {
    const double fraction = hazard_fraction(100'000, 64, 256);
    RecordProperty("fraction", fmt::format("{:.4f}", fraction));
    EXPECT_NEAR(fraction, 1.0 - std::pow(1.0 - 4.0 / 4096.0, 256.0), 0.02);
    EXPECT_NEAR(fraction, 0.221, 0.02);
}

TEST(ConstantDistance, K4_HazardFractionOfRandomQuadsOver262144Pixels) {
    const double fraction = hazard_fraction(300'000, 512, 1536);
    RecordProperty("fraction", fmt::format("{:.4f}", fraction));
    EXPECT_NEAR(fraction, 1.0 - std::pow(1.0 - 4.0 / 262'144.0, 1536.0), 0.003);
    EXPECT_NEAR(fraction, 0.0232, 0.003);
}

} // namespace designs_constant_distance_test
