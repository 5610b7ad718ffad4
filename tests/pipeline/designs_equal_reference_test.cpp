// K3: designs that protect the pixel give the reference bit for bit and count no hazard, whatever their options.
// Source: specification 004, sections 7.2, 7.3, 7.6 and check K3.
#include "tests/support/replay.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace designs_equal_reference_test {

using pipeline::RunResult;
using support::Replay;
using support::ReplayOptions;

using Settings = std::vector<std::string>;

const std::vector<std::string> protected_designs{"scoreboard", "blender",     "multipass",         "peel-rop",
                                                 "interlock",  "rov",         "framebuffer-fetch", "cam",
                                                 "hashed",     "tile-ticket", "linked-list"};

/// Those of them that can run the program of a frame.
std::vector<std::string> protected_designs_of(const Replay& replay) {
    const std::vector<std::string> able = replay.designs();
    std::vector<std::string> designs = protected_designs;
    std::erase_if(designs,
                  [&](const auto& design) { return std::find(able.begin(), able.end(), design) == able.end(); });
    return designs;
}

const std::vector<std::string> generated_scenes{
    "gen:stack?n=100&order=random",
    "gen:stack?n=40&x=3&y=5&w=30&h=21&order=back-to-front",
    "gen:quads?n=5&order=random",
    "gen:random-quads?n=4000&area=4096",
    "gen:discs?n=200&overlap=10&width=64&height=64",
    "gen:blob?triangles=6000",
    "gen:blob?triangles=6000&order=random",
    "gen:grass?blades=1500",
    "gen:grid-soup?boxes=300&boxes_per_draw=40",
};

void expect_reference(const Replay& replay, const std::string& design, const Settings& settings = {}) {
    const RunResult run = replay.run(design, settings);
    EXPECT_EQ(run.hazards.total(), 0U);
    EXPECT_EQ(run.wrong_pixels, 0U);
    EXPECT_EQ(run.lost_fragments, 0U);
    EXPECT_TRUE(run.pairs.empty());
    EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer);
    EXPECT_TRUE(run.colour == replay.reference.colour);
}

const Replay& mesh() {
    static const Replay replay("gen:blob?triangles=6000", {.width = 64, .height = 64});
    return replay;
}

const Replay& layers() {
    static const Replay replay("gen:discs?n=200&overlap=10&width=64&height=64", {.width = 64, .height = 64});
    return replay;
}

/// A quarter of both, where settings are many.
const Replay& small_mesh() {
    static const Replay replay("gen:blob?triangles=1500", {.width = 32, .height = 32});
    return replay;
}

const Replay& few_layers() {
    static const Replay replay("gen:discs?n=50&overlap=10&width=32&height=32", {.width = 32, .height = 32});
    return replay;
}

void expect_reference_of_both(const std::string& design, const Settings& settings) {
    SCOPED_TRACE(fmt::format("{} {}", design, fmt::join(settings, " ")));
    expect_reference(mesh(), design, settings);
    expect_reference(layers(), design, settings);
}

TEST(EqualReference, K3_OnEveryGeneratorWithColours) {
    for (const std::string& scene : generated_scenes) {
        const Replay replay(scene, {.width = 64, .height = 64});
        for (const std::string& design : protected_designs_of(replay)) {
            SCOPED_TRACE(design + " on " + scene);
            expect_reference(replay, design);
        }
    }
}

TEST(EqualReference, K3_LongOnEveryGeneratorWithDepthsAlone) {
    for (const std::string& scene : generated_scenes) {
        const Replay replay(scene, {.width = 64, .height = 64, .knobs = {"entry=z", "k=16"}});
        for (const std::string& design : protected_designs_of(replay)) {
            SCOPED_TRACE(design + " on " + scene);
            expect_reference(replay, design);
        }
    }
}

TEST(EqualReference, K3_ForEveryK) {
    for (const char* entry : {"rgbz", "z"}) {
        for (const std::uint32_t k : {1U, 2U, 4U, 8U, 16U}) {
            const Replay replay(
                "gen:discs?n=50&overlap=10&width=32&height=32",
                {32, 32, "transparency", "auto", {fmt::format("k={}", k), fmt::format("entry={}", entry)}});
            for (const std::string& design : protected_designs_of(replay)) {
                SCOPED_TRACE(fmt::format("{} with k = {}, entry {}", design, k, entry));
                expect_reference(replay, design);
            }
        }
    }
}

TEST(EqualReference, K3_ForEqualDepthsOfDifferentColours) {
    // Whoever comes first stays, in every design: an opaque order would show at once.
    const Replay replay("gen:stack?n=20&x=0&y=0&w=32&h=32", {.width = 32, .height = 32});
    Replay equal = replay;
    for (auto& depths : equal.streams[0].depths.own()) depths.fill(0.5F);
    equal.reference = pipeline::run_reference(equal.frame, equal.streams);
    EXPECT_NE(equal.reference.kbuffer, replay.reference.kbuffer);
    for (const std::string& design : protected_designs_of(replay)) {
        SCOPED_TRACE(design);
        expect_reference(equal, design);
    }
}

TEST(EqualReference, K3_LongScoreboardForEveryOptionThatProtects) {
    for (const char* granularity : {"pixel", "quad", "tile4", "tile8", "tile16"})
        for (const int entries : {0, 1, 64, 1000})
            expect_reference_of_both("scoreboard", {fmt::format("scoreboard.granularity={}", granularity),
                                                    fmt::format("scoreboard.entries={}", entries)});
    for (const int side_buffer : {0, 1, 8, 512})
        expect_reference_of_both("scoreboard", {fmt::format("scoreboard.side_buffer={}", side_buffer)});
    for (const char* policy : {"any_pipe", "tile_affinity"})
        expect_reference_of_both("scoreboard", {fmt::format("scoreboard.policy={}", policy)});
    for (const char* visibility : {"rop_cache", "writeback", "never_until_flush"})
        expect_reference_of_both("scoreboard", {fmt::format("scoreboard.visibility={}", visibility)});
    for (const Settings& settings :
         {Settings{"scoreboard.lookups=1"}, Settings{"scoreboard.lookups=64"}, Settings{"scoreboard.wakes=8"},
          Settings{"scoreboard.lookup_latency=40"}, Settings{"scoreboard.release=rop_commit"},
          Settings{"scoreboard.side_buffer=1", "scoreboard.granularity=tile16", "scoreboard.policy=tile_affinity"}})
        expect_reference_of_both("scoreboard", settings);
}

TEST(EqualReference, K3_ScoreboardReleasedTooEarlyOrReadingStaleLinesIsNotProtected) {
    // Release at the ROP's commit needs reads that look into its tile cache.
    const RunResult early =
        layers().run("scoreboard", {"scoreboard.release=rop_commit", "scoreboard.visibility=writeback"});
    EXPECT_GT(early.hazards.of(pipeline::HazardClass::h2_write_path), 0U);
    EXPECT_EQ(early.hazards.of(pipeline::HazardClass::h1_in_flight) +
                  early.hazards.of(pipeline::HazardClass::h3_stale_line),
              0U);
    EXPECT_GT(early.wrong_pixels, 0U);
    EXPECT_EQ(early.unexplained_pixels(), 0U);
    // Through the texture cache, lines that were filled before survive the scoreboard.
    const RunResult stale = layers().run("scoreboard", {"scoreboard.bypass_l1=false", "texture.l1_bytes=1048576"});
    EXPECT_GT(stale.hazards.of(pipeline::HazardClass::h3_stale_line), 0U);
    EXPECT_EQ(stale.hazards.of(pipeline::HazardClass::h1_in_flight) +
                  stale.hazards.of(pipeline::HazardClass::h2_write_path),
              0U);
    EXPECT_EQ(stale.unexplained_pixels(), 0U);
}

TEST(EqualReference, K3_BlenderForEveryOptionThatProtects) {
    for (const char* interlock : {"stall", "forward"})
        for (const int latency : {1, 16, 500})
            expect_reference_of_both("blender", {fmt::format("blender.interlock={}", interlock),
                                                 fmt::format("blender.latency={}", latency)});
    for (const int lanes : {1, 1024}) expect_reference_of_both("blender", {fmt::format("blender.lanes={}", lanes)});
    for (const int port : {1, 4096}) expect_reference_of_both("blender", {fmt::format("blender.port_bytes={}", port)});
}

TEST(EqualReference, K3_BlenderWithoutInterlockIsNotProtected) {
    const Replay replay("gen:stack?n=64&x=0&y=0&w=16&h=16&order=random", {.width = 16, .height = 16});
    const RunResult run = replay.run("blender", {"blender.interlock=none", "blender.latency=500"});
    EXPECT_GT(run.hazards.total(), 0U);
    EXPECT_GT(run.wrong_pixels, 0U);
    EXPECT_EQ(run.unexplained_pixels(), 0U);
}

TEST(EqualReference, K3_MultipassForEveryOptionThatKeepsAllLayers) {
    expect_reference_of_both("multipass", {"multipass.rule=exact", "multipass.depth_format=d32f"});
    // Layers that are 1/65 apart stay apart in 16 bits, and beyond an eps of 1e-4.
    const Replay replay("gen:stack?n=64&x=0&y=0&w=16&h=16&order=random", {.width = 16, .height = 16});
    for (const char* rule : {"exact", "eps"})
        for (const char* format : {"d16", "d24", "d32f"})
            expect_reference(
                replay, "multipass",
                {fmt::format("multipass.rule={}", rule), fmt::format("multipass.depth_format={}", format)});
}

TEST(EqualReference, K3_MultipassLosesLayersThatAreCloserThanEps) {
    const Replay replay("gen:stack?n=64&x=0&y=0&w=16&h=16&order=random", {.width = 16, .height = 16});
    const RunResult run = replay.run("multipass", {"multipass.rule=eps", "multipass.eps=0.02"});
    EXPECT_EQ(run.hazards.total(), 0U);
    EXPECT_EQ(run.wrong_pixels, 256U);
    EXPECT_GT(run.lost_fragments, 0U);
}

TEST(EqualReference, K3_ExistingWithAFullFlushAfterEveryTriangle) {
    expect_reference_of_both("existing", {"existing.flush_triangles=1"});
}

namespace {

const std::vector<Settings> shapes_of_machine{
    Settings{"memory.partitions=1"},
    Settings{"memory.partitions=3"},
    Settings{"memory.partitions=8"},
    Settings{"fragment.pipes=1"},
    Settings{"fragment.pipes=13"},
    Settings{"fragment.quads_in_flight=1"},
    Settings{"reorder_buffer.quads=7"},
    Settings{"rop.depth_cache_bytes=256", "rop.colour_cache_bytes=1024", "rop.kbuffer_cache_bytes=1024"},
    Settings{"rop.queue=1", "crossbar.queue=1"},
    Settings{"rop.units=4"},
    Settings{"rop.units=20"},
    Settings{"rop.fast_clear=true", "rop.clear_sectors=100"},
    Settings{"rop.fast_clear=true"},
    Settings{"memory.clock_mhz=800"},
    Settings{"memory.controller.jitter_cycles=500"},
    Settings{"texture.l1_bytes=0"},
    Settings{"raster.quads_per_clk=16", "raster.tiles_per_clk=8"},
    Settings{"fragment.registers=8"}};

} // namespace

TEST(EqualReference, K3_OnEveryShapeOfMachine) {
    for (const Settings& shape : shapes_of_machine)
        for (const std::string& design : protected_designs) {
            SCOPED_TRACE(fmt::format("{} {}", design, fmt::join(shape, " ")));
            expect_reference(small_mesh(), design, shape);
            expect_reference(few_layers(), design, shape);
        }
}
TEST(EqualReference, K3_LongOnEveryShapeOfMachine) {
    for (const Settings& shape : shapes_of_machine)
        for (const std::string& design : protected_designs) expect_reference_of_both(design, shape);
}

namespace {

struct RealScene {
    const char* file;
    const char* camera = "auto";
    std::uint32_t size = 256;
};

const std::vector<RealScene> real_scenes{
    {"sponza/sponza.gltf", "-11,2.5,-0.5,5,3.5,0,60"},
    {"stanford_dragon/stanford_dragon.gltf"},
    {"stanford_bunny/stanford_bunny.glb"},
    {"tree_forest/forest.gltf", "auto", 128},
    {"glass_vase_flowers/GlassVaseFlowers.gltf"},
    {"alpha_blend_mode_test/AlphaBlendModeTest.glb"},
    {"transmission_test/TransmissionTest.glb"},
    {"stained_glass_lamp/StainedGlassLamp.gltf"},
    {"flight_helmet/FlightHelmet.gltf"},
    {"simple_instancing/SimpleInstancing.glb"},
    {"test_negative_scale/NegativeScaleTest.glb"},
    {"test_mesh_primitive_modes/MeshPrimitiveModes.gltf"},
};

void expect_reference_on_real_scenes(const Settings& knobs) {
    if (support::shared_scene("").empty()) GTEST_SKIP() << "no further scenes here: set ROPSIM_SHARED_DIR";
    for (const RealScene& scene : real_scenes) {
        const std::string file = support::shared_scene(scene.file);
        ASSERT_NE(file, "") << scene.file;
        const Replay replay(file, {scene.size, scene.size, "transparency", scene.camera, knobs});
        for (const std::string& design : protected_designs_of(replay)) {
            SCOPED_TRACE(design + " on " + scene.file);
            expect_reference(replay, design);
        }
        const RunResult run = replay.run("existing");
        EXPECT_EQ(run.unexplained_pixels(), 0U) << scene.file;
        EXPECT_EQ(run.hazards.total() == 0, run.wrong_pixels == 0 && run.lost_updates == 0) << scene.file;
    }
}

} // namespace

TEST(EqualReference, K3_OneRealSceneWithTransparentMaterials) {
    const std::string file = support::shared_scene("glass_vase_flowers/GlassVaseFlowers.gltf");
    if (file.empty()) GTEST_SKIP() << "no further scenes here: set ROPSIM_SHARED_DIR";
    for (const char* transparent : {"all", "materials"}) {
        const Replay replay(file, {128, 128, "transparency", "auto", {std::string("transparent=") + transparent}});
        for (const std::string& design : protected_designs_of(replay)) {
            SCOPED_TRACE(design + ", transparent=" + transparent);
            expect_reference(replay, design);
        }
    }
}

TEST(EqualReference, K3_LongOnRealScenesWithColours) { expect_reference_on_real_scenes({}); }
TEST(EqualReference, K3_LongOnRealScenesWithSixteenDepths) { expect_reference_on_real_scenes({"entry=z", "k=16"}); }
TEST(EqualReference, K3_LongOnRealScenesWithTransparentMaterials) {
    expect_reference_on_real_scenes({"transparent=materials"});
}

TEST(EqualReference, LongOpaqueWorkloadIsTheReferenceInEveryDesign) {
    for (const char* format : {"d16", "d24", "d32f"}) {
        for (const char* scene :
             {"gen:blob?triangles=6000&order=random", "gen:discs?n=200&overlap=10&width=64&height=64",
              "gen:stack?n=40&x=0&y=0&w=64&h=64&order=random"}) {
            const Replay replay(scene, {64, 64, "opaque", "auto", {std::string("depth_format=") + format}});
            for (const std::string& design : replay.designs()) {
                SCOPED_TRACE(design + " on " + scene);
                expect_reference(replay, design);
            }
        }
    }
}

} // namespace designs_equal_reference_test
