// A7 in functional form: which streams it sorts (check K13), and that its picture is then the sorted composite.
#include "models/programs/order_and_blend.hpp"
#include "sim/random.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <vector>

namespace programs_order_and_blend_test {

using pipeline::ModifyProgram;

constexpr float opacity = 0.4F;

struct Layer {
    float depth;
    std::array<float, 3> colour;
};

struct State {
    std::array<float, 4> rgbt{0.0F, 0.0F, 0.0F, 1.0F};
    friend bool operator==(const State&, const State&) = default;
};

/// A11, in the order of the list.
State composite(const std::vector<Layer>& layers) {
    State state;
    for (const Layer& layer : layers) {
        const float weight = state.rgbt[3] * opacity;
        for (std::size_t i = 0; i < 3; ++i) state.rgbt[i] += weight * layer.colour[i];
        state.rgbt[3] *= 1.0F - opacity;
    }
    return state;
}

State run(std::uint32_t k, const std::vector<Layer>& layers) {
    const auto program = models::make_order_and_blend(k, opacity);
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    for (const Layer& layer : layers) {
        const std::array<float, 4> rgba{layer.colour[0], layer.colour[1], layer.colour[2], 1.0F};
        std::array<float, 4> entry;
        program->make_entry({rgba.data(), layer.depth, 0}, entry.data());
        program->insert(pixel.data(), entry.data());
    }
    program->drain(pixel.data());
    State state;
    std::copy_n(pixel.data() + std::size_t{k} * 4, 4, state.rgbt.begin());
    return state;
}

std::vector<Layer> sorted_layers(std::size_t count) {
    sim::Random random(3, "colours");
    std::vector<Layer> layers;
    for (std::size_t i = 0; i < count; ++i) {
        const auto channel = [&random] { return static_cast<float>(random.uniform()); };
        layers.push_back({static_cast<float>(i) / static_cast<float>(count), {channel(), channel(), channel()}});
    }
    return layers;
}

TEST(OrderAndBlend, K13_SortsEveryStreamDisplacedByAtMostK) {
    for (const std::uint32_t k : {1U, 2U, 4U, 8U}) {
        const std::vector<Layer> sorted = sorted_layers(32);
        for (std::size_t from = 0; from + k < sorted.size(); ++from) {
            std::vector<Layer> moved = sorted; // one layer comes k places too late
            std::rotate(moved.begin() + static_cast<std::ptrdiff_t>(from),
                        moved.begin() + static_cast<std::ptrdiff_t>(from + 1),
                        moved.begin() + static_cast<std::ptrdiff_t>(from + k + 1));
            EXPECT_EQ(run(k, moved), composite(sorted)) << k << " " << from;
        }
    }
}

TEST(OrderAndBlend, K13_OneMorePlaceIsAnInversion) {
    for (const std::uint32_t k : {1U, 2U, 4U, 8U}) {
        const std::vector<Layer> sorted = sorted_layers(32);
        std::vector<Layer> moved = sorted;
        std::rotate(moved.begin(), moved.begin() + 1, moved.begin() + k + 2);
        std::vector<Layer> popped = sorted; // the second is popped when the first, due before it, has not come
        std::swap(popped[0], popped[1]);
        EXPECT_EQ(run(k, moved), composite(popped)) << k;
        EXPECT_NE(run(k, moved), composite(sorted)) << k;
    }
}

RC_GTEST_PROP(OrderAndBlend, KeepsTheOrderOfArrivalOfEqualDepths, ()) {
    const auto k = *rc::gen::inRange<std::uint32_t>(1, 10);
    const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 4));
    std::vector<Layer> layers = sorted_layers(steps.size());
    for (std::size_t i = 0; i < layers.size(); ++i) layers[i].depth = static_cast<float>(steps[i]);
    std::vector<Layer> expected = layers;
    const auto nearer = [](const Layer& a, const Layer& b) { return a.depth < b.depth; };
    std::stable_sort(expected.begin(), expected.end(), nearer);
    // Within k places of their sorted place: at most k of the layers before one are farther than it.
    bool nearly_sorted = true;
    for (std::size_t i = 0; i < layers.size(); ++i)
        nearly_sorted &= std::count_if(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(i),
                                       [&](const Layer& one) { return layers[i].depth < one.depth; }) <=
                         static_cast<std::ptrdiff_t>(k);
    RC_PRE(nearly_sorted);
    RC_ASSERT(run(k, layers) == composite(expected));
}

TEST(OrderAndBlend, WarmUpIsNeutralAndDrainTwiceIsDrainOnce) {
    const auto program = models::make_order_and_blend(4, opacity);
    EXPECT_TRUE(program->drains());
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    const std::vector<float> cleared = pixel;
    program->drain(pixel.data());
    EXPECT_EQ(pixel, cleared);
    const std::array<float, 4> entry{0.2F, 0.4F, 0.6F, 0.5F};
    for (int i = 0; i < 4; ++i) program->insert(pixel.data(), entry.data());
    for (std::size_t i = 16; i < 20; ++i) EXPECT_EQ(pixel[i], cleared[i]); // four sentinels left, nothing blended
    program->drain(pixel.data());
    const std::vector<float> once = pixel;
    EXPECT_NEAR(once[19], 0.6F * 0.6F * 0.6F * 0.6F, 1e-6F);
    program->drain(pixel.data());
    EXPECT_EQ(pixel, once);
}

TEST(OrderAndBlend, DeclaresWhatItCosts) {
    const auto program = models::make_order_and_blend(4, opacity);
    EXPECT_EQ(program->cost().operations, 46U); // sort 4 * 9 + 1, compare, weights 2, channels 6
    EXPECT_EQ(program->targets(), 5U);
    EXPECT_EQ(program->order_need(), pipeline::OrderNeed::primitive_order);
    EXPECT_FALSE(program->needs_texture());
}

TEST(OrderAndBlend, StaysFinite) {
    const float huge = std::numeric_limits<float>::infinity();
    const State state = run(2, {{0.1F, {huge, -huge, std::numeric_limits<float>::quiet_NaN()}},
                                {0.2F, {huge, -huge, 1.0F}},
                                {0.3F, {huge, -huge, 1.0F}},
                                {0.4F, {huge, -huge, 1.0F}}});
    for (const float value : state.rgbt) EXPECT_TRUE(std::isfinite(value));
    EXPECT_GT(state.rgbt[0], 1e38F);
}

} // namespace programs_order_and_blend_test
