// A15: crossings of iso-values between samples, counted once each, and the nearest of them.
#include "models/programs/isosurface.hpp"
#include "models/programs/nearest_k.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace {

using models::IsosurfaceSetup;
using models::IsosurfaceState;

struct Sample {
    float distance, scalar;
};

/// An identity projection has distance 1 - 2 * window.
float window_of(float distance) { return 0.5F - 0.5F * distance; }

IsosurfaceState run(const std::vector<float>& iso_values, const std::vector<Sample>& samples, std::uint32_t k = 4) {
    IsosurfaceSetup setup;
    setup.k = k;
    setup.iso_values = iso_values;
    const auto program = models::make_isosurface(setup);
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    for (const Sample& sample : samples) {
        const std::array<float, 2> entry{sample.distance, sample.scalar};
        program->insert(pixel.data(), entry.data());
    }
    program->drain(pixel.data());
    for (const float value : pixel) EXPECT_TRUE(std::isfinite(value));
    return models::isosurface_state(*program, pixel.data());
}

TEST(Isosurface, FindsTheCrossingOfASegment) {
    const IsosurfaceState state = run({0.25F}, {{2.0F, 0.0F}, {4.0F, 1.0F}});
    EXPECT_EQ(state.distance, 2.5F);
    EXPECT_EQ(state.iso, 0.0F);
    EXPECT_EQ(state.hits, 1.0F);
    EXPECT_EQ(state.slope, 1.0F);
}

TEST(Isosurface, KeepsTheNearestOfSeveralIsoValues) {
    const IsosurfaceState state = run({0.25F, 0.75F, 2.0F}, {{1.0F, 1.0F}, {2.0F, 0.0F}, {3.0F, 1.0F}});
    EXPECT_EQ(state.distance, 1.25F);
    EXPECT_EQ(state.iso, 1.0F); // 0.75, met first on the way down
    EXPECT_EQ(state.hits, 4.0F);
    EXPECT_EQ(state.slope, -1.0F);
}

TEST(Isosurface, NothingIsHitWithoutACrossing) {
    for (const auto& samples : {std::vector<Sample>{}, std::vector<Sample>{{1.0F, 1.0F}},
                                std::vector<Sample>{{1.0F, 1.0F}, {2.0F, 0.6F}, {3.0F, 0.9F}}}) {
        const IsosurfaceState state = run({0.5F}, samples);
        EXPECT_EQ(state.distance, models::empty_depth);
        EXPECT_EQ(state.iso, -1.0F);
        EXPECT_EQ(state.hits, 0.0F);
    }
}

TEST(Isosurface, ACrossingAtASampleCountsOnce) {
    const IsosurfaceState through = run({0.5F}, {{1.0F, 0.0F}, {2.0F, 0.5F}, {3.0F, 1.0F}});
    EXPECT_EQ(through.hits, 1.0F);
    EXPECT_EQ(through.distance, 2.0F);
    const IsosurfaceState down = run({0.5F}, {{1.0F, 1.0F}, {2.0F, 0.5F}, {3.0F, 0.0F}});
    EXPECT_EQ(down.hits, 1.0F);
    EXPECT_EQ(down.distance, 2.0F);
    // A plateau of the value itself counts as above it.
    EXPECT_EQ(run({0.5F}, {{1.0F, 0.0F}, {2.0F, 0.5F}, {3.0F, 0.5F}, {4.0F, 0.0F}}).hits, 2.0F);
    // Touching from above is no crossing, from below it goes in and out.
    EXPECT_EQ(run({0.5F}, {{1.0F, 1.0F}, {2.0F, 0.5F}, {3.0F, 1.0F}}).hits, 0.0F);
    EXPECT_EQ(run({0.5F}, {{1.0F, 0.0F}, {2.0F, 0.5F}, {3.0F, 0.0F}}).hits, 2.0F);
}

TEST(Isosurface, EqualScalarsAndEqualDistancesAreSafe) {
    EXPECT_EQ(run({0.5F}, {{1.0F, 0.5F}, {2.0F, 0.5F}}).hits, 0.0F);
    const IsosurfaceState step = run({0.5F}, {{2.0F, 0.0F}, {2.0F, 1.0F}});
    EXPECT_EQ(step.hits, 1.0F);
    EXPECT_EQ(step.distance, 2.0F);
    constexpr float huge = std::numeric_limits<float>::max();
    EXPECT_EQ(run({0.0F}, {{-huge / 2.0F, -huge}, {huge, huge}}).hits, 1.0F);
    EXPECT_EQ(run({0.5F}, {{1.0F, std::nextafter(0.5F, 0.0F)}, {3.0F, 0.5F}}).distance, 3.0F);
}

TEST(Isosurface, SortsSamplesThatAreFewerThanKPlacesLate) {
    sim::Random random(9, "field");
    for (const std::uint32_t k : {2U, 3U, 8U}) {
        std::vector<Sample> sorted;
        for (int i = 0; i < 24; ++i)
            sorted.push_back({1.0F + static_cast<float>(i), static_cast<float>(random.uniform())});
        std::vector<Sample> moved = sorted;
        for (std::size_t i = 0; i + k <= moved.size(); i += k)
            std::reverse(moved.begin() + static_cast<std::ptrdiff_t>(i),
                         moved.begin() + static_cast<std::ptrdiff_t>(i + k));
        const IsosurfaceState state = run({0.3F, 0.5F, 0.9F}, moved, k), expected = run({0.3F, 0.5F, 0.9F}, sorted, k);
        EXPECT_GT(expected.hits, 10.0F);
        EXPECT_EQ(state.hits, expected.hits);
        EXPECT_EQ(state.distance, expected.distance);
    }
}

TEST(Isosurface, EntriesAreDistancesAndRedChannels) {
    const auto program = models::make_isosurface({});
    const std::array<float, 4> rgba{0.3F, 0.7F, 0.8F, 1.0F};
    std::array<float, 2> entry{};
    program->make_entry({rgba.data(), window_of(0.5F), 0}, entry.data());
    EXPECT_EQ(entry, (std::array<float, 2>{0.5F, 0.3F}));
    const std::array<float, 4> bad{std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 1.0F};
    program->make_entry({bad.data(), 0.5F, 0}, entry.data());
    EXPECT_EQ(entry[1], 0.0F);
    EXPECT_FALSE(program->needs_texture());
}

TEST(Isosurface, RefusesIsoValuesThatAreNone) {
    IsosurfaceSetup setup;
    setup.iso_values = {};
    EXPECT_THROW(models::make_isosurface(setup), sim::InputError);
    setup.iso_values = {std::numeric_limits<float>::infinity()};
    EXPECT_THROW(models::make_isosurface(setup), sim::InputError);
}

} // namespace
