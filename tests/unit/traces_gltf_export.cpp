// What is written as glTF draws the same when it is read again.
#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/preparation_kit.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/gltf_export.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace traces_gltf_export_test {

using namespace tests;
using pipeline::Semantic;
using traces::Scene;

/// Written to a file and read back.
Scene again(const Scene& scene, std::vector<std::string>* notes = nullptr) {
    const support::TemporaryFolder folder;
    const auto path = folder.path() / "scene.glb";
    const auto written = traces::export_glb(scene, path);
    if (notes != nullptr) *notes = written;
    return traces::load_scene(path.string());
}

std::string export_error(const Scene& scene, const std::filesystem::path& path) {
    try {
        traces::export_glb(scene, path);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(GltfExport, RoundTripDrawsTheSameTrianglesAfterEveryPreparation) {
    const Scene scene = scene_of({hill_mesh(12, 9, 1), soup_mesh(60, 30, 2), degenerate_mesh(3)});
    for (const traces::Preparation& one : traces::preparations()) {
        SCOPED_TRACE(one.id);
        const Scene before = prepared(scene, one.id).scene;
        const Scene after = again(before);
        EXPECT_EQ(triangle_values(before, true), triangle_values(after, true));
        ASSERT_EQ(before.draws.size(), after.draws.size());
        for (std::size_t i = 0; i < before.draws.size(); ++i) {
            const auto& was = before.resources->geometries[before.draws[i].geometry];
            const auto& is = after.resources->geometries[after.draws[i].geometry];
            EXPECT_EQ(is.topology, was.topology);
            EXPECT_EQ(is.index_type, was.index_type);
            ASSERT_EQ(is.attributes.size(), was.attributes.size());
            for (const auto& attribute : was.attributes) {
                const auto* found = is.find(attribute.semantic);
                ASSERT_NE(found, nullptr);
                EXPECT_EQ(found->type, attribute.type);
                EXPECT_EQ(found->stride, attribute.stride);
                EXPECT_EQ(found->offset, attribute.offset);
            }
        }
    }
}

TEST(GltfExport, ShortPositionsSurviveBitForBit) {
    const Scene before = prepared(scene_of({hill_mesh(12, 9, 1)}), "quantise?normals=s8").scene;
    const Scene after = again(before);
    const auto bits = [](const Scene& scene, Semantic semantic) {
        const auto& geometry = scene.resources->geometries[0];
        const auto& attribute = *geometry.find(semantic);
        std::vector<std::byte> list;
        for (std::uint32_t i = 0; i < geometry.vertex_count; ++i) {
            const std::byte* first = scene.resources->buffers[attribute.buffer].bytes.data() + attribute.offset +
                                     std::size_t{i} * attribute.stride;
            list.insert(list.end(), first, first + attribute.bytes());
        }
        return list;
    };
    EXPECT_EQ(after.resources->geometries[0].find(Semantic::position)->type, pipeline::ComponentType::s16);
    for (const Semantic semantic : {Semantic::position, Semantic::normal, Semantic::colour})
        EXPECT_EQ(bits(before, semantic), bits(after, semantic));
    EXPECT_EQ(before.draws[0].instances, after.draws[0].instances);
}

TEST(GltfExport, WhatGltfCannotSayIsChangedAndNoted) {
    Scene scene = prepared(scene_of({hill_mesh(12, 9, 1)}), "strips?stitch=restart").scene;
    auto& attributes = scene.resources->geometries[0].attributes;
    auto& colour = *std::find_if(attributes.begin(), attributes.end(),
                                 [](const auto& one) { return one.semantic == Semantic::colour; });
    colour.normalized = false;
    std::vector<std::string> notes;
    const Scene after = again(scene, &notes);
    EXPECT_EQ(triangle_values(scene, false), triangle_values(after, false));
    ASSERT_EQ(notes.size(), 2U);
    EXPECT_NE(notes[0].find("restart"), std::string::npos);
    EXPECT_NE(notes[1].find("COLOR_0"), std::string::npos);
}

TEST(GltfExport, IndexThatGltfReservesIsWidened) {
    traces::Mesh mesh;
    mesh.name = "row";
    for (std::uint32_t i = 0; i < 65'536; ++i) mesh.positions.emplace_back(i, i % 7, 0);
    for (std::uint32_t i = 0; i + 2 < mesh.positions.size(); ++i)
        mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 2});
    const Scene scene = scene_of({mesh});
    ASSERT_EQ(scene.resources->geometries[0].index_type, pipeline::IndexType::u16);
    std::vector<std::string> notes;
    const Scene after = again(scene, &notes);
    EXPECT_EQ(after.resources->geometries[0].index_type, pipeline::IndexType::u32);
    EXPECT_EQ(notes.size(), 1U);
    EXPECT_EQ(triangle_values(scene, true), triangle_values(after, true));
}

TEST(GltfExport, MaterialsTexturesCamerasAndLightsComeBack) {
    Scene scene = scene_of({hill_mesh(3, 3, 1)});
    pipeline::Texture texture;
    texture.name = "stripes";
    texture.wrap_v = pipeline::Wrap::mirror;
    texture.mag_filter = pipeline::Filter::nearest;
    pipeline::Texture::Level level{5, 3, {}, 0};
    for (std::uint32_t i = 0; i < 5 * 3 * 4; ++i) level.rgba.push_back(static_cast<std::uint8_t>(i * 37));
    texture.levels.push_back(level);
    texture.make_mips();
    scene.resources->textures.push_back(texture);
    pipeline::Material& material = scene.resources->materials[0];
    material.base_texture = 0;
    material.uv_transform = glm::mat3(0, -2, 0, 0.5F, 0, 0, 0.25F, 0.75F, 1); // turned by a quarter
    material.alpha_mode = pipeline::AlphaMode::mask;
    material.alpha_cutoff = 0.3F;
    material.unlit = true;
    material.transmission = 0.4F;
    traces::Camera camera;
    camera.name = "here";
    camera.fovy = 0.7F;
    camera.near = 0.1F;
    camera.to_world[3] = glm::vec4(1, 2, 3, 1);
    scene.cameras.push_back(camera);
    scene.lights.push_back({"lamp", traces::LightKind::spot, camera.to_world, glm::vec3(1, 0.5F, 0), 4.0F, 9.0F});
    traces::finish_scene(scene);

    const Scene after = again(scene);
    const pipeline::Material& read = after.resources->materials.at(0);
    EXPECT_EQ(read.base_colour, material.base_colour);
    EXPECT_EQ(read.alpha_mode, material.alpha_mode);
    EXPECT_EQ(read.alpha_cutoff, material.alpha_cutoff);
    EXPECT_EQ(read.double_sided, material.double_sided);
    EXPECT_EQ(read.unlit, material.unlit);
    EXPECT_EQ(read.transmission, material.transmission);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            EXPECT_NEAR(read.uv_transform[column][row], material.uv_transform[column][row], 1e-6F);
    after.resources->read_textures();
    const pipeline::Texture& image = after.resources->textures.at(0);
    EXPECT_EQ(image.levels.at(0).rgba, level.rgba);
    EXPECT_EQ(image.wrap_u, pipeline::Wrap::repeat);
    EXPECT_EQ(image.wrap_v, pipeline::Wrap::mirror);
    EXPECT_EQ(image.mag_filter, pipeline::Filter::nearest);
    ASSERT_EQ(after.cameras.size(), 1U);
    EXPECT_EQ(after.cameras[0].to_world, camera.to_world);
    EXPECT_EQ(after.cameras[0].fovy, camera.fovy);
    EXPECT_EQ(after.cameras[0].far, 0.0F);
    ASSERT_EQ(after.lights.size(), 1U);
    EXPECT_EQ(after.lights[0].kind, traces::LightKind::spot);
    EXPECT_EQ(after.lights[0].intensity, 4.0F);
    EXPECT_EQ(after.lights[0].colour, glm::vec3(1, 0.5F, 0));
}

TEST(GltfExport, InstancesComeBackAsOneDrawWhereTheyCan) {
    Scene scene = scene_of({hill_mesh(3, 3, 1)});
    glm::mat4 turned(0.0F); // a quarter about y, mirrored, twice as large
    turned[0][2] = 2.0F;
    turned[1][1] = 2.0F;
    turned[2][0] = 2.0F;
    turned[3] = glm::vec4(5, 6, 7, 1);
    scene.draws[0].instances.push_back(turned);
    traces::finish_scene(scene);
    const Scene after = again(scene);
    ASSERT_EQ(after.draws.size(), 1U);
    ASSERT_EQ(after.draws[0].instances.size(), 2U);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            EXPECT_NEAR(after.draws[0].instances[1][column][row], turned[column][row], 1e-5F);

    scene.draws[0].instances[1][0][1] = 1.0F; // sheared
    std::vector<std::string> notes;
    const Scene apart = again(scene, &notes);
    ASSERT_EQ(apart.draws.size(), 2U);
    EXPECT_EQ(apart.draws[1].instances[0], scene.draws[0].instances[1]);
    EXPECT_EQ(apart.draws[0].geometry, apart.draws[1].geometry);
    EXPECT_EQ(notes.size(), 1U);
}

TEST(GltfExport, PlacesThatCannotBeWrittenAreOneLineAndLeaveNothingBehind) {
    const Scene scene = scene_of({hill_mesh(40, 40, 1)});
    const support::TemporaryFolder folder;
    EXPECT_NE(export_error(scene, folder.path() / "absent" / "scene.glb").find("cannot be written"), std::string::npos);
    EXPECT_NE(export_error(scene, folder.path()).find("expected the name of a file"), std::string::npos);
    const auto path = folder.write("kept.glb", "old");

    // A file system without room for it: writing stops after 16 KiB.
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit small{16384, limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string error = export_error(scene, path);
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, handler);

    EXPECT_NE(error.find("kept.glb: cannot be written: "), std::string::npos);
    EXPECT_EQ(error.find('\n'), std::string::npos);
    EXPECT_EQ(std::filesystem::file_size(path), 3U);
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
    EXPECT_EQ(files, 1U);
}

TEST(GltfExport, PlacesOnTheScreenAreRefused) {
    const support::TemporaryFolder folder;
    EXPECT_NE(
        export_error(traces::load_scene("gen:stack?n=3"), folder.path() / "stack.glb").find("places on the screen"),
        std::string::npos);
}

TEST(GltfExport, SharedScenesDrawTheSameTriangles) {
    std::size_t seen = 0;
    for (const char* name :
         {"suzanne/Suzanne.gltf", "simple_instancing/SimpleInstancing.glb", "test_vertex_color/VertexColorTest.glb",
          "test_mesh_primitive_modes/MeshPrimitiveModes.gltf", "fox_skinned/Fox.glb",
          "test_texture_transform_multi/TextureTransformMultiTest.glb", "test_box_interleaved/BoxInterleaved.gltf"}) {
        const auto file = ropsim_test::shared_file(std::filesystem::path("scenes") / name);
        if (!file) continue;
        SCOPED_TRACE(name);
        ++seen;
        const Scene before = traces::load_scene(file->string());
        const Scene after = again(before);
        EXPECT_EQ(after.triangles_drawn, before.triangles_drawn);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(after.lo[axis], before.lo[axis], 1e-5F * before.radius);
            EXPECT_NEAR(after.hi[axis], before.hi[axis], 1e-5F * before.radius);
        }
        if (std::string_view(name).starts_with("simple_instancing")) continue; // matrices are split
        EXPECT_EQ(triangle_values(before, true), triangle_values(after, true));
    }
    if (seen == 0) GTEST_SKIP() << "no folder of shared scenes";
}

} // namespace traces_gltf_export_test
