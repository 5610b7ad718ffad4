// What glTF import makes of a file, one feature at a time.
#include "pipeline/functional/vertex_fetch.hpp"
#include "tests/support/scene_files.hpp"

#include <gtest/gtest.h>

namespace {

using nlohmann::json;
using pipeline::ComponentType;
using pipeline::Semantic;
using support::GltfFile;
using support::position_at;
using support::triangle_file;
using traces::Scene;

const pipeline::Geometry& only_geometry(const Scene& scene) { return scene.resources->geometries.at(0); }

TEST(GltfImport, TextAndBinaryContainersGiveTheSameScene) {
    GltfFile file = triangle_file();
    file.json["nodes"][0]["translation"] = {1, 2, 3};
    const support::TemporaryFolder folder;
    const Scene text = traces::load_scene(folder.write("a.gltf", file.text()).string());
    const Scene binary = traces::load_scene(folder.write("b.glb", file.binary()).string());
    EXPECT_EQ(text.lo, binary.lo);
    EXPECT_EQ(text.lo, glm::vec3(1, 2, 3));
    EXPECT_EQ(text.resources->buffers.at(0).bytes, binary.resources->buffers.at(0).bytes);
    EXPECT_EQ(text.name, "a.gltf");
    EXPECT_NE(text.hash, binary.hash);
    EXPECT_EQ(text.hash.size(), 16U);
    EXPECT_EQ(text.hash, traces::load_scene((folder.path() / "a.gltf").string()).hash);
}

TEST(GltfImport, HashCoversTheFilesThatAFileNames) {
    GltfFile file = triangle_file();
    file.json["buffers"] = json::parse(R"([{"byteLength": 36, "uri": "a%20b.bin"}])");
    const support::TemporaryFolder folder;
    std::array<float, 9> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const auto hash = [&] {
        folder.write("a b.bin", {reinterpret_cast<const char*>(positions.data()), sizeof positions});
        return traces::load_scene(folder.write("a.gltf", file.text()).string()).hash;
    };
    const std::string first = hash();
    positions[3] = 2.0F;
    EXPECT_NE(hash(), first);
}

TEST(GltfImport, InterleavedBuffersStayAsTheyAre) {
    GltfFile file = triangle_file();
    std::vector<float> vertices;
    for (const float x : {0.0F, 1.0F, 2.0F}) vertices.insert(vertices.end(), {x, x * x, 0, 0, 0, 1});
    const int view = file.add_view({reinterpret_cast<const char*>(vertices.data()), vertices.size() * 4});
    file.json["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 24;
    for (const int offset : {0, 12})
        file.json["accessors"].push_back(
            {{"bufferView", view}, {"byteOffset", offset}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    file.json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 1}, {"NORMAL", 2}};
    const Scene scene = file.load();
    const pipeline::VertexAttribute& position = *only_geometry(scene).find(Semantic::position);
    const pipeline::VertexAttribute& normal = *only_geometry(scene).find(Semantic::normal);
    EXPECT_EQ(scene.resources->buffers.size(), 1U);
    EXPECT_EQ(position.stride, 24U);
    EXPECT_EQ(normal.stride, 24U);
    EXPECT_EQ(normal.offset, position.offset + 12);
    EXPECT_EQ(position_at(scene, 0, 2), glm::vec3(2, 4, 0));
}

TEST(GltfImport, IndexWidthsAreKept) {
    const std::vector<std::uint32_t> order{2, 1, 0};
    const auto index_type = [&](int component_type) {
        GltfFile file = triangle_file();
        const int indices =
            component_type == 5121
                ? file.add_integers(std::vector<std::uint8_t>(order.begin(), order.end()), "SCALAR", 5121)
            : component_type == 5123
                ? file.add_integers(std::vector<std::uint16_t>(order.begin(), order.end()), "SCALAR", 5123)
                : file.add_integers(order, "SCALAR", 5125);
        file.json["meshes"][0]["primitives"][0]["indices"] = indices;
        const Scene scene = file.load();
        EXPECT_EQ(pipeline::IndexReader(*scene.resources, only_geometry(scene))(0), 2U);
        return only_geometry(scene).index_type;
    };
    EXPECT_EQ(index_type(5121), pipeline::IndexType::u8);
    EXPECT_EQ(index_type(5123), pipeline::IndexType::u16);
    EXPECT_EQ(index_type(5125), pipeline::IndexType::u32);
}

TEST(GltfImport, StripsAndFansKeepTheirTopologyAndLinesAreLeftOut) {
    GltfFile file = triangle_file();
    file.add({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0}, "VEC3");
    for (const int mode : {5, 6, 1})
        file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 1}}}, {"mode", mode}});
    const Scene scene = file.load();
    ASSERT_EQ(scene.draws.size(), 3U);
    EXPECT_EQ(scene.resources->geometries[1].topology, pipeline::Topology::triangle_strip);
    EXPECT_EQ(scene.resources->geometries[2].topology, pipeline::Topology::triangle_fan);
    EXPECT_EQ(scene.triangles, 7U);
    EXPECT_EQ(scene.triangles_drawn, 7U);
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_EQ(scene.notes[0], "1 draw of points and lines is left out");
}

TEST(GltfImport, SparseElementsReplaceThoseOfTheBase) {
    GltfFile file = triangle_file();
    const std::vector<std::uint16_t> targets{1};
    const std::vector<float> values{5, 6, 7};
    const int indices = file.add_view({reinterpret_cast<const char*>(targets.data()), 2});
    const int moved = file.add_view({reinterpret_cast<const char*>(values.data()), 12});
    file.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", moved}}}};
    Scene scene = file.load();
    EXPECT_EQ(position_at(scene, 0, 1), glm::vec3(5, 6, 7));
    EXPECT_EQ(position_at(scene, 0, 2), glm::vec3(0, 1, 0));
    file.json["accessors"][0].erase("bufferView"); // then the base is all zero
    scene = file.load();
    EXPECT_EQ(position_at(scene, 0, 1), glm::vec3(5, 6, 7));
    EXPECT_EQ(position_at(scene, 0, 2), glm::vec3(0));
}

TEST(GltfImport, SparseIndicesAreOverlaid) {
    GltfFile file = triangle_file();
    const std::vector<std::uint16_t> base{0, 0, 0};
    const int indices = file.add_integers(base, "SCALAR", 5123);
    file.json["meshes"][0]["primitives"][0]["indices"] = indices;
    const std::vector<std::uint8_t> targets{1, 2};
    const std::vector<std::uint16_t> values{2, 1};
    const int places = file.add_view({reinterpret_cast<const char*>(targets.data()), 2});
    const int changed = file.add_view({reinterpret_cast<const char*>(values.data()), 4});
    auto& accessor = file.json["accessors"][static_cast<std::size_t>(indices)];
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                          {"values", {{"bufferView", changed}}}};
    const auto triangle = [](const Scene& scene) {
        return pipeline::PrimitiveReader(*scene.resources, only_geometry(scene))(0);
    };
    const Scene scene = file.load();
    EXPECT_EQ(only_geometry(scene).index_type, pipeline::IndexType::u32);
    EXPECT_EQ(triangle(scene), (std::array<std::uint32_t, 3>{0, 2, 1}));
    accessor["normalized"] = true;
    EXPECT_NE(file.error().find("indices: expected unsigned integers"), std::string::npos) << file.error();
}

TEST(GltfImport, QuantisedPositionsStayQuantised) {
    GltfFile file = triangle_file();
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::vector<std::int16_t> values{0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0};
    const int view = file.add_view({reinterpret_cast<const char*>(values.data()), values.size() * 2});
    file.json["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 8;
    file.json["accessors"].push_back(
        {{"bufferView", view}, {"componentType", 5122}, {"count", 3}, {"type", "VEC3"}, {"normalized", true}});
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 1;
    const Scene scene = file.load();
    EXPECT_EQ(only_geometry(scene).find(Semantic::position)->type, ComponentType::s16);
    EXPECT_EQ(only_geometry(scene).find(Semantic::position)->stride, 8U);
    EXPECT_EQ(position_at(scene, 0, 1), glm::vec3(1, 0, 0));
    EXPECT_EQ(position_at(scene, 0, 2), glm::vec3(0, -1, 0));
}

TEST(GltfImport, NodesMultiplyTheirTransforms) {
    GltfFile file = triangle_file();
    file.json["nodes"] = json::parse(R"([
        {"children": [1], "translation": [10, 0, 0]},
        {"children": [2], "rotation": [0, 0, 0.70710678118, 0.70710678118], "scale": [2, 2, 2]},
        {"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,0,0,1]}])");
    const Scene scene = file.load();
    // x -> +1 -> doubled and turned to y -> +10 in x
    const glm::vec3 corner(scene.draws[0].instances[0] * glm::vec4(1, 0, 0, 1));
    EXPECT_NEAR(corner.x, 10.0F, 1e-5F);
    EXPECT_NEAR(corner.y, 4.0F, 1e-5F);
}

TEST(GltfImport, MorphTargetsApplyTheirDefaultWeights) {
    GltfFile file = triangle_file();
    const int moves = file.add({0, 0, 8, 0, 0, 8, 0, 0, 8}, "VEC3");
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", moves}}};
    file.json["meshes"][0]["weights"] = {0.25};
    EXPECT_EQ(position_at(file.load(), 0, 1), glm::vec3(1, 0, 2));
    file.json["nodes"][0]["weights"] = {0.5}; // a node's own weights win
    EXPECT_EQ(position_at(file.load(), 0, 1), glm::vec3(1, 0, 4));
    file.json["nodes"][0]["weights"] = {0.0};
    EXPECT_EQ(position_at(file.load(), 0, 1), glm::vec3(1, 0, 0));
}

TEST(GltfImport, SkinsFollowTheirJointsNotTheirNode) {
    GltfFile file = triangle_file();
    const int joints = file.add_integers(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", 5121);
    const int weights = file.add({1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0}, "VEC4");
    std::vector<float> inverse(32, 0.0F);
    for (const std::size_t i : {0U, 5U, 10U, 15U}) inverse[i] = inverse[16 + i] = 1.0F;
    inverse[16 + 12] = -1.0F; // joint 1 was bound at x = 1
    const int bind = file.add(inverse, "MAT4");
    file.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = joints;
    file.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights;
    file.json["skins"] = json::parse(R"([{"joints": [1, 2]}])");
    file.json["skins"][0]["inverseBindMatrices"] = bind;
    file.json["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0, "translation": [100, 0, 0]},
                                         {"children": [2]}, {"translation": [0, 3, 0]}])");
    file.json["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = file.load();
    EXPECT_EQ(position_at(scene, 0, 0), glm::vec3(0, 0, 0)); // joint 0 stands at the origin
    EXPECT_EQ(position_at(scene, 0, 1), glm::vec3(0, 3, 0)); // from its bind pose at x = 1 to y = 3
    EXPECT_EQ(position_at(scene, 0, 2), glm::vec3(-0.5F, 2.5F, 0));
    EXPECT_EQ(scene.draws[0].instances[0], glm::mat4(1.0F));
}

TEST(GltfImport, InstancingGivesOneDrawWithManyMatrices) {
    GltfFile file = triangle_file();
    const int places = file.add({0, 0, 0, 5, 0, 0}, "VEC3");
    const int sizes = file.add({1, 1, 1, 2, 2, 2}, "VEC3");
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places},
                                                                                    {"SCALE", sizes}};
    file.json["nodes"][0]["translation"] = {0, 1, 0};
    const Scene scene = file.load();
    ASSERT_EQ(scene.draws.size(), 1U);
    ASSERT_EQ(scene.draws[0].instances.size(), 2U);
    EXPECT_EQ(glm::vec3(scene.draws[0].instances[1] * glm::vec4(1, 0, 0, 1)), glm::vec3(7, 1, 0));
    EXPECT_EQ(scene.triangles, 1U);
    EXPECT_EQ(scene.triangles_drawn, 2U);
}

TEST(GltfImport, AnotherSceneCanBeChosen) {
    GltfFile file = triangle_file();
    file.json["nodes"] = json::parse(R"([{"mesh": 0}, {"mesh": 0, "translation": [9, 0, 0]}])");
    file.json["scenes"] = json::parse(R"([{"nodes": [0]}, {"nodes": [0, 1]}])");
    const support::TemporaryFolder folder;
    const std::string path = folder.write("two.gltf", file.text()).string();
    EXPECT_EQ(traces::load_scene(path).draws.size(), 1U);
    EXPECT_EQ(traces::load_scene(path + "#1").draws.size(), 2U);
    EXPECT_EQ(traces::load_scene(path + "#1").name, "two.gltf#1");
    EXPECT_EQ(support::load_error(path + "#2", folder.path()),
              "two.gltf: scene: expected the number of one of 2 scenes, got 2");
    EXPECT_EQ(support::load_error(path + "#x", folder.path()), "two.gltf: scene: expected a number after '#', got 'x'");
}

TEST(GltfImport, MaterialsKeepWhatAFrameNeeds) {
    GltfFile file = triangle_file();
    file.json["materials"] = json::parse(R"([
        {"name": "glass", "doubleSided": true, "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 0.75]},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.9}, "KHR_materials_unlit": {}}},
        {"alphaMode": "MASK", "alphaCutoff": 0.25}, {"alphaMode": "BLEND"}])");
    for (const int material : {0, 1, 2})
        file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"material", material}});
    const Scene scene = file.load();
    const auto material_of = [&](std::size_t draw) {
        return scene.resources->materials.at(scene.draws.at(draw).material);
    };
    EXPECT_EQ(material_of(0).name, "default");
    EXPECT_EQ(material_of(1).base_colour, glm::vec4(0.5F, 0.25F, 1.0F, 0.75F));
    EXPECT_TRUE(material_of(1).double_sided && material_of(1).unlit && material_of(1).transparent());
    EXPECT_EQ(material_of(2).alpha_mode, pipeline::AlphaMode::mask);
    EXPECT_EQ(material_of(2).alpha_cutoff, 0.25F);
    EXPECT_FALSE(material_of(2).transparent());
    EXPECT_TRUE(material_of(3).transparent());
}

// Red, green; blue, transparent white.
constexpr const char* image_2x2 =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAE0lEQVR42mP4z8DwHwyBNAgwAABIyQj4xTT9BQAAAABJRU5E"
    "rkJggg==";

GltfFile textured_file() {
    GltfFile file = triangle_file();
    const int coordinates = file.add({0, 0, 1, 0, 0, 1}, "VEC2");
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_1"] = coordinates;
    primitive["material"] = 0;
    file.json["images"] = {{{"uri", image_2x2}}};
    file.json["samplers"] = json::parse(R"([{"wrapS": 33071, "wrapT": 33648, "minFilter": 9987, "magFilter": 9728}])");
    file.json["textures"] = json::parse(R"([{"source": 0, "sampler": 0}])");
    file.json["materials"] =
        json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}}}])");
    return file;
}

TEST(GltfImport, TexturesComeWithMipsAndTheirSampler) {
    const Scene scene = textured_file().load();
    ASSERT_EQ(scene.resources->textures.size(), 1U);
    const pipeline::Texture& texture = scene.resources->textures[0];
    ASSERT_EQ(texture.levels.size(), 2U);
    EXPECT_TRUE(texture.levels[0].rgba.empty()); // nobody has read it yet
    const std::uint64_t address = texture.levels[1].address;
    scene.resources->read_textures();
    EXPECT_EQ(texture.levels[1].address, address);
    EXPECT_EQ(texture.levels[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, //
                                                                 0, 0, 255, 255, 255, 255, 255, 0}));
    EXPECT_EQ(texture.wrap_u, pipeline::Wrap::clamp);
    EXPECT_EQ(texture.wrap_v, pipeline::Wrap::mirror);
    EXPECT_EQ(texture.min_filter, pipeline::Filter::linear_mip_linear);
    EXPECT_EQ(texture.mag_filter, pipeline::Filter::nearest);
    EXPECT_EQ(scene.resources->materials[0].base_texture, 0);
    EXPECT_EQ(scene.resources->materials[0].texcoord, 1U);
    EXPECT_NE(only_geometry(scene).find(Semantic::texcoord1), nullptr);
}

TEST(GltfImport, TextureTransformsScaleThenTurnThenMove) {
    GltfFile file = textured_file();
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] =
        json::parse(R"({"offset": [0.5, 0.25], "rotation": 1.5707963267948966, "scale": [2, 3], "texCoord": 0})");
    const Scene scene = file.load();
    const pipeline::Material& material = scene.resources->materials[0];
    EXPECT_EQ(material.texcoord, 0U);
    const glm::vec3 u = material.uv_transform * glm::vec3(1, 0, 1), v = material.uv_transform * glm::vec3(0, 1, 1);
    EXPECT_NEAR(glm::distance(u, glm::vec3(0.5F, -1.75F, 1)), 0.0F, 1e-6F); // counter-clockwise as seen, v points down
    EXPECT_NEAR(glm::distance(v, glm::vec3(3.5F, 0.25F, 1)), 0.0F, 1e-6F);
}

TEST(GltfImport, ImagesThatNoBaseColourUsesAreNotDecoded) {
    GltfFile file = textured_file();
    file.json["images"].push_back({{"uri", "data:image/png;base64,AAAA"}});
    file.json["textures"].push_back({{"source", 1}});
    file.json["materials"][0]["normalTexture"]["index"] = 1;
    EXPECT_EQ(file.load().resources->textures.size(), 1U);
}

TEST(GltfImport, LightsAndCamerasStandWhereTheirNodesAre) {
    GltfFile file = triangle_file();
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 7}, {"spot", json::object()}}};
    file.json["cameras"] = json::parse(R"([
        {"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.5, "zfar": 9}},
        {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 3, "znear": 0, "zfar": 4}}])");
    file.json["nodes"] = json::parse(R"([{"mesh": 0}, {"camera": 1, "translation": [0, 0, 5], "scale": [3, 3, 3]},
        {"camera": 0}, {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}}])");
    file.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
    const Scene scene = file.load();
    ASSERT_EQ(scene.cameras.size(), 2U); // in the order of the file's cameras, not of its nodes
    EXPECT_FALSE(scene.cameras[0].orthographic);
    EXPECT_TRUE(scene.cameras[1].orthographic);
    EXPECT_EQ(scene.cameras[1].to_world[2], glm::vec4(0, 0, 1, 0)); // the node's scale is not the camera's
    EXPECT_EQ(scene.cameras[1].to_world[3], glm::vec4(0, 0, 5, 1));
    ASSERT_EQ(scene.lights.size(), 1U);
    EXPECT_EQ(scene.lights[0].kind, traces::LightKind::spot);
    EXPECT_EQ(scene.lights[0].intensity, 7.0F);
    EXPECT_EQ(scene.lights[0].to_world[3], glm::vec4(1, 2, 3, 1));
}

TEST(GltfImport, UnreadOptionalExtensionsAreNoted) {
    GltfFile file = triangle_file();
    file.json["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_unlit"};
    const Scene scene = file.load();
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_EQ(scene.notes[0], "extension KHR_materials_sheen is not read");
}

} // namespace
