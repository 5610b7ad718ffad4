#include "models/programs/nearest_k.hpp"
#include "sim/random.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <rapidcheck/gtest.h>

namespace {

using models::EntryKind;
using pipeline::ModifyProgram;

struct Layer {
    float depth;
    int id;
    friend bool operator==(const Layer&, const Layer&) = default;
};

/// Runs A6 over fragments whose red channel holds their number; returns the filled entries.
std::vector<Layer> run_rgbz(const ModifyProgram& program, const std::vector<float>& depths) {
    std::vector<float> pixel(program.floats_per_pixel());
    program.clear(pixel.data());
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const std::array<float, 4> rgba{static_cast<float>(i), 0.0F, 0.0F, 1.0F};
        std::array<float, 4> entry;
        program.make_entry({rgba.data(), depths[i], 0}, entry.data());
        program.insert(pixel.data(), entry.data());
    }
    std::vector<Layer> layers;
    for (std::size_t i = 0; i < program.k(); ++i)
        if (pixel[i * 4 + 3] != models::empty_depth)
            layers.push_back({pixel[i * 4 + 3], static_cast<int>(pixel[i * 4])});
    return layers;
}

std::vector<Layer> nearest_stable(const std::vector<float>& depths, std::size_t k) {
    std::vector<Layer> all;
    for (std::size_t i = 0; i < depths.size(); ++i) all.push_back({depths[i], static_cast<int>(i)});
    std::stable_sort(all.begin(), all.end(), [](const Layer& a, const Layer& b) { return a.depth < b.depth; });
    all.resize(std::min(k, all.size()));
    return all;
}

// Few distinct depths, so that ties are the rule.
rc::Gen<std::vector<float>> any_depths() {
    return rc::gen::container<std::vector<float>>(
        rc::gen::map(rc::gen::inRange(0, 9), [](int step) { return static_cast<float>(step) / 8.0F; }));
}

RC_GTEST_PROP(NearestK, KeepsTheKSmallestDepthsInOrderAndTheFirstOfEqualOnes, ()) {
    const auto k = *rc::gen::inRange<std::uint32_t>(1, 65);
    const auto depths = *any_depths();
    RC_ASSERT(run_rgbz(*models::make_nearest_k(EntryKind::rgbz, k), depths) == nearest_stable(depths, k));
}

RC_GTEST_PROP(NearestK, KeepsTheSameDepthsWithAndWithoutColours, ()) {
    const auto k = *rc::gen::inRange<std::uint32_t>(1, 65);
    const auto depths = *any_depths();
    const auto program = models::make_nearest_k(EntryKind::z, k);
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    for (const float depth : depths) program->insert(pixel.data(), &depth);
    const auto expected = nearest_stable(depths, k);
    for (std::size_t i = 0; i < k; ++i)
        RC_ASSERT(pixel[i] == (i < expected.size() ? expected[i].depth : models::empty_depth));
}

RC_GTEST_PROP(NearestK, TellsWhetherItChangedThePixel, ()) {
    const auto k = *rc::gen::inRange<std::uint32_t>(1, 9);
    const auto depths = *any_depths();
    const auto program = models::make_nearest_k(EntryKind::z, k);
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    for (const float depth : depths) {
        const std::vector<float> before = pixel;
        const bool changed = program->insert(pixel.data(), &depth);
        RC_ASSERT(changed == (pixel != before));
    }
}

TEST(NearestK, LemmaL1_AtomicReadsOfStaleStatesOnlyRemoveFragments) {
    // Each fragment reads the state that some earlier fragment left, never a mixture.
    sim::Random rng(7, "stale states");
    const auto program = models::make_nearest_k(EntryKind::z, 4);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::vector<float>> states(1, std::vector<float>(program->floats_per_pixel()));
        program->clear(states[0].data());
        std::vector<float> all;
        for (int i = 0; i < 20; ++i) {
            std::vector<float> state = states[rng.below(states.size())];
            all.push_back(static_cast<float>(rng.uniform()));
            program->insert(state.data(), &all.back());
            states.push_back(std::move(state));
        }
        const std::vector<float>& last = states.back();
        EXPECT_TRUE(std::is_sorted(last.begin(), last.end()));
        EXPECT_EQ(std::adjacent_find(last.begin(), last.end(),
                                     [](float a, float b) { return a == b && a != models::empty_depth; }),
                  last.end());
        for (const float depth : last)
            EXPECT_TRUE(depth == models::empty_depth || std::count(all.begin(), all.end(), depth) == 1);
    }
}

TEST(NearestK, UnsortedEntriesGoThroughTheWholeBubblePass) {
    const auto program = models::make_nearest_k(EntryKind::z, 4);
    std::array<float, 4> pixel{0.2F, 0.8F, 0.3F, 0.9F}; // as a torn read may leave them
    const float depth = 0.5F;
    EXPECT_TRUE(program->insert(pixel.data(), &depth));
    EXPECT_EQ(pixel, (std::array<float, 4>{0.2F, 0.5F, 0.3F, 0.8F}));
}

double mean_insertions(std::uint32_t k, std::size_t count, std::size_t pixels) {
    sim::Random rng(1, "insertions");
    const auto program = models::make_nearest_k(EntryKind::z, k);
    std::uint64_t accepted = 0;
    for (std::size_t p = 0; p < pixels; ++p) {
        std::array<float, 64> pixel{};
        program->clear(pixel.data());
        for (std::size_t i = 0; i < count; ++i) {
            const auto depth = static_cast<float>(rng.uniform());
            accepted += program->insert(pixel.data(), &depth) ? 1 : 0;
        }
    }
    return static_cast<double>(accepted) / static_cast<double>(pixels);
}

TEST(NearestK, K10_RandomDepthsAcceptKPlusKTimesHarmonicDifference) {
    EXPECT_NEAR(mean_insertions(4, 16, 100000), 9.19, 0.0919);
    EXPECT_NEAR(mean_insertions(8, 16, 100000), 13.30, 0.1330);
}

std::size_t accepted_of(const std::vector<float>& depths, std::uint32_t k) {
    const auto program = models::make_nearest_k(EntryKind::z, k);
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    std::size_t accepted = 0;
    for (const float depth : depths) accepted += program->insert(pixel.data(), &depth) ? 1U : 0U;
    return accepted;
}

TEST(NearestK, K10_FrontToBackAcceptsKAndBackToFrontAll) {
    std::vector<float> depths(16);
    std::iota(depths.begin(), depths.end(), 1.0F);
    for (const std::uint32_t k : {1U, 4U, 8U, 16U}) EXPECT_EQ(accepted_of(depths, k), k);
    std::reverse(depths.begin(), depths.end());
    for (const std::uint32_t k : {1U, 4U, 8U, 16U}) EXPECT_EQ(accepted_of(depths, k), 16U);
}

TEST(NearestK, K12_CostsAreThoseOfTheSpecification) {
    const auto rgbz = models::make_nearest_k(EntryKind::rgbz, 4);
    const auto z = models::make_nearest_k(EntryKind::z, 16);
    EXPECT_EQ(rgbz->cost().operations, 36U); // 9 cycles with 4 lanes
    EXPECT_EQ(z->cost().operations, 48U);    // 12 cycles with 4 lanes
    EXPECT_EQ(rgbz->bytes_per_pixel(), 64U);
    EXPECT_EQ(z->bytes_per_pixel(), 64U);
}

TEST(NearestK, FarPlaneIsNearerThanEmptyAndNaNIsDropped) {
    const auto program = models::make_nearest_k(EntryKind::z, 2);
    std::array<float, 4> pixel{};
    program->clear(pixel.data());
    EXPECT_EQ(pixel, (std::array<float, 4>{models::empty_depth, models::empty_depth, 0.0F, 0.0F}));
    const float far = 1.0F;
    EXPECT_TRUE(program->insert(pixel.data(), &far));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(program->insert(pixel.data(), &nan));
    EXPECT_EQ(pixel[0], 1.0F);
}

TEST(NearestK, EntriesLieAsTheContractSays) {
    const auto rgbz = models::make_nearest_k(EntryKind::rgbz, 4);
    const std::array<float, 4> rgba{0.1F, 0.2F, 0.3F, 0.4F};
    std::array<float, 4> entry{};
    rgbz->make_entry({rgba.data(), 0.7F, 0}, entry.data());
    EXPECT_EQ(entry, (std::array<float, 4>{0.1F, 0.2F, 0.3F, 0.7F}));
    EXPECT_EQ(rgbz->depth_slot(), 3U);
    EXPECT_TRUE(rgbz->needs_colour());
    EXPECT_FALSE(models::make_nearest_k(EntryKind::z, 4)->needs_colour());
}

} // namespace
