// Depth compares, stencil test and operations.
#include "pipeline/functional/fragment_operations.hpp"

#include <array>
#include <gtest/gtest.h>

namespace stencil_test {

using namespace pipeline;

TEST(Compare, EveryOperationOfLessEqualAndGreater) {
    // passes for: less, equal, greater
    const std::array<std::array<bool, 3>, 8> table{{{false, false, false},
                                                    {true, false, false},
                                                    {false, true, false},
                                                    {true, true, false},
                                                    {false, false, true},
                                                    {true, false, true},
                                                    {false, true, true},
                                                    {true, true, true}}};
    for (std::size_t compare = 0; compare < 8; ++compare)
        for (std::size_t incoming = 0; incoming < 3; ++incoming)
            EXPECT_EQ(passes(static_cast<Compare>(compare), incoming, std::size_t{1}), table[compare][incoming]);
}

TEST(Stencil, EveryOperationAtItsEnds) {
    StencilFace face;
    face.reference = 0x5A;
    const auto after = [&face](StencilOperation operation, std::uint8_t stored) {
        return static_cast<int>(stencil_after(face, operation, stored));
    };
    for (int stored = 0; stored < 256; ++stored) {
        const auto byte = static_cast<std::uint8_t>(stored);
        EXPECT_EQ(after(StencilOperation::keep, byte), stored);
        EXPECT_EQ(after(StencilOperation::zero, byte), 0);
        EXPECT_EQ(after(StencilOperation::replace, byte), 0x5A);
        EXPECT_EQ(after(StencilOperation::increment, byte), stored == 255 ? 255 : stored + 1);
        EXPECT_EQ(after(StencilOperation::decrement, byte), stored == 0 ? 0 : stored - 1);
        EXPECT_EQ(after(StencilOperation::increment_wrap, byte), stored == 255 ? 0 : stored + 1);
        EXPECT_EQ(after(StencilOperation::decrement_wrap, byte), stored == 0 ? 255 : stored - 1);
        EXPECT_EQ(after(StencilOperation::invert, byte), 255 - stored);
    }
    face.write_mask = 0x0F;
    EXPECT_EQ(after(StencilOperation::replace, 0xC3), 0xCA);
    EXPECT_EQ(after(StencilOperation::increment_wrap, 0x3F), 0x30); // the carry is cut off
}

/// Stencil 1, the reference too, and depth 100.
struct Pixel {
    RasterState state;
    DepthCode depth = 100;
    std::uint8_t stencil = 1;

    Pixel() {
        state.depth.test = state.depth.write = true;
        state.stencil.test = true;
        state.stencil.front.compare = Compare::equal;
        state.stencil.front.reference = 1;
        state.stencil.front.stencil_fails = StencilOperation::zero;
        state.stencil.front.depth_fails = StencilOperation::increment;
        state.stencil.front.passes = StencilOperation::invert;
        state.stencil.back = state.stencil.front;
        state.stencil.back.passes = StencilOperation::keep;
    }
    FragmentTest draw(DepthCode incoming, bool front = true) {
        return test_fragment(state, front, incoming, &depth, &stencil);
    }
};

TEST(Stencil, TheTestsChooseTheOperation) {
    Pixel passes;
    EXPECT_TRUE(passes.draw(50).passed());
    EXPECT_EQ(passes.stencil, 0xFE);
    EXPECT_EQ(passes.depth, 50U);

    Pixel behind;
    EXPECT_TRUE(behind.draw(150).depth_failed);
    EXPECT_EQ(behind.stencil, 2);
    EXPECT_EQ(behind.depth, 100U);

    Pixel masked;
    masked.stencil = 3;
    const FragmentTest test = masked.draw(50);
    EXPECT_TRUE(test.stencil_failed);
    EXPECT_FALSE(test.depth_failed); // is not made
    EXPECT_EQ(masked.stencil, 0);
    EXPECT_EQ(masked.depth, 100U);

    masked.stencil = 3;
    masked.state.stencil.front.compare_mask = 0x01;
    EXPECT_TRUE(masked.draw(50).passed());

    Pixel back;
    EXPECT_TRUE(back.draw(50, false).passed());
    EXPECT_EQ(back.stencil, 1);
}

TEST(Stencil, WhatStoresNothingIsNotWritten) {
    Pixel pixel;
    EXPECT_TRUE(pixel.draw(50).written);
    pixel.state.depth.write = false;
    pixel.stencil = 1;
    EXPECT_TRUE(pixel.draw(40).written); // the stencil
    pixel.stencil = 1;
    EXPECT_FALSE(pixel.draw(40, false).written);
    pixel.state.stencil.front.write_mask = 0;
    EXPECT_FALSE(pixel.draw(40).written);
}

TEST(Stencil, ReferenceComparesWithStored) {
    Pixel pixel;
    pixel.state.stencil.front.compare = Compare::less; // reference < stored
    pixel.stencil = 2;
    EXPECT_FALSE(pixel.draw(50).stencil_failed);
    pixel.stencil = 0;
    EXPECT_TRUE(pixel.draw(50).stencil_failed);
}

TEST(Stencil, ASurfaceWithoutOnePassesTheTest) {
    Pixel pixel;
    pixel.state.stencil.front.compare = Compare::never;
    EXPECT_TRUE(test_fragment(pixel.state, true, 50, &pixel.depth, nullptr).passed());
    EXPECT_FALSE(test_fragment(pixel.state, true, 150, &pixel.depth, nullptr).passed());
    pixel.state.stencil.front.compare = Compare::equal;
    pixel.stencil = 1;
    EXPECT_TRUE(test_fragment(pixel.state, true, 150, nullptr, &pixel.stencil).passed());
    EXPECT_EQ(pixel.stencil, 0xFE);
}

} // namespace stencil_test
