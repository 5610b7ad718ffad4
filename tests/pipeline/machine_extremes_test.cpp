// Frames and machines at the limits: nothing to draw, odd viewports, everything in one place, one of every unit.
#include "tests/support/program_run.hpp"
#include "tests/support/replay.hpp"
#include "tests/support/screen_scene.hpp"

#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

namespace machine_extremes_test {

using pipeline::RunResult;
using support::counter;
using support::Replay;
using support::screen_scene;

using Settings = std::vector<std::string>;

const std::vector<std::string> both_workloads{"transparency", "opaque"};

/// Runs every design and expects the reference; unprotected ones must at least explain what is wrong.
void expect_good_runs(const Replay& replay, const Settings& settings = {}) {
    for (const std::string& design : replay.designs()) {
        SCOPED_TRACE(fmt::format("{} {}", design, fmt::join(settings, " ")));
        const RunResult run = replay.run(design, settings);
        EXPECT_EQ(run.unexplained_pixels(), 0U);
        if (!support::protects(design)) continue;
        EXPECT_EQ(run.hazards.total(), 0U);
        if (support::holds_everything(design)) {
            EXPECT_EQ(run.wrong_pixels, 0U);
        }
    }
}

std::uint64_t peak_memory_bytes() {
    std::ifstream status("/proc/self/status");
    std::string word;
    while (status >> word)
        if (word == "VmHWM:") {
            std::uint64_t kib = 0;
            status >> kib;
            return kib * 1024;
        }
    return 0;
}

TEST(Extremes, NothingIsVisible) {
    for (const std::string& workload : both_workloads) {
        // One triangle beside the viewport, one in front of the near plane, one behind the far plane.
        const traces::Scene scene = screen_scene({{{-50, 1, 0.5F}, {-50, 9, 0.5F}, {-40, 5, 0.5F}},
                                                  {{1, 1, -0.5F}, {1, 9, -0.5F}, {9, 5, -0.5F}},
                                                  {{1, 1, 1.5F}, {1, 9, 1.5F}, {9, 5, 1.5F}}});
        const Replay replay(scene, {16, 16, workload});
        EXPECT_TRUE(replay.streams[0].triangles.empty());
        EXPECT_TRUE(replay.streams[0].quads.empty());
        expect_good_runs(replay);
        for (const std::string design : {"existing", "scoreboard", "blender", "multipass"}) {
            const RunResult run = replay.run(design);
            EXPECT_EQ(run.fragments, 0U);
            EXPECT_EQ(counter(run.stages, "clip_cull/counters/primitives"),
                      workload == "opaque" || design != "multipass" ? 3U : 12U);
        }
    }
}

TEST(Extremes, FrameWithoutAnyPrimitive) {
    for (const std::string& workload : both_workloads) {
        Replay replay("gen:stack?n=3", {16, 16, workload});
        for (pipeline::Pass& pass : replay.frame.passes) pass.draws.clear();
        replay.streams = pipeline::rasterize_frame(replay.frame);
        replay.reference = pipeline::run_reference(replay.frame, replay.streams);
        ASSERT_TRUE(replay.streams[0].primitives.empty());
        expect_good_runs(replay);
    }
}

TEST(Extremes, TrianglesTooSmallForAnyPixelCentre) {
    std::vector<support::ScreenTriangle> triangles;
    for (int i = 0; i < 100; ++i) {
        const auto x = static_cast<float>(i % 10), y = static_cast<float>(i / 10);
        triangles.push_back({{x + 0.6F, y + 0.6F, 0.5F}, {x + 0.6F, y + 0.9F, 0.5F}, {x + 0.9F, y + 0.6F, 0.5F}});
    }
    const Replay replay(screen_scene(triangles), {.width = 16, .height = 16});
    EXPECT_EQ(replay.streams[0].triangles.size(), 100U);
    EXPECT_TRUE(replay.streams[0].quads.empty());
    expect_good_runs(replay);
    EXPECT_EQ(counter(replay.run("blender").stages, "rasterizer/counters/triangles_without_quads"), 100U);
}

TEST(Extremes, LongOddViewports) {
    for (const auto& [width, height] :
         {std::pair(1U, 1U), {3U, 5U}, {5U, 3U}, {1U, 64U}, {64U, 1U}, {7U, 7U}, {17U, 33U}, {63U, 65U}}) {
        SCOPED_TRACE(fmt::format("{}x{}", width, height));
        for (const std::string& workload : both_workloads) {
            for (const char* scene : {"gen:quads?n=9&order=random", "gen:blob?triangles=1000",
                                      "gen:discs?n=30&overlap=9&width=3&height=3"}) {
                if (std::string(scene).starts_with("gen:discs") && (width < 3 || height < 3)) continue;
                const Replay replay(scene, {width, height, workload});
                expect_good_runs(replay);
                expect_good_runs(replay, {"scoreboard.granularity=tile16", "scoreboard.entries=3",
                                          "memory.partitions=3", "rop.units=12"});
            }
        }
        const Replay layers("gen:quads?n=9", {.width = width, .height = height});
        EXPECT_EQ(layers.run("blender").fragments, std::uint64_t{9} * width * height);
    }
}

TEST(Extremes, LongManyCoincidentFragmentsOfEqualDepth) {
    std::vector<support::ScreenTriangle> triangles(80, {{0, 0, 0.5F}, {0, 32, 0.5F}, {32, 0, 0.5F}});
    for (const std::uint32_t k : {1U, 4U, 64U}) {
        const Replay replay(screen_scene(triangles), {16, 16, "transparency", "auto", {fmt::format("k={}", k)}});
        expect_good_runs(replay);
    }
    expect_good_runs(Replay(screen_scene(triangles), {16, 16, "opaque"}));
}

TEST(Extremes, AProgramThatNeverWrites) {
    const ropsim_test::TemporaryFolder folder;
    const auto file = folder.path() / "idle.kb";
    ropsim_test::write_text(file, "program \"idle\"; k 2; entry r, g, b, z; empty z = largest; order any; "
                                  "picture layers; fragment { f.z = f.z + 1; }");
    const Replay replay("gen:discs?n=60&overlap=8&width=24&height=24",
                        {24, 24, "transparency", "auto", {"program=" + file.string(), "k=2"}});
    EXPECT_EQ(replay.reference.accepted_insertions, 0U);
    EXPECT_GE(replay.designs().size(), 12U);
    for (const std::string& design : replay.designs()) {
        SCOPED_TRACE(design);
        const RunResult run = replay.run(design);
        EXPECT_GT(run.fragments, 0U);
        EXPECT_EQ(run.wrong_pixels, 0U);
        EXPECT_EQ(run.unexplained_pixels(), 0U);
        EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer);
    }
}

TEST(Extremes, OpacityNoneAndFull) {
    const auto picture = [](const std::string& program, int layers, int opacity) {
        SCOPED_TRACE(fmt::format("{} with opacity {}", program, opacity));
        const Replay replay(fmt::format("gen:stack?n={}&x=0&y=0&w=8&h=8&order=front-to-back", layers),
                            {8, 8, "transparency", "auto", {"program=" + program, fmt::format("opacity={}", opacity)}});
        expect_good_runs(replay);
        return replay.reference.picture;
    };
    for (const char* program : {"nearest-k", "order-and-blend", "mlab", "order_and_blend.kb"}) {
        SCOPED_TRACE(program);
        const auto clear = picture(program, 9, 0), full = picture(program, 9, 1);
        EXPECT_NE(full, clear);
        EXPECT_EQ(full, picture(program, 1, 1));                                  // the layer in front
        for (std::size_t i = 0; i < clear.size(); ++i) EXPECT_EQ(clear[i], 1.0F); // the white behind them
    }
}

TEST(Extremes, LongSixtyFourEntries) {
    for (const char* entry : {"entry=z", "entry=rgbz"}) {
        const Replay replay("gen:discs?n=100&overlap=70&width=12&height=12&segments=8",
                            {12, 12, "transparency", "auto", {"k=64", entry}});
        SCOPED_TRACE(entry);
        expect_good_runs(replay);
        expect_good_runs(replay, {"existing.atomic_reads=true", "scoreboard.visibility=writeback"});
    }
}

TEST(Extremes, LongOneHugeTriangle) {
    for (const std::string& workload : both_workloads) {
        const Replay replay(
            screen_scene({{{-100'000, -100'000, 0.5F}, {-100'000, 300'000, 0.5F}, {300'000, -100'000, 0.5F}}}),
            {256, 256, workload});
        EXPECT_EQ(replay.streams[0].fragments, 65'536U);
        expect_good_runs(replay);
    }
}

namespace {

// The k-buffer has 64 bytes a pixel: run, reference and result hold one each, and two where memory differs from the
// tile cache's view.
void expect_sparse_frame_fits(std::uint32_t side, std::uint64_t most_bytes_per_pixel) {
    const Replay replay(screen_scene({{{1000, 1000, 0.5F}, {1000, 1010, 0.5F}, {1010, 1000, 0.5F}}}),
                        {.width = side, .height = side});
    for (const std::string design : {"existing", "blender", "multipass", "linked-list"}) { // one of each kind of memory
        const RunResult run = replay.run(design);
        EXPECT_EQ(run.wrong_pixels, 0U);
        EXPECT_EQ(counter(support::pass_named(run, "geometry").counters, "raster/fragments"), 45U);
    }
    EXPECT_LT(peak_memory_bytes(), most_bytes_per_pixel * side * side);
}

} // namespace

TEST(Extremes, LongLargeViewportWithOneSmallTriangle) { expect_sparse_frame_fits(1024, 700); }
TEST(ExtremesLong, LargerViewportWithOneSmallTriangle) { expect_sparse_frame_fits(2048, 625); }

TEST(Extremes, SmallestMachine) {
    const Settings smallest{"fragment.pipes=1",
                            "fragment.quads_in_flight=1",
                            "reorder_buffer.quads=1",
                            "reorder_buffer.retire_per_clk=1",
                            "memory.partitions=1",
                            "rop.units=4",
                            "rop.depth_cache_bytes=256",
                            "rop.colour_cache_bytes=1024",
                            "rop.kbuffer_cache_bytes=1024",
                            "rop.queue=1",
                            "crossbar.queue=1",
                            "raster.quads_per_clk=1",
                            "texture.l1_bytes=64",
                            "texture.l1_ways=1",
                            "memory.controller.queue=1",
                            "memory.hub.reads_in_flight=64",
                            "early_depth.quads_per_clk=1",
                            "scoreboard.side_buffer=1",
                            "scoreboard.lookups=1"};
    for (const std::string& workload : both_workloads) {
        expect_good_runs(Replay("gen:blob?triangles=1000", {32, 32, workload}), smallest);
        expect_good_runs(Replay("gen:discs?n=40&overlap=6&width=32&height=32", {32, 32, workload}), smallest);
    }
}

TEST(Extremes, EachQueueAtItsSmallest) {
    const Replay replay("gen:discs?n=30&overlap=8&width=20&height=20", {.width = 20, .height = 20});
    for (const char* setting :
         {"fragment.pipes=1", "fragment.quads_in_flight=1", "reorder_buffer.quads=1", "reorder_buffer.retire_per_clk=1",
          "memory.partitions=1", "rop.depth_cache_bytes=256", "rop.colour_cache_bytes=1024",
          "rop.kbuffer_cache_bytes=1024", "rop.queue=1", "crossbar.queue=1", "crossbar.bytes_per_clk=1",
          "raster.quads_per_clk=1", "texture.l1_bytes=0", "texture.l1_bytes=64", "memory.controller.queue=1",
          "fragment.registers=1", "rop.read_return_latency=1", "rop.bytes_per_clk=1"}) {
        SCOPED_TRACE(setting);
        expect_good_runs(replay, {setting});
    }
}

TEST(ExtremesLong, LargestMachine) {
    const Replay replay("gen:discs?n=30&overlap=8&width=32&height=32", {.width = 32, .height = 32});
    for (const Settings& settings :
         {Settings{"fragment.pipes=64"}, Settings{"fragment.pipes=48", "fragment.quads_in_flight=4096"},
          Settings{"memory.partitions=64"}, Settings{"rop.kbuffer_cache_bytes=1073741824"},
          Settings{"rop.queue=4096", "crossbar.queue=4096"}, Settings{"rop.units=256"},
          Settings{"fragment.pipes=64", "memory.partitions=64", "raster.quads_per_clk=64", "raster.tiles_per_clk=64",
                   "reorder_buffer.retire_per_clk=64"}}) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(settings, " ")));
        expect_good_runs(replay, settings);
    }
}

TEST(Extremes, FlushesOnTheSmallestMachineEnd) {
    const Replay replay("gen:discs?n=20&overlap=6&width=32&height=32&segments=8", {.width = 32, .height = 32});
    for (const char* drain : {"existing.drain=true", "existing.drain=false"}) {
        for (const char* visibility : {"rop_cache", "writeback", "never_until_flush"}) {
            const RunResult run = replay.run(
                "existing", {"existing.flush_triangles=1", drain, std::string("existing.visibility=") + visibility,
                             "fragment.pipes=1", "fragment.quads_in_flight=1", "reorder_buffer.quads=1",
                             "rop.depth_cache_bytes=256", "rop.colour_cache_bytes=1024", "rop.kbuffer_cache_bytes=1024",
                             "rop.queue=1", "crossbar.queue=1"});
            EXPECT_EQ(run.unexplained_pixels(), 0U);
            if (std::string(drain).ends_with("true")) {
                EXPECT_EQ(run.hazards.total(), 0U);
            }
        }
    }
}

TEST(Extremes, ClocksThatDoNotDivideEachOther) {
    const Replay replay("gen:discs?n=60&overlap=8&width=32&height=32", {.width = 32, .height = 32});
    for (const char* clock : {"memory.clock_mhz=1", "memory.clock_mhz=333.333", "memory.clock_mhz=5000",
                              "clock.core_mhz=1", "clock.core_mhz=99999"}) {
        SCOPED_TRACE(clock);
        expect_good_runs(replay, {clock});
    }
}

} // namespace machine_extremes_test
