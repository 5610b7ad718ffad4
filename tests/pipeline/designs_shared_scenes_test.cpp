// K3 on all further scenes: every design that protects the pixel, every program that it runs.
// Source: specification 004, check K3.
#include "models/programs/library.hpp"
#include "models/programs/pictures.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/replay.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace designs_shared_scenes_test {

using nlohmann::json;
using pipeline::RunResult;
using support::Replay;

// At more of either, geometry is most of the time, and it is the same for all programs.
constexpr std::uint32_t most_triangles = 12000, size = 48;

/// Files of glTF or of tetrahedra that need no decoder; empty where there is no such folder.
std::vector<std::string> scene_files(bool tetrahedra) {
    std::vector<std::string> files;
    const auto list = ropsim_test::shared_file("scenes/scenes.json");
    if (!list) return files;
    std::ifstream stream(*list);
    for (const json& scene : json::parse(stream)) {
        const bool wanted = tetrahedra ? scene["kind"] == "vtk" || scene["kind"] == "tetm" : scene["kind"] == "gltf";
        if (!wanted) continue;
        for (const auto& [name, measured] : scene["measured"].items()) {
            const json required = measured.value("extensions_required", json::array());
            const bool undecoded = std::any_of(required.begin(), required.end(), [](const std::string& extension) {
                return extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression" ||
                       extension == "KHR_texture_basisu";
            });
            if (!undecoded) files.push_back((list->parent_path() / scene["id"].get<std::string>() / name).string());
        }
    }
    return files;
}

/// Of large scenes, the first triangles of every geometry.
traces::Scene load(const std::string& file) {
    traces::Scene scene = traces::load_scene(file);
    const std::uint64_t triangles = scene.triangles_drawn;
    if (triangles <= most_triangles) return scene;
    for (pipeline::Geometry& geometry : scene.resources->geometries) {
        if (geometry.primitive_restart) continue;
        const std::uint64_t share = std::uint64_t{geometry.triangle_count()} * most_triangles / triangles + 1;
        geometry.index_count = std::min(geometry.index_count, static_cast<std::uint32_t>(3 * share));
    }
    return scene;
}

void expect_reference(const Replay& replay, const std::string& place) {
    for (const std::string& design : replay.designs()) {
        if (!support::protects(design)) continue;
        SCOPED_TRACE(design + " on " + place);
        const RunResult run = replay.run(design);
        EXPECT_EQ(run.hazards.total(), 0U);
        EXPECT_EQ(run.unexplained_pixels(), 0U);
        if (!support::holds_everything(design)) {
            // A silhouette is seen in the pixels beside it, too.
            EXPECT_LE(run.wrong_pixels - run.wrong_because.inputs, run.overflow_pixels);
            continue;
        }
        EXPECT_EQ(run.lost_fragments, 0U);
        EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer);
        EXPECT_TRUE(run.colour == replay.reference.colour);
    }
}

/// All programs with each kind of entry, and one that a user wrote.
std::vector<std::pair<std::string, models::ProgramChoice>> all_programs() {
    std::vector<std::pair<std::string, models::ProgramChoice>> all;
    for (const models::Program& program : models::programs())
        for (const std::string& entry : program.entries)
            all.emplace_back(program.id + " of " + entry,
                             models::choose_program(program.id, {entry, std::min(program.most_k, 4U), 0.5F}));
    all.emplace_back("order_and_blend.kb", models::choose_program("order_and_blend.kb", {"", 3, 0.5F}));
    return all;
}

/// The frame with another program in its k-buffer, and its picture.
void use(pipeline::Frame& frame, const models::ProgramChoice& choice) {
    frame.program = choice.program;
    for (pipeline::SurfaceInfo& surface : frame.surfaces)
        if (surface.program != nullptr) surface.program = choice.program;
    const models::MakePicture picture = choice.picture ? choice.picture : models::layers_picture(0.5F);
    for (pipeline::Pass& pass : frame.passes)
        if (pass.kind == pipeline::PassKind::compose)
            pass.shader = picture({frame.program, frame.view, glm::vec3(frame.background), pass.reads.size() == 2});
}

TEST(EqualReference, K3_LongEveryProtectedDesignProgramAndSharedScene) {
    const auto files = scene_files(false);
    if (files.empty()) GTEST_SKIP() << "no further scenes here: set ROPSIM_SHARED_DIR";
    EXPECT_GE(files.size(), 39U);
    const auto programs = all_programs();
    EXPECT_GE(programs.size(), 12U);
    for (const std::string& file : files) {
        Replay replay(load(file), {.width = size, .height = size});
        for (const auto& [name, choice] : programs) {
            use(replay.frame, choice);
            replay.reference = pipeline::run_reference(replay.frame, replay.streams);
            expect_reference(replay, name + " in " + file);
        }
    }
}

TEST(EqualReference, K3_LongEveryProtectedDesignOnSharedTetrahedra) {
    const auto files = scene_files(true);
    if (files.empty()) GTEST_SKIP() << "no further scenes here: set ROPSIM_SHARED_DIR";
    for (const std::string& file : files) {
        const traces::Scene scene = load(file);
        for (const char* workload : {"isosurface", "volume"})
            expect_reference(Replay(scene, {.width = size, .height = size, .workload = workload}),
                             fmt::format("{} of {}", workload, file));
    }
}

} // namespace designs_shared_scenes_test
