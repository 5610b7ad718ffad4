// Design `blender` in time: the interval at which one pixel can be modified, and how many insertions change it.
// Source: specification 004, section 7.3 and checks K10, K12.
#include "tests/support/replay.hpp"
#include "traces/generators/screen.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace designs_blender_test {

using pipeline::RunResult;
using support::counter;
using support::Replay;

using Settings = std::vector<std::string>;

/// Cycles one more layer of a one-quad stack takes, from the difference of two stacks.
double same_pixel_interval(const Settings& settings, const std::vector<std::string>& knobs) {
    static std::map<std::string, Replay> stacks;
    const auto cycles = [&](int n) {
        const std::string scene = fmt::format("gen:stack?n={}", n);
        const std::string name = fmt::format("{} {}", scene, fmt::join(knobs, " "));
        if (!stacks.contains(name)) stacks.emplace(name, Replay(scene, {16, 16, "transparency", "auto", knobs}));
        const RunResult run = stacks.at(name).run("blender", settings);
        EXPECT_EQ(run.wrong_pixels, 0U);
        return static_cast<double>(support::pass_named(run, "geometry").cycles);
    };
    return (cycles(2000) - cycles(1000)) / 1000.0;
}

const std::vector<std::string> four_rgbz{"k=4", "entry=rgbz"}, sixteen_z{"k=16", "entry=z"};

TEST(BlenderDesign, K12_StallingPixelComesBackAfterTheLatency) {
    for (const int latency : {16, 24, 100}) {
        const Settings settings{"blender.interlock=stall", fmt::format("blender.latency={}", latency)};
        EXPECT_NEAR(same_pixel_interval(settings, four_rgbz), latency, 0.05);
        EXPECT_NEAR(same_pixel_interval(settings, sixteen_z), latency, 0.05);
    }
}

TEST(BlenderDesign, K12_ForwardingPixelComesBackAfterTheProgramsCost) {
    const Settings settings{"blender.interlock=forward"};
    EXPECT_NEAR(same_pixel_interval(settings, four_rgbz), 9, 0.05);  // 36 operations, 4 lanes
    EXPECT_NEAR(same_pixel_interval(settings, sixteen_z), 12, 0.05); // 48 operations, 4 lanes
}

TEST(BlenderDesign, K12_CostIsThatOfTheLanesOrOfThePort) {
    EXPECT_NEAR(same_pixel_interval({"blender.interlock=forward", "blender.lanes=12"}, four_rgbz), 4,
                0.05); // port: 2 * 64 / 32
    EXPECT_NEAR(
        same_pixel_interval({"blender.interlock=forward", "blender.lanes=36", "blender.port_bytes=64"}, four_rgbz), 2,
        0.05);
    // A quad is the work of one group of four ROPs, however many groups there are.
    EXPECT_NEAR(same_pixel_interval({"blender.interlock=forward", "rop.units=4"}, four_rgbz), 9, 0.05);
}

TEST(BlenderDesign, K12_LatencyBelowTheCostDoesNotSpeedItUp) {
    EXPECT_NEAR(same_pixel_interval({"blender.interlock=stall", "blender.latency=1"}, four_rgbz), 9, 0.05);
}

TEST(BlenderDesign, StallsAreCountedOncePerQuad) {
    const Replay replay("gen:stack?n=100", {.width = 16, .height = 16});
    EXPECT_EQ(counter(replay.run("blender").stages, "rop/counters/interlock_stalls"), 99U);
    EXPECT_EQ(counter(replay.run("blender", {"blender.interlock=forward"}).stages, "rop/counters/interlock_stalls"),
              0U);
}

TEST(BlenderDesign, CrossbarCarriesOnlyTheShadersOutputs) {
    const Replay replay("gen:stack?n=100", {.width = 16, .height = 16});
    const Replay depths("gen:stack?n=100", {16, 16, "transparency", "auto", sixteen_z});
    EXPECT_EQ(counter(replay.run("blender").bytes, "crossbar/bytes"), 400U * 16U);
    EXPECT_EQ(counter(depths.run("blender").bytes, "crossbar/bytes"), 400U * 4U);
    EXPECT_EQ(counter(replay.run("existing").bytes, "crossbar/bytes"), 400U * 64U);
    EXPECT_EQ(counter(depths.run("existing").bytes, "crossbar/bytes"), 400U * 64U);
}

namespace {

/// 16 layers over `side` x `side` pixels, each 2x2 block with an order of its own.
traces::Scene randomly_ordered_layers(std::uint32_t side) {
    traces::Mesh mesh;
    mesh.name = "layers in random order";
    for (std::uint32_t block = 0; block < side * side / 4; ++block) {
        const std::uint32_t x = block % (side / 2) * 2, y = block / (side / 2) * 2;
        std::uint64_t number = 0;
        for (const float depth : traces::layer_depths(16, traces::DepthOrder::random, block))
            traces::add_one_quad_triangle(mesh, static_cast<float>(x), static_cast<float>(y), depth,
                                          traces::colour_of(number++), x + 2 == side);
    }
    traces::Scene scene = traces::screen_scene(mesh);
    scene.name = "layers in random order";
    traces::finish_scene(scene);
    return scene;
}

/// Mean insertions per pixel that changed it, by the timed blender.
double mean_insertions(const traces::Scene& scene, std::uint32_t side, std::uint32_t k) {
    const Replay replay(scene, {side, side, "transparency", "auto", {fmt::format("k={}", k), "entry=z"}});
    const RunResult run = replay.run("blender");
    EXPECT_EQ(run.fragments, std::uint64_t{16} * side * side);
    EXPECT_EQ(counter(run.stages, "rop/counters/program_runs"), run.fragments);
    EXPECT_EQ(counter(run.stages, "rop/counters/insertions"), replay.reference.accepted_insertions);
    return static_cast<double>(counter(run.stages, "rop/counters/insertions")) / (static_cast<double>(side) * side);
}

// k + k (H_16 - H_k), H being harmonic numbers.
constexpr double expected_of_4 = 9.19, expected_of_8 = 13.30;

} // namespace

TEST(BlenderDesign, K10_InsertionsOfRandomOrderFollowTheHarmonicNumbers) {
    const traces::Scene scene = randomly_ordered_layers(160);
    EXPECT_NEAR(mean_insertions(scene, 160, 4), expected_of_4, 0.01 * expected_of_4);
    EXPECT_NEAR(mean_insertions(scene, 160, 8), expected_of_8, 0.01 * expected_of_8);
}

TEST(BlenderDesign, K10_LongInsertionsOfRandomOrderOver100000Pixels) {
    const traces::Scene scene = randomly_ordered_layers(320);
    const double of_4 = mean_insertions(scene, 320, 4), of_8 = mean_insertions(scene, 320, 8);
    RecordProperty("k4", fmt::format("{:.3f}", of_4));
    RecordProperty("k8", fmt::format("{:.3f}", of_8));
    EXPECT_NEAR(of_4, expected_of_4, 0.01 * expected_of_4);
    EXPECT_NEAR(of_8, expected_of_8, 0.01 * expected_of_8);
}

TEST(BlenderDesign, K10_FrontToBackInsertsKAndBackToFrontAll) {
    for (const std::uint32_t k : {1U, 4U, 8U, 16U}) {
        const auto insertions = [k](const char* order) {
            const Replay replay(fmt::format("gen:quads?n=16&order={}", order),
                                {64, 64, "transparency", "auto", {fmt::format("k={}", k), "entry=z"}});
            return counter(replay.run("blender").stages, "rop/counters/insertions");
        };
        EXPECT_EQ(insertions("front-to-back"), std::uint64_t{k} * 64 * 64);
        EXPECT_EQ(insertions("back-to-front"), std::uint64_t{16} * 64 * 64);
    }
}

} // namespace designs_blender_test
