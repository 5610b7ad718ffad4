// Designs that keep fragments and sort later, and peeling from both ends: what they hold and what they lose.
// Source: specification 004, section 8; section 6.1 (5) and check K14 for the eps rule of peeling.
#include "tests/support/replay.hpp"
#include "tests/support/screen_scene.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

using pipeline::RunResult;
using support::counter;
using support::Replay;

std::uint64_t pixels_deeper_than(const Replay& replay, std::uint32_t fragments) {
    const auto& counts = replay.reference.depth_complexity;
    return static_cast<std::uint64_t>(
        std::count_if(counts.begin(), counts.end(), [&](std::uint32_t count) { return count > fragments; }));
}

const Replay& deep() {
    static const Replay replay("gen:discs?n=300&overlap=12&width=64&height=64", {.width = 64, .height = 64});
    return replay;
}

} // namespace

TEST(LinkedList, HoldsEverythingThatItsMemoryHolds) {
    const RunResult run = deep().run("linked-list");
    EXPECT_EQ(run.wrong_pixels, 0U);
    EXPECT_EQ(run.overflow_pixels, 0U);
    EXPECT_EQ(counter(run.stages, "rop/counters/kept"), deep().streams[0].fragments);
}

TEST(LinkedList, LosesWhatDoesNotFitAndSaysWhere) {
    const RunResult run = deep().run("linked-list", {"linked-list.nodes=10000"});
    EXPECT_EQ(run.hazards.total(), 0U);
    EXPECT_GT(run.wrong_pixels, 0U);
    EXPECT_GE(run.overflow_pixels, run.wrong_pixels);
    EXPECT_EQ(run.unexplained_pixels, 0U);
    EXPECT_LE(counter(run.stages, "rop/counters/kept"), 10000U);
    EXPECT_EQ(counter(run.stages, "rop/counters/kept") + counter(run.stages, "rop/counters/not_kept"),
              deep().streams[0].fragments);
}

TEST(StencilRouted, LosesExactlyWhatComesAfterItsSamples) {
    for (const std::uint32_t passes : {1U, 2U, 8U}) {
        const RunResult run = deep().run("stencil-routed", {fmt::format("stencil-routed.passes={}", passes)});
        EXPECT_EQ(run.overflow_pixels, pixels_deeper_than(deep(), 8 * passes)) << passes;
        EXPECT_LE(run.wrong_pixels, run.overflow_pixels);
        EXPECT_EQ(run.unexplained_pixels, 0U);
        EXPECT_EQ(run.hazards.total(), 0U);
    }
    EXPECT_GT(pixels_deeper_than(deep(), 8), 0U);
    EXPECT_EQ(pixels_deeper_than(deep(), 64), 0U);
    EXPECT_EQ(deep().run("stencil-routed", {"stencil-routed.passes=8"}).wrong_pixels, 0U);
}

TEST(DualPeel, TakesHalfThePassesAndHoldsTwoLayersEach) {
    const Replay replay("gen:discs?n=60&overlap=3&width=64&height=64", {64, 64, "transparency", "auto", {"k=8"}});
    const RunResult run = replay.run("dual-peel");
    const auto layers = std::count_if(run.passes.begin(), run.passes.end(), [](const pipeline::PassResult& pass) {
        return pass.name.find(" layer ") != std::string::npos;
    });
    EXPECT_EQ(layers, 5); // 8 / 2 + 1
    EXPECT_EQ(run.overflow_pixels, pixels_deeper_than(replay, 10));
    EXPECT_EQ(run.overflow_pixels == 0, run.wrong_pixels == 0);
    const RunResult enough = replay.run("dual-peel", {"dual-peel.passes=8"});
    EXPECT_EQ(enough.wrong_pixels, 0U);
    EXPECT_LT(run.cycles, replay.run("multipass").cycles);
}

TEST(DualPeel, KeepsEqualDepthsInTheOrderOfTheReference) {
    Replay replay("gen:stack?n=6&x=0&y=0&w=16&h=16", {16, 16, "transparency", "auto", {"k=8"}});
    for (auto& depths : replay.streams[0].depths) depths.fill(0.5F);
    replay.reference = pipeline::run_reference(replay.frame, replay.streams);
    EXPECT_EQ(replay.run("dual-peel").wrong_pixels, 0U);
}

TEST(Multipass, K14_EpsRemovesTheSecondPlaneBelowTheGapOfTheSpecification) {
    // Planes at a distance of 50 and 50 + gap, near plane 1, far plane 100, window depth [0,1], eps = 1e-4: 0.248 +-
    // 2%.
    const auto window = [](double z) { return static_cast<float>(100.0 / 99.0 * (1.0 - 1.0 / z)); };
    const auto layers_at = [&](double gap) {
        const float front = window(50), back = window(50 + gap);
        const Replay replay(support::screen_scene({{{-9, -9, back}, {-9, 99, back}, {99, -9, back}},
                                                   {{-9, -9, front}, {-9, 99, front}, {99, -9, front}}}),
                            {.width = 16, .height = 16});
        const RunResult run = replay.run("multipass", {"multipass.rule=eps", "multipass.eps=1e-4"});
        return run.lost_fragments == 0 ? 2 : 1;
    };
    EXPECT_EQ(layers_at(0.248 * 0.98), 1);
    EXPECT_EQ(layers_at(0.248 * 1.02), 2);
    EXPECT_EQ(layers_at(0.01), 1);
    EXPECT_EQ(layers_at(5.0), 2);
}

TEST(Multipass, ALargerEpsNeverLosesLess) {
    const Replay replay("gen:blob?triangles=6000", {.width = 64, .height = 64});
    std::uint64_t before = 0;
    for (const char* eps : {"6e-8", "1e-6", "1e-5", "1e-4", "1e-3"}) {
        const RunResult run = replay.run("multipass", {"multipass.rule=eps", fmt::format("multipass.eps={}", eps)});
        EXPECT_GE(run.lost_fragments, before) << eps;
        before = run.lost_fragments;
    }
    EXPECT_GT(before, 0U);
}
