// Programs that need no sort of their own: depth partition, z-buffer, stencil, layers with objects, blended layers.
#include "models/programs/depth_partition.hpp"
#include "models/programs/mlab.hpp"
#include "models/programs/nearest_k.hpp"
#include "models/programs/stencil.hpp"
#include "models/programs/z_buffer.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace programs_fixed_function_test {

using pipeline::ModifyProgram;

std::vector<float> cleared(const ModifyProgram& program) {
    std::vector<float> pixel(program.floats_per_pixel());
    program.clear(pixel.data());
    return pixel;
}

/// Runs the program for fragments whose red channel is their number.
std::vector<float> after(const ModifyProgram& program, const std::vector<float>& depths) {
    std::vector<float> pixel = cleared(program);
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const std::array<float, 4> rgba{static_cast<float>(i), 0.25F, 0.5F, 1.0F};
        std::array<float, pipeline::largest_entry> entry{};
        program.make_entry({rgba.data(), depths[i], static_cast<std::uint32_t>(i)}, entry.data());
        program.insert(pixel.data(), entry.data());
    }
    return pixel;
}

std::string error_of(std::vector<float> bounds) {
    try {
        models::make_depth_partition(std::move(bounds));
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(DepthPartition, KeepsTheNearestOfEachRange) {
    const auto program = models::make_depth_partition({0.1F, 0.3F, 0.6F, 0.9F});
    ASSERT_EQ(program->k(), 3U);
    const auto pixel = after(*program, {0.5F, 0.4F, 0.7F, 0.05F, 0.9F, 0.65F, 0.4F});
    EXPECT_EQ(pixel[3], models::empty_depth);
    EXPECT_EQ(pixel[7], 0.4F);
    EXPECT_EQ(pixel[4], 1.0F); // the first of depth 0.4
    EXPECT_EQ(pixel[11], 0.65F);
    EXPECT_EQ(pixel[8], 5.0F);
}

TEST(DepthPartition, LowerBoundsBelongToARangeAndUpperOnesDoNot) {
    const auto program = models::make_depth_partition({0.25F, 0.5F, 0.75F});
    const auto pixel = after(*program, {0.5F, 0.25F, 0.75F});
    EXPECT_EQ(pixel[3], 0.25F);
    EXPECT_EQ(pixel[7], 0.5F);
    EXPECT_EQ(after(*program, {std::nextafter(0.5F, 0.0F)})[3], std::nextafter(0.5F, 0.0F));
    EXPECT_EQ(program->peeling(), pipeline::Peeling::ranges);
    EXPECT_EQ(program->range(1).near, 0.5F);
    EXPECT_EQ(program->range(1).far, 0.75F);
}

TEST(DepthPartition, RefusesBoundsThatDoNotAscend) {
    EXPECT_EQ(error_of({0.0F}), "depth-partition: expected 2 to 65 bounds, got 1");
    EXPECT_EQ(error_of({0.0F, 0.5F, 0.5F}),
              "depth-partition: bound 2: expected a number greater than the one before, got 0.5");
    EXPECT_EQ(error_of({0.0F, std::numeric_limits<float>::quiet_NaN()}),
              "depth-partition: bound 1: expected a number greater than the one before, got nan");
    EXPECT_EQ(error_of({0.0F, 1.0F}), "");
}

TEST(ZBuffer, IsTheFirstEntryOfNearestK) {
    sim::Random random(4, "depths");
    const auto program = models::make_z_buffer();
    const auto nearest = models::make_nearest_k(models::EntryKind::rgbz, 3);
    for (int round = 0; round < 50; ++round) {
        std::vector<float> depths;
        for (int i = 0; i < 12; ++i) depths.push_back(static_cast<float>(random.below(8)) / 8.0F);
        std::vector<float> expected = after(*nearest, depths);
        expected.resize(4);
        EXPECT_EQ(after(*program, depths), expected);
    }
    EXPECT_EQ(program->cost().operations, 5U);
    EXPECT_EQ(program->peeling(), pipeline::Peeling::nearest);
}

TEST(Stencil, CountsUpToItsEightBits) {
    const auto program = models::make_stencil({});
    EXPECT_EQ(after(*program, std::vector<float>(200, 0.5F))[1], 200.0F);
    EXPECT_EQ(after(*program, std::vector<float>(300, 0.5F))[1], 255.0F);
    EXPECT_FALSE(program->needs_colour());
}

TEST(Stencil, ComparesTheReferenceWithWhatIsStored) {
    using enum models::StencilCompare;
    const auto passes = [](models::StencilCompare compare, std::uint8_t reference) {
        const auto program = models::make_stencil({compare, reference});
        std::array<float, 4> pixel{models::empty_depth, 5.0F, 0.0F, 0.0F};
        const std::array<float, 2> entry{0.5F, 0.0F};
        program->insert(pixel.data(), entry.data());
        return pixel[1] == 6.0F && pixel[0] == 0.5F;
    };
    const std::vector<std::tuple<models::StencilCompare, bool, bool, bool>> expected{
        // compare, and whether 4, 5 and 6 pass against 5
        {always, true, true, true},         {never, false, false, false}, {less, true, false, false},
        {less_or_equal, true, true, false}, {equal, false, true, false},  {not_equal, true, false, true},
        {greater, false, false, true}};
    for (const auto& [compare, below, same, above] : expected) {
        EXPECT_EQ(passes(compare, 4), below) << static_cast<int>(compare);
        EXPECT_EQ(passes(compare, 5), same) << static_cast<int>(compare);
        EXPECT_EQ(passes(compare, 6), above) << static_cast<int>(compare);
    }
}

TEST(Stencil, FailingHasAnOperationOfItsOwn) {
    // The third layer and what is behind it: counts down to zero from a replaced value.
    const auto program = models::make_stencil(
        {models::StencilCompare::not_equal, 0, models::StencilOperation::decrement, models::StencilOperation::keep});
    std::vector<float> pixel = cleared(*program);
    pixel[1] = 2.0F;
    const std::array<float, 2> entry{0.5F, 0.0F};
    EXPECT_TRUE(program->insert(pixel.data(), entry.data()));
    EXPECT_TRUE(program->insert(pixel.data(), entry.data()));
    EXPECT_FALSE(program->insert(pixel.data(), entry.data()));
    EXPECT_EQ(pixel[1], 0.0F);
}

TEST(NearestK, KeepsObjectsBesideDepths) {
    const auto program = models::make_nearest_k(models::EntryKind::zo, 2);
    EXPECT_EQ(program->floats_per_entry(), 2U);
    EXPECT_EQ(program->depth_slot(), 0U);
    EXPECT_FALSE(program->needs_colour());
    EXPECT_EQ(program->targets(), 1U);
    EXPECT_EQ(after(*program, {0.7F, 0.2F, 0.5F}), (std::vector<float>{0.2F, 1.0F, 0.5F, 2.0F}));
}

// What is seen of nodes before white.
std::array<float, 3> picture(const std::vector<float>& pixel, std::uint32_t k) {
    std::array<float, 3> colour{0.0F, 0.0F, 0.0F};
    float through = 1.0F;
    for (std::uint32_t i = 0; i < k; ++i) {
        for (std::size_t c = 0; c < 3; ++c) colour[c] += through * pixel[i * 5 + c];
        through *= pixel[i * 5 + 3];
    }
    for (float& channel : colour) channel += through;
    return colour;
}

TEST(Mlab, IsTheSortedCompositeWhileThereIsRoom) {
    const std::vector<float> depths{0.5F, 0.1F, 0.9F, 0.3F};
    const auto roomy = after(*models::make_mlab(8, 0.5F), depths);
    EXPECT_EQ(roomy[4], 0.1F);
    EXPECT_EQ(roomy[9], 0.3F);
    // Red of the fragments: 1, 3, 0, 2 from front to back, each of opacity a half, before white.
    EXPECT_NEAR(picture(roomy, 8)[0], 0.5F * 1 + 0.25F * 3 + 0.125F * 0 + 0.0625F * 2 + 0.0625F, 1e-6F);
}

TEST(Mlab, OverflowChangesTheOrderButLosesNothing) {
    std::vector<float> sorted(20);
    for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = static_cast<float>(i) / 20.0F;
    const auto few = after(*models::make_mlab(4, 0.3F), sorted);
    const auto many = after(*models::make_mlab(20, 0.3F), sorted);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(picture(few, 4)[c], picture(many, 20)[c], 1e-5F);
    float through = 1.0F;
    for (std::size_t i = 0; i < 4; ++i) through *= few[i * 5 + 3];
    EXPECT_NEAR(through, std::pow(0.7F, 20.0F), 1e-7F);
    std::reverse(sorted.begin(), sorted.end()); // back to front: the last node is merged from behind
    const auto reversed = after(*models::make_mlab(4, 0.3F), sorted);
    through = 1.0F;
    for (std::size_t i = 0; i < 4; ++i) through *= reversed[i * 5 + 3];
    EXPECT_NEAR(through, std::pow(0.7F, 20.0F), 1e-7F);
    EXPECT_EQ(models::make_mlab(4, 0.3F)->cost().operations, 4U * 11 + 7);
}

} // namespace programs_fixed_function_test
