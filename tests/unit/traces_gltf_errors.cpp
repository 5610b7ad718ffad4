// Files that are not what they should be: one line that names place and expectation, and nothing worse.
#include "sim/check.hpp"
#include "sim/random.hpp"
#include "tests/support/scene_files.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace {

using nlohmann::json;
using support::GltfFile;
using support::triangle_file;

std::string error_after(const std::function<void(GltfFile&)>& change) {
    GltfFile file = triangle_file();
    change(file);
    return file.error();
}

std::string error_of_bytes(const std::string& bytes) {
    const support::TemporaryFolder folder;
    return support::load_error(folder.write("scene.glb", bytes).string(), folder.path());
}

TEST(GltfErrors, FilesThatAreNoScenes) {
    EXPECT_EQ(support::load_error("nowhere/none.gltf"), "nowhere/none.gltf: there is no such file");
    EXPECT_EQ(support::load_error("."), ".: expected a file, got a folder");
    EXPECT_EQ(error_of_bytes(""), "scene.glb: parse error at line 1, column 1: syntax error while parsing value - "
                                  "unexpected end of input; expected '[', '{', or a literal");
    EXPECT_EQ(error_of_bytes("[1, 2]"), "scene.glb: JSON: expected an object");
    EXPECT_EQ(error_of_bytes(R"({"asset": {"version": "1.0"}})"),
              "scene.glb: asset.version: expected \"2.0\", got \"1.0\"");
    EXPECT_EQ(error_of_bytes(R"({"asset": {"version": "2.0"}})"),
              "scene.glb: expected at least one triangle to draw (nodes in the scene, with primitives of mode 4 to 6, "
              "whose attributes have a POSITION, with a count of 3 or more)");
}

TEST(GltfErrors, ContainersWithWrongLengths) {
    const std::string good = triangle_file().binary();
    const auto patched = [&](std::size_t offset, std::uint32_t value) {
        std::string bytes = good;
        bytes.replace(offset, 4, reinterpret_cast<const char*>(&value), 4);
        return error_of_bytes(bytes);
    };
    EXPECT_EQ(error_of_bytes(good), "");
    EXPECT_EQ(error_of_bytes(good.substr(0, 12)), "scene.glb: header: expected at least 20 bytes, got 12");
    EXPECT_EQ(patched(4, 1), "scene.glb: header: expected version 2, got 1");
    EXPECT_EQ(patched(8, 0x7fffffff), "scene.glb: header: expected a file of 2147483647 bytes, got " +
                                          std::to_string(good.size()) + ": it is cut off");
    EXPECT_EQ(patched(12, 0xfffffff0), "scene.glb: chunk at byte 12: expected at most " +
                                           std::to_string(good.size() - 20) + " bytes, got 4294967280");
    EXPECT_EQ(patched(16, 0), "scene.glb: chunk at byte 12: expected type JSON");
}

TEST(GltfErrors, EveryTruncationOfAContainerIsRefused) {
    const std::string good = triangle_file().binary();
    for (std::size_t length = 0; length < good.size(); ++length) {
        const std::string error = error_of_bytes(good.substr(0, length));
        EXPECT_NE(error, "") << length;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
}

TEST(GltfErrors, RequiredExtensionsAreNamed) {
    const auto with = [](const char* name) {
        return error_after([&](GltfFile& file) { file.json["extensionsRequired"] = {name}; });
    };
    EXPECT_EQ(
        error_after([&](GltfFile& file) {
            file.json["extensionsRequired"] = {"KHR_materials_volume", "KHR_texture_transform", "ACME_unheard_of"};
        }),
        "scene.gltf: extensionsRequired: expected extensions that ropsim reads, got KHR_materials_volume (`assimp "
        "export FILE OUT.glb` (Debian: assimp-utils) writes a file without), ACME_unheard_of");
    EXPECT_EQ(with("ACME_unheard_of"),
              "scene.gltf: extensionsRequired: expected extensions that ropsim reads, got ACME_unheard_of");
    EXPECT_EQ(with("KHR_texture_transform"), "");
}

TEST(GltfErrors, AccessorsBeyondTheirData) {
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["accessors"][0]["count"] = 4; }),
              "scene.gltf: mesh 0 primitive 0 POSITION: expected a count of 4 elements of 12 bytes, 12 apart, from "
              "byteOffset 0 within "
              "bufferView 0 of byteLength 36");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["accessors"][0]["byteOffset"] = 40; }),
              "scene.gltf: mesh 0 primitive 0 POSITION: expected a count of 3 elements of 12 bytes, 12 apart, from "
              "byteOffset 40 within "
              "bufferView 0 of byteLength 36");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["bufferViews"][0]["byteLength"] = 48; }),
              "scene.gltf: bufferViews[0]: expected byteLength 48 from byteOffset 0 within buffer 0 of 36 bytes");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["bufferViews"][0]["byteStride"] = 4; }),
              "scene.gltf: mesh 0 primitive 0 POSITION: expected a byteStride of 12 to 252 in bufferView 0, got 4");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["bufferViews"][0]["buffer"] = 7; }),
              "scene.gltf: bufferViews[0].buffer: expected the number of one of 1 buffers, got 7");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["accessors"][0]["bufferView"] = 9; }),
              "scene.gltf: accessors[0].bufferView: expected the number of one of 1 bufferViews, got 9");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["accessors"][0]["count"] = 2000000000; }),
              "scene.gltf: mesh 0 primitive 0 POSITION: expected a count of 2000000000 elements of 12 bytes, 12 apart, "
              "from byteOffset 0 "
              "within bufferView 0 of byteLength 36");
    EXPECT_EQ(
        error_after([](GltfFile& file) {
            file.json["accessors"][0].erase("bufferView");
            file.json["accessors"][0]["count"] = 2000000000;
        }),
        "scene.gltf: mesh 0 primitive 0 POSITION: expected at most 4194304 elements without data, got 2000000000");
}

TEST(GltfErrors, AccessorsOfTheWrongType) {
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["accessors"][0]["type"] = "VEC2"; }),
              "scene.gltf: mesh 0 primitive 0 POSITION: expected 3 components, got 2");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["accessors"][0]["componentType"] = 5130; }),
              "scene.gltf: accessors[0].componentType: expected one of 5120, 5121, 5122, 5123, 5125, 5126, got 5130");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["accessors"][0]["count"] = "three"; }),
              "scene.gltf: accessors[0].count: expected a whole number from 1 to 2147483647, got \"three\"");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["accessors"][0]["count"] = -3; }),
              "scene.gltf: accessors[0].count: expected a whole number from 1 to 2147483647, got -3");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["nodes"] = json::object(); }),
              "scene.gltf: nodes: expected a list, got {}");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["nodes"] = {1}; }),
              "scene.gltf: nodes[0]: expected an object, got 1");
}

TEST(GltfErrors, AttributesOfDifferentLength) {
    EXPECT_EQ(error_after([](GltfFile& file) {
                  const int normals = file.add({0, 0, 1, 0, 0, 1}, "VEC3");
                  file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
              }),
              "scene.gltf: mesh 0 primitive 0 NORMAL: expected a count of 3 like POSITION, got 2");
}

TEST(GltfErrors, IndicesOutOfRange) {
    EXPECT_EQ(error_after([](GltfFile& file) {
                  const int indices = file.add_integers(std::vector<std::uint16_t>{0, 1, 3}, "SCALAR", 5123);
                  file.json["meshes"][0]["primitives"][0]["indices"] = indices;
              }),
              "scene.gltf: geometry 0 \"mesh 0 primitive 0\": expected index 2 below the vertex count 3, not 3");
    EXPECT_EQ(
        error_after([](GltfFile& file) { file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 5; }),
        "scene.gltf: meshes[0].primitives[0].attributes.POSITION: expected the number of one of 1 accessors, got 5");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["nodes"][0]["mesh"] = 1; }),
              "scene.gltf: nodes[0].mesh: expected the number of one of 1 meshes, got 1");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["meshes"][0]["primitives"][0]["material"] = 0; }),
              "scene.gltf: meshes[0].primitives[0].material: expected the number of one of 0 materials, got 0");
    EXPECT_EQ(error_after([](GltfFile& file) {
                  const int indices = file.add({0, 1, 2}, "SCALAR");
                  file.json["meshes"][0]["primitives"][0]["indices"] = indices;
              }),
              "scene.gltf: mesh 0 primitive 0 indices: expected unsigned integers");
}

TEST(GltfErrors, PositionsThatAreNoNumbers) {
    for (const float bad : {std::nanf(""), INFINITY}) {
        GltfFile file = triangle_file();
        file.add({0, 0, 0, 1, bad, 0, 0, 1, 0}, "VEC3");
        file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 1;
        EXPECT_TRUE(
            file.error().starts_with("scene.gltf: mesh 0 primitive 0: position 1: expected finite numbers, got (1, "))
            << file.error();
    }
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["nodes"][0]["scale"] = {1e38, 1e38, 1e38}; }), "");
    EXPECT_EQ(error_after([](GltfFile& file) {
                  file.json["nodes"][0]["scale"] = {1e39, 1, 1};
              }),
              "scene.gltf: nodes[0].scale[0]: expected a finite number, got 1e+39");
    EXPECT_EQ(error_after([](GltfFile& file) {
                  file.json["nodes"][0]["scale"] = {3e38, 1, 1};
                  file.json["nodes"][0]["translation"] = {3e38, 0, 0};
              }),
              "scene.gltf: expected a bounding box of finite size in world space");
    EXPECT_EQ(error_after([](GltfFile& file) {
                  file.json["nodes"][0]["rotation"] = {0, 1};
              }),
              "scene.gltf: nodes[0].rotation: expected a list of 4, got [0,1]");
}

TEST(GltfErrors, ColoursThatAreNoNumbers) {
    for (const float bad : {std::nanf(""), -INFINITY}) {
        GltfFile file = triangle_file();
        file.add({0, 0, 0, 0, 0, 0, 0, 0, bad}, "VEC3");
        file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 1;
        EXPECT_EQ(file.error(), "scene.gltf: mesh 0 primitive 0: colour 2: expected finite numbers");
    }
    EXPECT_EQ(
        error_after([](GltfFile& file) {
            file.json["materials"] = {
                {{"name", "m"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1e39, 0, 0, 1}}}}}};
            file.json["meshes"][0]["primitives"][0]["material"] = 0;
        }),
        "scene.gltf: materials[0].pbrMetallicRoughness.baseColorFactor[0]: expected a number from 0 to 1, got 1e+39");
}

TEST(GltfErrors, NodesThatAreNoForest) {
    EXPECT_EQ(
        error_after([](GltfFile& file) { file.json["nodes"] = json::parse(R"([{"mesh": 0, "children": [0]}])"); }),
        "scene.gltf: nodes[0].children: expected no cycle of nodes");
    EXPECT_EQ(error_after([](GltfFile& file) {
                  file.json["nodes"] =
                      json::parse(R"([{"children": [1]}, {"children": [2]}, {"mesh": 0, "children": [1]}])");
              }),
              "scene.gltf: nodes[2].children[0]: expected a node that is nobody else's child, got 1");
    EXPECT_EQ(error_after([](GltfFile& file) { file.json["nodes"][0]["children"] = {4}; }),
              "scene.gltf: nodes[0].children[0]: expected the number of one of 1 nodes, got 4");
    EXPECT_EQ(error_after([](GltfFile& file) {
                  file.json["scenes"][0]["nodes"] = {0, 0};
              }),
              "scene.gltf: scenes[0].nodes[1]: expected nothing twice, got 0");
    EXPECT_EQ(error_after([](GltfFile& file) {
                  file.json["nodes"] = json::array();
                  for (int i = 0; i < 20000; ++i) file.json["nodes"].push_back({{"children", {i + 1}}});
                  file.json["nodes"].push_back({{"mesh", 0}});
              }),
              "");
}

TEST(GltfErrors, DeeplyNestedJsonIsRefused) {
    const std::string nested = std::string(100000, '[') + std::string(100000, ']');
    EXPECT_EQ(error_of_bytes(R"({"asset": {"version": "2.0"}, "extras": )" + nested + "}"),
              "scene.glb: JSON: expected at most 64 levels of nesting");
}

TEST(GltfErrors, FilesThatAreMissing) {
    GltfFile file = triangle_file();
    file.json["buffers"] = json::parse(R"([{"byteLength": 36, "uri": "gone.bin"}])");
    EXPECT_EQ(file.error(), "scene.gltf: buffers[0].uri: expected a readable file or base64 data, got 'gone.bin'");

    file = triangle_file();
    file.json["images"] = {{{"uri", "gone.png"}}};
    file.json["textures"] = json::parse(R"([{"source": 0}])");
    file.json["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    EXPECT_EQ(file.error(), ""); // no draw uses it
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_EQ(file.error(),
              "scene.gltf: images[0]: expected a uri of a readable file, or base64 data in it, got 'gone.png'");
    file.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
    EXPECT_EQ(file.error(), "scene.gltf: images[0]: expected PNG, JPEG or WebP data");
}

TEST(GltfErrors, HugeImagesAreRefusedBeforeTheyAreDecoded) {
    GltfFile file = triangle_file();
    std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\1\0\0\0\1\0\0\x08\6\0\0\0", 29);
    const int view = file.add_view(png);
    file.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
    file.json["textures"] = json::parse(R"([{"source": 0}])");
    file.json["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_EQ(file.error(), "scene.gltf: images[0]: expected at most 16384x16384 texels, got 65536x65536");
    file.json["bufferViews"][static_cast<std::size_t>(view)]["byteOffset"] = 2000000000;
    EXPECT_EQ(
        file.error(),
        "scene.gltf: bufferViews[1]: expected byteLength 29 from byteOffset 2000000000 within buffer 0 of 65 bytes");
}

TEST(GltfErrors, SparseElementsOutOfRange) {
    const auto sparse = [](int count, std::uint16_t target) {
        GltfFile file = triangle_file();
        const int indices = file.add_view({reinterpret_cast<const char*>(&target), 2});
        const int values = file.add_view(std::string(12, '\0'));
        file.json["accessors"][0]["sparse"] = {{"count", count},
                                               {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                               {"values", {{"bufferView", values}}}};
        return file.error();
    };
    EXPECT_EQ(sparse(1, 2), "");
    EXPECT_EQ(sparse(1, 3), "scene.gltf: mesh 0 primitive 0 POSITION sparse: expected indices below 3, got 3");
    EXPECT_EQ(sparse(2, 0),
              "scene.gltf: mesh 0 primitive 0 POSITION sparse: expected a count of 2 elements of 2 bytes, 2 apart, "
              "from byteOffset 0 within bufferView 1 of byteLength 2");
    EXPECT_EQ(sparse(9, 0), "scene.gltf: mesh 0 primitive 0 POSITION sparse: expected a count from 1 to 3, got 9");
}

TEST(GltfErrors, SmallFilesCannotAskForEndlessInstances) {
    GltfFile file = triangle_file();
    std::vector<float> places(3 * 100000, 0.0F);
    const int accessor = file.add(places, "VEC3");
    json instancing;
    instancing["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = accessor;
    file.json["nodes"] = json::array();
    file.json["scenes"][0]["nodes"] = json::array();
    for (int i = 0; i < 100; ++i) {
        file.json["nodes"].push_back({{"mesh", 0}, {"extensions", instancing}});
        file.json["scenes"][0]["nodes"].push_back(i);
    }
    EXPECT_EQ(file.error(), "scene.gltf: node 41: expected at most 4194304 instances in all");
}

TEST(GltfErrors, ChangedBytesNeverDoMoreThanAnError) {
    // Every feature at once, then random changes anywhere in the file.
    GltfFile file = triangle_file();
    const int indices = file.add_integers(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123);
    const int places = file.add({0, 0, 0, 5, 0, 0}, "VEC3");
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["indices"] = indices;
    primitive["targets"] = {{{"POSITION", 0}}};
    file.json["meshes"][0]["weights"] = {0.5};
    file.json["nodes"].push_back({{"mesh", 0}});
    file.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    file.json["nodes"][0]["children"] = {1};
    const std::string good = file.binary();
    ASSERT_EQ(error_of_bytes(good), "");

    const support::TemporaryFolder folder;
    sim::Random random(1, "changed bytes");
    std::size_t refused = 0;
    for (int round = 0; round < 1000; ++round) {
        std::string bytes = good;
        for (std::uint64_t change = random.below(4) + 1; change-- > 0;)
            bytes[random.below(bytes.size())] =
                static_cast<char>(random.below(2) == 0 ? '0' + random.below(10) : random.below(256));
        const std::string error = support::load_error(folder.write("scene.glb", bytes).string());
        refused += error.empty() ? 0U : 1U;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
    EXPECT_GT(refused, 300U);
}

} // namespace
