// Draws of one pass with states of their own, and states that are refused.
#include "sim/check.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace functional_state_of_draw_test {
namespace {

using namespace pipeline;
using tests::FunctionalScene;

TEST(StateOfDraw, EachDrawHasItsOwn) {
    FunctionalScene scene(32, 32);
    for (int i = 0; i < 3; ++i)
        scene.add(tests::rectangle(0, 0, 32, 32)); // the same vertices, transformed under two states
    scene.draws[1].geometry = scene.draws[2].geometry = 0;
    std::array<RasterState, 2> states;
    states[0].viewport = PixelRectangle{0, 0, 8, 8};
    states[1].viewport = PixelRectangle{16, 16, 16, 16};
    const std::vector<std::uint32_t> numbers{1, 0, 1};
    FrontEndOptions options;
    options.states = states;
    options.state_of_draw = numbers;
    const auto counts = tests::coverage_counts(scene.rasterize(options));
    EXPECT_EQ(counts[0], 1U);
    EXPECT_EQ(counts[20 * 32 + 20], 2U);
    EXPECT_EQ(counts[10 * 32 + 10], 0U);
}

TEST(StateOfDraw, WhatDoesNotFitIsRefused) {
    const auto error = [](const std::vector<RasterState>& states,
                          const std::vector<std::uint32_t>& numbers) -> std::string {
        FunctionalScene scene(8, 8);
        scene.add(tests::rectangle(0, 0, 8, 8));
        FrontEndOptions options;
        options.states = states;
        options.state_of_draw = numbers;
        try {
            scene.rasterize(options);
        } catch (const sim::InputError& refused) {
            return refused.what();
        }
        return "";
    };
    RasterState state;
    EXPECT_EQ(error({}, {}), "");
    EXPECT_EQ(error({state}, {}), "");
    EXPECT_EQ(error({state}, {1}), "state 1: expected one of 1 states");
    EXPECT_EQ(error({}, {0}), "state 0: expected one of 0 states");
    EXPECT_EQ(error({state}, {0, 0}), "states: expected one of each of 1 draws, not 2");
    state.viewport = PixelRectangle{0, 0, 0, 5};
    EXPECT_EQ(error({state}, {}),
              "state 0: expected a viewport of 1 to 16384 pixels a side at -16384 to 16384, not 0x5 at "
              "(0, 0)");
    state.viewport.reset();
    state.depth.bias_slope = NAN;
    EXPECT_EQ(error({state}, {}), "state 0: expected finite numbers");
}

} // namespace
} // namespace functional_state_of_draw_test
