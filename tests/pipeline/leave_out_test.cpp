// A frame gets only the units that it needs, and every report says which those are and why the others are missing.
// Source: DESIGN section 8.
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

namespace leave_out_test {

using pipeline::RunResult;
using support::Replay;
using support::ReplayOptions;

using Units = std::set<std::string>;

const Units always{"command processor", "vertex reuse",   "vertex fetch",   "vertex shader",      "primitive assembly",
                   "clip and cull",     "triangle setup", "rasterizer",     "fragment scheduler", "fragment pipelines",
                   "reorder buffer",    "crossbar",       "ROP partitions", "memory partitions"};

/// What each design adds for a k-buffer pass.
const std::map<std::string, Units> of_design{
    {"existing", {"k-buffer read path of the shaders", "k-buffer surface and its tile cache"}},
    {"scoreboard",
     {"k-buffer read path of the shaders", "k-buffer surface and its tile cache", "dispatch guard and side buffer"}},
    {"blender", {"programmable blender", "k-buffer surface and its tile cache"}},
    {"multipass", {"texture path to memory", "depth tile cache"}},
    {"dual-peel", {"texture path to memory", "depth tile cache"}},
    {"detect", {"k-buffer read path of the shaders", "k-buffer surface and its tile cache"}},
    {"interlock", {"k-buffer read path of the shaders", "k-buffer surface and its tile cache", "lock table"}},
    {"rov", {"k-buffer read path of the shaders", "k-buffer surface and its tile cache", "lock table"}},
    {"framebuffer-fetch", {"k-buffer read path of the shaders", "k-buffer surface and its tile cache", "lock table"}},
    {"cam", {"programmable blender", "k-buffer surface and its tile cache"}},
    {"hashed", {"programmable blender", "k-buffer surface and its tile cache"}},
    {"tile-ticket", {"programmable blender", "k-buffer surface and its tile cache"}},
    {"peel-rop", {"peeling unit", "early depth test", "k-buffer surface and its tile cache"}},
    {"atomic-min", {"atomic units", "k-buffer surface and its tile cache"}},
    {"linked-list", {"lists of fragments", "texture path to memory", "colour tile cache"}},
    {"stencil-routed", {"lists of fragments", "texture path to memory", "colour tile cache"}},
};

/// Designs that run the frame, and whose triangles come as the scene has them (others bring indices of their own).
std::vector<std::string> designs_of(const Replay& replay) {
    std::vector<std::string> designs = replay.designs();
    std::erase_if(designs, [](const std::string& design) { return !support::keeps_submission(design); });
    return designs;
}

bool sorts_lists(const std::string& design) { return design == "linked-list" || design == "stencil-routed"; }
bool peels(const std::string& design) { return design == "multipass" || design == "dual-peel"; }

struct Expectation {
    const char* scene;
    ReplayOptions options;
    Units units;         ///< beyond `always`, in every design
    bool kbuffer = true; ///< what the design adds is there, too
    bool colours = true; ///< layers of multipass have colours
};

std::vector<Expectation> expectations() {
    return {
        {"gen:stack?n=3", {16, 16}, {}},
        {"gen:quads?n=3", {16, 16}, {"index fetch"}},
        {"gen:quads?n=3", {16, 16, "transparency", "auto", {"entry=z"}}, {"index fetch"}, true, false},
        {"gen:blob?triangles=500", {16, 16}, {"index fetch"}},
        {"gen:blob?triangles=500",
         {16, 16, "geometry"},
         {"index fetch", "depth tile cache", "colour tile cache"},
         false},
        {"gen:stack?n=3", {16, 16, "opaque"}, {"depth tile cache", "colour tile cache"}, false},
        {"gen:blob?triangles=500", {16, 16, "opaque"}, {"index fetch", "depth tile cache", "colour tile cache"}, false},
    };
}

Units units_of(const std::vector<std::string>& list) { return {list.begin(), list.end()}; }

Units names_of(const std::vector<std::pair<std::string, std::string>>& list) {
    Units names;
    for (const auto& [unit, reason] : list) names.insert(unit);
    return names;
}

std::string reason_for(const RunResult& run, const std::string& unit) {
    for (const auto& [name, reason] : run.left_out)
        if (name == unit) return reason;
    return "(it is not left out)";
}

TEST(LeaveOut, EveryFrameAndDesignBuildsWhatItNeedsAndNothingElse) {
    for (const Expectation& expected : expectations()) {
        const Replay replay(expected.scene, expected.options);
        for (const std::string& design : designs_of(replay)) {
            SCOPED_TRACE(fmt::format("{} on {} of {}", design, expected.options.workload.name(), expected.scene));
            ASSERT_TRUE(of_design.contains(design)) << "this test does not know the units of " << design;
            Units wanted = always;
            wanted.insert(expected.units.begin(), expected.units.end());
            if (expected.kbuffer) wanted.insert(of_design.at(design).begin(), of_design.at(design).end());
            if (expected.kbuffer && expected.colours && peels(design)) wanted.insert("colour tile cache");
            const RunResult run = replay.run(design);
            EXPECT_EQ(units_of(run.built), wanted);
        }
    }
}

TEST(LeaveOut, EveryUnitIsBuiltOrLeftOutWithAReason) {
    const Units choosable{"index fetch",
                          "early depth test",
                          "texture path to memory",
                          "dispatch guard and side buffer",
                          "k-buffer read path of the shaders",
                          "lock table",
                          "lists of fragments",
                          "k-buffer surface and its tile cache",
                          "depth tile cache",
                          "colour tile cache"};
    for (const Expectation& expected : expectations()) {
        const Replay replay(expected.scene, expected.options);
        for (const std::string& design : designs_of(replay)) {
            SCOPED_TRACE(fmt::format("{} on {} of {}", design, expected.options.workload.name(), expected.scene));
            const RunResult run = replay.run(design);
            const Units built = units_of(run.built), left_out = names_of(run.left_out);
            EXPECT_EQ(built.size(), run.built.size());
            EXPECT_EQ(left_out.size(), run.left_out.size());
            for (const std::string& unit : choosable) EXPECT_NE(built.contains(unit), left_out.contains(unit)) << unit;
            for (const auto& [unit, reason] : run.left_out) EXPECT_FALSE(reason.empty()) << unit;
        }
    }
}

TEST(LeaveOut, ReasonsAreTrueOfTheFrame) {
    // Without a k-buffer pass the reason is the frame, not the design.
    const Replay opaque("gen:stack?n=3", {16, 16, "opaque"});
    EXPECT_EQ(reason_for(opaque.run("blender"), "programmable blender"), "no pass runs a modify program");
    EXPECT_EQ(reason_for(opaque.run("scoreboard"), "dispatch guard and side buffer"), "no pass runs a modify program");
    EXPECT_EQ(reason_for(opaque.run("existing"), "k-buffer read path of the shaders"), "no pass runs a modify program");
    EXPECT_EQ(reason_for(opaque.run("blender"), "k-buffer surface and its tile cache"),
              "no pass runs a modify program");
    const Replay layers("gen:stack?n=3", {.width = 16, .height = 16});
    EXPECT_EQ(reason_for(layers.run("existing"), "programmable blender"),
              "the design does not modify pixels in the ROP");
    EXPECT_EQ(reason_for(layers.run("existing"), "index fetch"), "no draw is indexed");
    EXPECT_EQ(reason_for(layers.run("blender"), "texture path to memory"),
              "no texture, no peeled layer and no full-screen pass is read");
}

TEST(LeaveOut, AttributesThatNoPassReadsCostNoMemoryTraffic) {
    const auto vertex_bytes = [](const Replay& replay) {
        return support::counter(replay.run("existing").stages, "vertex_fetch/counters/bytes");
    };
    const Replay all("gen:grass?blades=2000", {64, 64, "geometry"});
    const Replay positions("gen:grass?blades=2000", {64, 64, "geometry", "auto", {"reads=position"}});
    EXPECT_EQ(vertex_bytes(positions), 14000U * 12);
    EXPECT_EQ(vertex_bytes(all), 14000U * 24);
    EXPECT_EQ(reason_for(positions.run("existing"), "normals"), "fragments have the base colour of their material");
    EXPECT_EQ(reason_for(all.run("existing"), "normals"), "(it is not left out)");
    EXPECT_EQ(positions.run("existing").wrong_pixels, 0U);
}

TEST(LeaveOut, TexturesAndEarlyDepthAreBuiltForScenesThatNeedThem) {
    const std::string file = support::shared_scene("glass_vase_flowers/GlassVaseFlowers.gltf");
    if (file.empty()) GTEST_SKIP() << "no further scenes here: set ROPSIM_SHARED_DIR";
    for (const char* transparent : {"all", "materials"}) {
        const Replay replay(file, {64, 64, "transparency", "auto", {std::string("transparent=") + transparent}});
        for (const std::string& design : designs_of(replay)) {
            SCOPED_TRACE(design + ", transparent=" + transparent);
            const Units built = units_of(replay.run(design).built);
            EXPECT_TRUE(built.contains("texture path to memory"));
            const bool two_passes = std::string(transparent) == "materials";
            EXPECT_EQ(built.contains("early depth test"), two_passes || design == "peel-rop");
            EXPECT_EQ(built.contains("depth tile cache"), two_passes || peels(design));
            EXPECT_EQ(built.contains("colour tile cache"), two_passes || peels(design) || sorts_lists(design));
        }
    }
}

TEST(LeaveOut, StagesOfTheResultAreThoseThatWereBuilt) {
    const Replay plain("gen:stack?n=3", {.width = 16, .height = 16});
    const Replay indexed("gen:quads?n=3", {.width = 16, .height = 16});
    EXPECT_FALSE(plain.run("existing").stages->contains("index_fetch"));
    EXPECT_TRUE(indexed.run("existing").stages->contains("index_fetch"));
    EXPECT_FALSE(plain.run("existing").stages->contains("early_depth_test"));
    EXPECT_TRUE(plain.run("existing", {}, {.build_everything = true}).stages->contains("early_depth_test"));
    EXPECT_EQ(units_of(plain.run("blender", {}, {.build_everything = true}).built).count("texture path to memory"), 1U);
}

TEST(LeaveOut, WhatNobodyReadsIsNotFetched) {
    // Positions and colours lie interleaved; depths alone need 12 of the 16 bytes.
    const Replay colours("gen:random-quads?n=3000&area=4096", {.width = 64, .height = 64});
    const Replay depths("gen:random-quads?n=3000&area=4096", {64, 64, "transparency", "auto", {"entry=z", "k=4"}});
    const Replay blob("gen:blob?triangles=5000", {.width = 64, .height = 64});
    const Replay blob_depths("gen:blob?triangles=5000", {64, 64, "transparency", "auto", {"entry=z", "k=4"}});
    const auto vertex_bytes = [](const Replay& replay) {
        return support::counter(replay.run("blender").bytes, "dram_vertex/bytes");
    };
    EXPECT_LE(vertex_bytes(depths), vertex_bytes(colours));
    EXPECT_LT(vertex_bytes(blob_depths), 0.6 * static_cast<double>(vertex_bytes(blob))); // normals stay in memory
    EXPECT_TRUE(depths.streams[0].colours.empty());
    EXPECT_TRUE(depths.streams[0].texture_lines.empty());
}

namespace {

/// Counters without those that say when or how long something happened: a unit more on the way shifts time.
nlohmann::ordered_json without_time(const nlohmann::ordered_json& counters) {
    nlohmann::ordered_json kept = nlohmann::ordered_json::object();
    for (const auto& item : counters.items()) {
        const auto about = [&item](const char* word) { return item.key().find(word) != std::string::npos; };
        if (about("max") || about("queued") || about("in_flight") || about("wait") || about("residence") ||
            about("interval") || about("stalls") || about("row_") || about("conflicts") || about("turnarounds") ||
            about("refreshes") || about("inserted"))
            continue;
        kept[item.key()] = item.value().is_object() ? without_time(item.value()) : item.value();
    }
    return kept;
}

} // namespace

TEST(LeaveOut, BuildingEverythingChangesNeitherPictureNorCounts) {
    for (const Expectation& expected : expectations()) {
        const Replay replay(expected.scene, expected.options);
        for (const std::string& design : designs_of(replay)) {
            SCOPED_TRACE(fmt::format("{} on {} of {}", design, expected.options.workload.name(), expected.scene));
            const RunResult lean = replay.run(design);
            const RunResult full = replay.run(design, {}, {.build_everything = true});
            EXPECT_GE(full.built.size(), lean.built.size());
            EXPECT_TRUE(full.kbuffer == lean.kbuffer);
            EXPECT_TRUE(full.colour == lean.colour);
            EXPECT_EQ(full.wrong_pixels, lean.wrong_pixels);
            EXPECT_EQ(full.fragments, lean.fragments);
            for (const auto& stage : lean.stages->items()) {
                ASSERT_TRUE(full.stages->contains(stage.key()));
                EXPECT_EQ(without_time(full.stages->at(stage.key()).at("counters")),
                          without_time(stage.value().at("counters")))
                    << stage.key();
            }
        }
    }
}

} // namespace leave_out_test
