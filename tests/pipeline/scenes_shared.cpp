// The real scenes of the shared folder: counts, bounds, and what the front end makes of them.
#include "pipeline/functional/front_end.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/camera.hpp"
#include "traces/workloads.hpp"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace scenes_shared_test {

using nlohmann::json;

struct Listed {
    std::string id;
    std::filesystem::path path;
    json measured;
};

/// The glTF files that scenes.json lists; empty where the folder is absent.
std::vector<Listed> listed_files() {
    std::vector<Listed> files;
    const auto list = ropsim_test::shared_file("scenes/scenes.json");
    if (!list) return files;
    std::ifstream stream(*list);
    for (const json& scene : json::parse(stream)) {
        if (scene["kind"] != "gltf") continue;
        for (const auto& [name, measured] : scene["measured"].items())
            files.push_back({scene["id"], list->parent_path() / scene["id"].get<std::string>() / name, measured});
    }
    return files;
}

bool has_no_decoder(const Listed& file) { return file.id == "ext_ktx2_stained_glass_lamp"; }

TEST(SharedScenes, HaveTheTrianglesDrawsAndBoundsThatWereMeasured) {
    const auto files = listed_files();
    if (files.empty()) GTEST_SKIP() << "no folder of shared scenes";
    std::size_t loaded = 0;
    for (const Listed& file : files) {
        if (has_no_decoder(file)) continue;
        SCOPED_TRACE(file.path.string());
        const traces::Scene scene = traces::load_scene(file.path.string());
        ++loaded;
        EXPECT_EQ(scene.triangles, file.measured["triangles"].get<std::uint64_t>());
        EXPECT_EQ(scene.triangles_drawn, file.measured["triangles_drawn"].get<std::uint64_t>());
        // The list measures points and lines, too; they are not drawn.
        if (file.id == "test_mesh_primitive_modes") {
            EXPECT_EQ(scene.draws.size(), 3U);
            EXPECT_NEAR(scene.hi.y, -2.0F, 1e-6F);
            continue;
        }
        EXPECT_EQ(scene.draws.size(), file.measured["draws"].get<std::size_t>());
        const json& box = file.measured["bbox"];
        double size = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            size = std::max(size, box[1][axis].get<double>() - box[0][axis].get<double>());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<glm::length_t>(axis);
            EXPECT_NEAR(scene.lo[i], box[0][axis].get<double>(), 1e-3 * size);
            EXPECT_NEAR(scene.hi[i], box[1][axis].get<double>(), 1e-3 * size);
        }
    }
    EXPECT_GE(loaded, 41U);
}

TEST(SharedScenes, ThoseWithoutADecoderAreRefusedByName) {
    const auto files = listed_files();
    if (files.empty()) GTEST_SKIP() << "no folder of shared scenes";
    std::size_t refused = 0;
    for (const Listed& file : files) {
        if (!has_no_decoder(file)) continue;
        const std::string extension = file.measured["extensions_required"][0];
        const std::string error = support::load_error(file.path.string());
        EXPECT_NE(error.find(extension), std::string::npos) << error;
        ++refused;
    }
    EXPECT_EQ(refused, 1U);
}

TEST(SharedScenes, AreInView) {
    for (const char* name : {"scenes/utah_teapot/utah_teapot.glb", "scenes/test_negative_scale/NegativeScaleTest.glb",
                             "scenes/transmission_test/TransmissionTest.glb"}) {
        const auto path = ropsim_test::shared_file(name);
        if (!path) GTEST_SKIP() << "no folder of shared scenes";
        const traces::Scene scene = traces::load_scene(path->string());
        scene.resources->read_textures();
        std::vector<std::uint32_t> all(scene.draws.size());
        std::iota(all.begin(), all.end(), 0U);
        const auto view = traces::make_view(scene, "auto", 128, 128);
        const auto stream = pipeline::rasterize(*scene.resources, scene.draws, all, view);
        EXPECT_GT(stream.fragments, 128U * 128U / 10) << name;
    }
}

std::vector<std::string> left_out(const pipeline::Frame& frame) {
    std::vector<std::string> units;
    for (const auto& item : frame.left_out) units.push_back(item.unit);
    return units;
}

TEST(SharedScenes, LeaveOutWhatTheyDoNotNeed) {
    const auto path = ropsim_test::shared_file("scenes/sponza/sponza.gltf");
    if (!path) GTEST_SKIP() << "no folder of shared scenes";
    const traces::Scene scene = traces::load_scene(path->string());
    const auto view = traces::make_view(scene, "auto", 64, 64);
    using Units = std::vector<std::string>;
    EXPECT_EQ(left_out(traces::build_frame(scene, view, "transparency")),
              (Units{"pass opaque", "vertex colours", "depth surface", "early depth test", "colour surface"}));
    traces::WorkloadOptions options;
    options.set("entry=z");
    options.set("k=16");
    // The leaves' alpha test still reads its texture.
    EXPECT_EQ(left_out(traces::build_frame(scene, view, "transparency", options)),
              (Units{"pass opaque", "normals", "vertex colours", "colours", "depth surface", "early depth test",
                     "colour surface"}));
    EXPECT_EQ(left_out(traces::build_frame(scene, view, "opaque")),
              (Units{"vertex colours", "early depth test", "k-buffer"}));
}

} // namespace scenes_shared_test
