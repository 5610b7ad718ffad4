// Circles of confusion and the discs that they blur with.
#include "traces/workloads/lens_blur.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace {

using traces::DiscAccumulator;
using traces::Discs;
using traces::Lens;

TEST(Lens, CircleOfConfusionIsThatOfAThinLens) {
    const Lens lens{.aperture = 0.5, .focal_length = 0.1, .focus = 5.0, .pixels_per_slope = 200.0};
    EXPECT_EQ(lens.circle_of_confusion(5.0), 0.0);
    // c = A f |z - z_f| / (z (z_f - f)) on a plane at f; a slope of 1 is f there and 200 pixels.
    EXPECT_DOUBLE_EQ(lens.circle_of_confusion(10.0), 0.5 * 0.1 * 5.0 / (10.0 * 4.9) / 0.1 * 200.0);
    EXPECT_DOUBLE_EQ(lens.circle_of_confusion(2.5), 0.5 * 0.1 * 2.5 / (2.5 * 4.9) / 0.1 * 200.0);
    EXPECT_NEAR(lens.circle_of_confusion(1e30), 0.5 / 4.9 * 200.0, 1e-9);
    EXPECT_EQ(lens.circle_of_confusion(0.0), 0.0); // at the lens there is none
}

TEST(Discs, OfOnePixelOrLessLeaveItAsItIs) {
    for (const double diameter : {0.0, 0.5, 1.0}) {
        const Discs shapes(1.0);
        DiscAccumulator discs(shapes, 5, 0, 5);
        discs.add(2, 3, diameter, {0.25F, 0.5F, 0.75F});
        const auto picture = discs.picture();
        for (std::size_t i = 0; i < picture.size(); ++i)
            EXPECT_EQ(picture[i], i == 3 * 5 + 2 ? glm::vec4(0.25F, 0.5F, 0.75F, 1.0F) : glm::vec4(0.0F)) << diameter;
    }
}

TEST(Discs, WeighOneAndAreRoundAndAsWideAsAsked) {
    for (const double diameter : {2.0, 3.5, 8.0, 20.0, 63.75}) {
        constexpr int size = 81, middle = 40;
        const Discs shapes(64.0);
        DiscAccumulator discs(shapes, size, 0, size);
        discs.add(middle, middle, diameter, glm::vec3(1.0F));
        const auto picture = discs.picture();
        double sum = 0.0, moment = 0.0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const double weight = static_cast<double>(picture[static_cast<std::size_t>(y * size + x)].a);
                const double r2 = (x - middle) * (x - middle) + (y - middle) * (y - middle);
                sum += weight;
                moment += weight * r2;
                const double radius = std::sqrt(r2);
                if (radius > diameter / 2.0 + 0.5) {
                    EXPECT_EQ(weight, 0.0) << x << ' ' << y << ' ' << diameter;
                } else if (radius < diameter / 2.0 - 0.5) {
                    EXPECT_NEAR(weight, 4.0 / (std::numbers::pi * diameter * diameter), 0.2 / (diameter * diameter));
                }
            }
        EXPECT_NEAR(sum, 1.0, 1e-5) << diameter;
        // The mean square distance from the middle of a disc is r^2 / 2.
        EXPECT_NEAR(moment, diameter * diameter / 8.0, 0.1 * diameter * diameter / 8.0 + 0.35) << diameter;
    }
}

TEST(Discs, OfOneSizeSpreadAnEdgeOverTheirDiameter) {
    constexpr std::uint32_t size = 64;
    constexpr double diameter = 10.0;
    const Discs shapes(diameter);
    DiscAccumulator discs(shapes, size, 0, size);
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size / 2; ++x) discs.add(x, y, diameter, glm::vec3(1.0F));
    const auto picture = discs.picture();
    const glm::vec4* row = picture.data() + std::size_t{size} * (size / 2);
    // Half covered at the edge between pixels 31 and 32, wholly and not at all beyond half a diameter.
    EXPECT_NEAR(row[31].a + row[32].a, 1.0F, 1e-5F);
    EXPECT_NEAR(row[size / 2 - 7].a, 1.0F, 1e-5F);
    EXPECT_LT(row[size / 2 - 5].a, 1.0F - 1e-4F);
    EXPECT_GT(row[size / 2 + 4].a, 1e-4F);
    EXPECT_EQ(row[size / 2 + 6].a, 0.0F);
    for (std::uint32_t x = 8; x < size / 2 + 4; ++x) EXPECT_NEAR(row[x].r, 1.0F, 1e-6F); // the colour stays
}

TEST(Discs, BeyondTheBorderAreCutOff) {
    const Discs shapes(500.0);
    DiscAccumulator discs(shapes, 3, 0, 2);
    discs.add(0, 0, 500.0, glm::vec3(0.5F));
    for (const glm::vec4& pixel : discs.picture()) {
        EXPECT_GT(pixel.a, 0.0F);
        EXPECT_LT(pixel.a, 1e-4F);
        EXPECT_NEAR(pixel.r, 0.5F, 1e-6F);
    }
}

TEST(Discs, ReachNoFurtherThanTheLargest) {
    for (const double diameter : {0.0, 1.0, 2.0, 9.75, 64.0}) {
        const Discs shapes(diameter);
        std::uint32_t reach = 0;
        for (const Discs::Run& run : shapes.disc(diameter))
            reach = std::max(reach, static_cast<std::uint32_t>(std::abs(run.row)));
        EXPECT_EQ(reach, shapes.reach()) << diameter;
    }
}

TEST(Discs, GiveEachRowTheSameWhateverOthersThereAre) {
    constexpr std::uint32_t width = 23, height = 37;
    const Discs shapes(40.0);
    const auto picture = [&](std::uint32_t first, std::uint32_t rows) {
        DiscAccumulator discs(shapes, width, first, rows);
        for (std::uint32_t i = 0; i < width * height; ++i)
            discs.add(i % width, i / width, static_cast<double>(i * 7 % 161) / 4.0,
                      glm::vec3(0.1F, 0.3F, 0.7F) * static_cast<float>(i % 5));
        return discs.picture();
    };
    const std::vector<glm::vec4> whole = picture(0, height);
    for (const std::uint32_t rows : {1U, 16U, 30U})
        for (std::uint32_t first = 0; first < height; first += rows) {
            const std::vector<glm::vec4> strip = picture(first, std::min(rows, height - first));
            EXPECT_TRUE(std::equal(strip.begin(), strip.end(), whole.begin() + first * width)) << first << ' ' << rows;
        }
}

} // namespace
