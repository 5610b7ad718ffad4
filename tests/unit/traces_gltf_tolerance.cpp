// Valid glTF that readers stumble over, and what may be wrong because nothing depends on it.
#include "sim/check.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/camera.hpp"
#include "traces/workloads.hpp"

#include <gtest/gtest.h>

namespace gltf_tolerance_test {

using nlohmann::json;
using support::GltfFile;
using support::triangle_file;
using traces::Scene;

TEST(GltfTolerance, NodesThatAreNotVisibleHideWhatIsBelowThem) {
    GltfFile file = triangle_file();
    file.json["extensionsRequired"] = {"KHR_node_visibility"};
    file.json["nodes"] = json::parse(R"([{"mesh": 0}, {"mesh": 0, "children": [2],
        "extensions": {"KHR_node_visibility": {"visible": false}}}, {"mesh": 0}])");
    file.json["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = file.load();
    EXPECT_EQ(scene.draws.size(), 1U);
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_EQ(scene.notes[0], "2 nodes are not visible");
}

TEST(GltfTolerance, FilesWithoutTrianglesSayWhatTheyHave) {
    GltfFile file = triangle_file();
    file.json["meshes"][0]["primitives"][0]["mode"] = 0;
    const std::string error = file.error();
    EXPECT_TRUE(error.ends_with("; 1 draw of points and lines is left out")) << error;
}

TEST(GltfTolerance, WholeNumbersMayHaveAFraction) {
    GltfFile file = triangle_file();
    file.json["nodes"] =
        json::parse(R"([{"children": [1.0, 2e0]}, {"mesh": 0.0}, {"mesh": 0, "translation": [1, 0, 0]}])");
    file.json["scene"] = 0.0;
    file.json["accessors"][0]["count"] = 3.0;
    EXPECT_EQ(file.load().draws.size(), 2U);
}

TEST(GltfTolerance, WhatNothingReadsMayBeBadWithANote) {
    GltfFile file = triangle_file();
    file.json["animations"] = json::parse(R"([{"channels": [{"sampler": -1}]}])");
    file.json["asset"]["generator"] = 7;
    const Scene scene = file.load();
    ASSERT_EQ(scene.notes.size(), 3U);
    EXPECT_EQ(scene.notes[0], "asset.generator: expected a text, got 7 (nothing depends on it)");
    EXPECT_EQ(scene.notes[1], "animations[0].channels[0].sampler: expected a whole number from 0 to 2147483647, got -1 "
                              "(nothing depends on it)");
}

TEST(GltfTolerance, LaterVersionsAreReadWhereTheySaySo) {
    GltfFile file = triangle_file();
    file.json["asset"] = json::parse(R"({"version": "2.1", "minVersion": "2.0"})");
    EXPECT_EQ(file.load().draws.size(), 1U);
    file.json["asset"]["minVersion"] = "2.1";
    EXPECT_EQ(file.error(), "scene.gltf: asset.minVersion: expected \"2.0\", got \"2.1\"");
}

TEST(GltfTolerance, ViewsAndSkinsBelowMirrorsKeepTheirFaces) {
    GltfFile file = triangle_file();
    file.json["cameras"] = json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5}}])");
    file.json["nodes"] = json::parse(R"([{"mesh": 0, "scale": [1, 2, -1]}, {"children": [2], "scale": [-3, 1, 1]},
                                         {"camera": 0, "translation": [1, 0, 5]}])");
    file.json["scenes"][0]["nodes"] = {0, 1};
    const glm::mat4 to_world = file.load().cameras.at(0).to_world;
    EXPECT_EQ(to_world[0], glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(to_world[2], glm::vec4(0, 0, 1, 0));
    EXPECT_EQ(to_world[3], glm::vec4(-3, 0, 5, 1));
    // Axes that are not at right angles: the direction of view stays.
    file.json["nodes"][1]["scale"] = {1, 1, 4};
    file.json["nodes"][2]["rotation"] = {0, 0.6, 0, 0.8};
    const glm::mat3 turned(file.load().cameras.at(0).to_world);
    EXPECT_NEAR(glm::determinant(turned), 1.0F, 1e-6F);
    EXPECT_NEAR(glm::distance(turned[2], glm::normalize(glm::vec3(0.96F, 0, 4 * 0.28F))), 0.0F, 1e-6F);
}

TEST(GltfTolerance, ScalarsThatAColourCannotHoldAreRefused) {
    GltfFile file = triangle_file();
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        file.add({1, 0, 0, 70000, 0, 0, 3, 0, 0}, "VEC3");
    const Scene scene = file.load();
    const pipeline::View view = traces::make_view(scene, "auto", 8, 8);
    try {
        traces::build_frame(scene, view, "isosurface");
        FAIL() << "70000 is above what the shader lets through";
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(),
                     "workload isosurface: expected scalars of at most 65504, which the colours of fragments "
                     "hold, got 70000");
    }
}

} // namespace gltf_tolerance_test
