// Depth of field of three planes: each in its range, the sharp one unchanged, the others blurred by the thin lens's
// circle of confusion (specification 004, A14).
#include "models/programs/nearest_k.hpp" // empty_depth
#include "pipeline/functional/eye_depth.hpp"
#include "tests/support/replay.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>

namespace workload_depth_of_field_test {

using support::Replay;

constexpr std::uint32_t size = 120; // a plane covers 36 pixels across, a square of it 9
const std::vector<double> distances{4.0, 7.0, 12.0};

Replay planes(std::vector<std::string> knobs) {
    return Replay("gen:planes",
                  {.width = size, .height = size, .workload = "depth-of-field", .knobs = std::move(knobs)});
}

const float* entry(const Replay& replay, std::size_t pixel, std::uint32_t slot) {
    return replay.reference.kbuffer.data() + pixel * replay.frame.program->floats_per_pixel() + slot * 4;
}

/// Red, green and blue of the picture, and of what is drawn without any blur.
float shown(const Replay& replay, std::uint32_t x, std::uint32_t y, std::size_t channel) {
    return replay.reference.picture[(std::size_t{y} * size + x) * 4 + channel];
}

TEST(DepthOfField, EachPlaneLiesInItsRange) {
    const Replay replay = planes({});
    ASSERT_EQ(replay.frame.program->k(), 3U);
    std::array<std::size_t, 3> seen{};
    const pipeline::EyeDepth depth(replay.frame.view.projection);
    for (std::size_t pixel = 0; pixel < std::size_t{size} * size; ++pixel)
        for (std::uint32_t slot = 0; slot < 3; ++slot) {
            const float* one = entry(replay, pixel, slot);
            if (one[3] == models::empty_depth) continue;
            ++seen[slot];
            EXPECT_EQ(pixel % size / 40, slot); // a third of the picture each
            EXPECT_NEAR(depth.distance(one[3]), distances[slot], 1e-3);
        }
    for (const std::size_t pixels : seen) EXPECT_EQ(pixels, 36U * 36U);
}

TEST(DepthOfField, ThePlaneInFocusStaysAsItIs) {
    for (const std::uint32_t slot : {0U, 1U, 2U}) {
        const Replay replay = planes({fmt::format("focus={}", distances[slot]), "aperture=0.3"});
        std::size_t changed = 0, inside = 0;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = slot * 40 + 10; x < slot * 40 + 30; ++x) { // away from what its neighbours spread
                const float* one = entry(replay, std::size_t{y} * size + x, slot);
                if (one[3] == models::empty_depth) continue;
                ++inside;
                for (std::size_t channel = 0; channel < 3; ++channel)
                    changed += std::fabs(shown(replay, x, y, channel) - one[channel]) > 1e-6F;
            }
        EXPECT_EQ(inside, 20U * 36U);
        EXPECT_EQ(changed, 0U) << "range " << slot;
    }
}

TEST(DepthOfField, EdgesAreBlurredOverTheCircleOfConfusion) {
    const double aperture = 0.4, focal = 0.1, focus = 4.0;
    const Replay replay = planes({"focus=4", "aperture=0.4", "focal_length=0.1"});
    // The thin lens, from specification 004: on a picture plane at f that is 2 f tan(20 degrees) high.
    const double z = 12.0, circle = aperture * focal * (z - focus) / (z * (focus - focal));
    const double pixels = circle / (2.0 * focal * std::tan(20.0 * std::numbers::pi / 180.0)) * size;
    ASSERT_GT(pixels, 8.0);
    // The upper edge of the right plane, seen in its middle column, against the white background: the plane's cover
    // falls from one to none over `pixels`. A disc over the edge covers what a circle's segment has.
    const std::uint32_t column = 100;
    std::uint32_t first = size, last = 0;
    for (std::uint32_t y = 0; y < size / 2; ++y) {
        const double fall = 1.0 - static_cast<double>(shown(replay, column, y, 0));
        if (fall > 1e-4) first = std::min(first, y);
        if (entry(replay, std::size_t{y} * size + column, 2)[3] != models::empty_depth) last = std::max(last, y);
    }
    const double edge = (size - 36.0) / 2.0;
    EXPECT_EQ(last, size / 2 - 1);
    EXPECT_NEAR(edge - first, pixels / 2.0, 1.0);
}

TEST(DepthOfField, AWiderLensBlursMoreAndAPinholeNothing) {
    const auto sum_of_steps = [](const Replay& replay) {
        double sum = 0.0;
        for (std::uint32_t x = 85; x + 1 < 115; ++x)
            sum += std::fabs(static_cast<double>(shown(replay, x + 1, size / 2, 0) - shown(replay, x, size / 2, 0)));
        return sum;
    };
    const Replay pinhole = planes({"focus=4", "aperture=1e-9"});
    const double sharp = sum_of_steps(pinhole), narrow = sum_of_steps(planes({"focus=4", "aperture=0.05"})),
                 wide = sum_of_steps(planes({"focus=4", "aperture=0.5"}));
    EXPECT_LT(narrow, 1.01 * sharp);
    EXPECT_LT(wide, 0.5 * narrow);
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            const float* one = entry(pinhole, std::size_t{y} * size + x, x / 40);
            if (one[3] == models::empty_depth) continue;
            for (std::size_t channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(shown(pinhole, x, y, channel), one[channel], 1e-6F);
        }
}

TEST(DepthOfField, ImpossibleLensesAndRangesAreRefused) {
    const auto error_of = [](std::vector<std::string> knobs, const char* scene = "gen:planes") -> std::string {
        try {
            Replay(scene, {.width = 16, .height = 16, .workload = "depth-of-field", .knobs = std::move(knobs)});
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_EQ(error_of({"focus=2", "focal_length=2"}),
              "workload depth-of-field: focal_length: expected less than the focus distance 2, got 2");
    EXPECT_NE(error_of({"range=[8,6]"}).find("the smaller one first, got 8 and 6"), std::string::npos);
    EXPECT_NE(error_of({"range=[0.5,6]"}).find("range: expected two distances"), std::string::npos);
    EXPECT_EQ(error_of({}, "gen:quads?n=3"),
              "workload depth-of-field: expected a perspective camera, got a parallel projection");
    EXPECT_EQ(error_of({}), "");
}

TEST(DepthOfField, WrongPixelsAreBlurredWithTheOthers) {
    const Replay replay("gen:slabs", {.width = 48, .height = 48, .workload = "depth-of-field"});
    for (const char* design : {"blender", "existing"}) {
        SCOPED_TRACE(design);
        const pipeline::RunResult run = replay.run(design);
        ASSERT_EQ(run.judgements.size(), 2U);
        const pipeline::PassJudgement& picture = run.judgements.back();
        EXPECT_EQ(picture.surface, "picture");
        EXPECT_EQ(picture.wrong_places, 0U); // it shows what is there
        EXPECT_EQ(picture.other_inputs, run.wrong_pixels != 0);
        EXPECT_EQ(run.colour == replay.reference.picture, run.wrong_pixels == 0);
        EXPECT_EQ(run.wrong_pixels == 0, design == std::string("blender"));
    }
}

} // namespace workload_depth_of_field_test
