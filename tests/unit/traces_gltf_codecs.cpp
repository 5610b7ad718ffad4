// Compressed parts of glTF files: decoded in a child process, refused by name where they are not what they say.
#include "pipeline/functional/vertex_fetch.hpp"
#include "ropsim_build.hpp"
#include "sim/check.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/child_process.hpp"

#include <cstdlib>
#include <cstring>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

namespace gltf_codecs_test {

using nlohmann::json;
using support::GltfFile;
using support::position_at;
using traces::Scene;

std::string from_base64(std::string_view text) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned group = 0, bits = 0;
    for (const char letter : text) {
        group = group << 6U | static_cast<unsigned>(letters.find(letter));
        bits += 6;
        if (bits >= 8) bytes += static_cast<char>(group >> (bits -= 8) & 0xffU);
    }
    return bytes;
}

bool has_module(const char* file) { return ropsim_build::find_module(file).has_value(); }

// The square (0,0) (1,0) (1,1) (0,1) in two triangles, as draco_encoder writes it: positions of 14 bits, attribute 0.
constexpr std::string_view draco_square =
    "RFJBQ08CAgEAAAACBAEAAQIAAgMBAQAJAwAAAgABAQADAwEwARADADSCiAQAAAAA/z8AAAAAAAAAAAAAAAAAAAAAgD8O";

GltfFile draco_file() {
    GltfFile file;
    const int view = file.add_view(from_base64(draco_square));
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    file.json["accessors"] = json::parse(R"([{"componentType": 5126, "count": 4, "type": "VEC3"},
                                             {"componentType": 5123, "count": 6, "type": "SCALAR"}])");
    file.json["meshes"] = json::parse(R"([{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1,
        "extensions": {"KHR_draco_mesh_compression": {"attributes": {"POSITION": 0}}}}]}])");
    file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = view;
    file.json["nodes"] = json::parse(R"([{"mesh": 0}])");
    file.json["scenes"] = json::parse(R"([{"nodes": [0]}])");
    return file;
}

TEST(GltfDraco, MeshesAreDecodedIntoTheirAccessors) {
    if (!has_module("ropsim_draco.so")) GTEST_SKIP() << "built without Draco";
    const Scene scene = draco_file().load();
    EXPECT_EQ(scene.triangles_drawn, 2U);
    EXPECT_EQ(scene.resources->geometries[0].index_type, pipeline::IndexType::u16);
    EXPECT_EQ(scene.lo, glm::vec3(0.0F));
    EXPECT_EQ(scene.hi, glm::vec3(1.0F, 1.0F, 0.0F));
    EXPECT_TRUE(scene.notes.empty());
}

TEST(GltfDraco, WhatIsNotAsTheFileSaysIsRefusedByName) {
    if (!has_module("ropsim_draco.so")) GTEST_SKIP() << "built without Draco";
    const std::string place = "scene.gltf: meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: ";
    GltfFile file = draco_file();
    file.json["accessors"][0]["count"] = 5;
    EXPECT_EQ(file.error(), place + "expected data that can be decoded: it has 4 points and 6 indices");
    file = draco_file();
    file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 7;
    EXPECT_EQ(file.error(), place + "expected data that can be decoded: it has no attribute 7");
    file = draco_file();
    file.json["bufferViews"][0]["byteLength"] = 20;
    EXPECT_TRUE(file.error().starts_with(place + "expected data that can be decoded: ")) << file.error();
    file = draco_file();
    file.json["meshes"][0]["primitives"][0].erase("indices");
    EXPECT_EQ(file.error(), place + "expected a primitive with indices");
}

// Every prefix, and every byte changed: never more than one line.
TEST(GltfDraco, BrokenDataNeverDoMoreThanAnError) {
    if (!has_module("ropsim_draco.so")) GTEST_SKIP() << "built without Draco";
    const std::string good = from_base64(draco_square);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < good.size(); i += 3) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 0x5a);
        GltfFile file = draco_file();
        file.json["bufferViews"] = json::array();
        file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 0;
        file.add_view(bad);
        file.json["bufferViews"][0]["byteLength"] = bad.size();
        const std::string error = file.error();
        refused += error.empty() ? 0 : 1;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
    EXPECT_GT(refused, 3U);
}

// One triangle whose positions and indices are compressed; the buffer behind the views has no data.
GltfFile meshopt_file() {
    const std::vector<float> positions{0, 0, 0, 2, 0, 0, 0, 3, 0};
    const std::vector<unsigned> indices{0, 1, 2};
    std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(3, 12));
    vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), 3, 12));
    std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(3, 3));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), 3));
    GltfFile file;
    const auto add = [&](const std::vector<unsigned char>& bytes) {
        return file.add_view({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    add(vertices);
    add(triangles);
    json& views = file.json["bufferViews"];
    const auto compressed = [&](std::size_t view, std::size_t count, std::size_t stride, const char* mode) {
        json source = views[view];
        source["count"] = count;
        source["byteStride"] = stride;
        source["mode"] = mode;
        views[view] = {{"buffer", 1}, {"byteOffset", 0}, {"byteLength", count * stride}};
        views[view]["extensions"]["EXT_meshopt_compression"] = source;
    };
    compressed(0, 3, 12, "ATTRIBUTES");
    compressed(1, 3, 2, "TRIANGLES");
    views[0]["byteStride"] = 12;
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    file.json["accessors"] = json::parse(R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                                             {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}])");
    file.json["meshes"] = json::parse(R"([{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}])");
    file.json["nodes"] = json::parse(R"([{"mesh": 0}])");
    file.json["scenes"] = json::parse(R"([{"nodes": [0]}])");
    return file;
}

GltfFile with_fallback(GltfFile file) {
    const json written = json::parse(file.text());
    file.json["buffers"] = written["buffers"];
    file.json["buffers"].push_back({{"byteLength", 64}});
    file.json["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    return file;
}

TEST(GltfMeshopt, BufferViewsAreDecoded) {
    if (!has_module("ropsim_meshopt.so")) GTEST_SKIP() << "built without the module";
    // The table wants buffer 1 to exist before the text can be made, so that it is added behind.
    const Scene scene = with_fallback(meshopt_file()).load();
    EXPECT_EQ(scene.triangles_drawn, 1U);
    EXPECT_EQ(position_at(scene, 0, 1), glm::vec3(2, 0, 0));
    EXPECT_EQ(position_at(scene, 0, 2), glm::vec3(0, 3, 0));
}

TEST(GltfMeshopt, WhatIsNotAsTheFileSaysIsRefusedByName) {
    if (!has_module("ropsim_meshopt.so")) GTEST_SKIP() << "built without the module";
    const std::string place = "scene.gltf: bufferViews[0].extensions.EXT_meshopt_compression: ";
    const auto error_with = [](const char* key, const json& value) {
        GltfFile file = with_fallback(meshopt_file());
        file.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
        return file.error();
    };
    EXPECT_EQ(error_with("count", 4),
              place + "expected count times byteStride to be the bufferView's byteLength 36, got 48");
    EXPECT_EQ(error_with("byteLength", 9),
              place + "expected data that can be decoded: its data ends early or is of another kind");
    EXPECT_EQ(error_with("filter", "QUATERNION"),
              place + "expected data that can be decoded: filter QUATERNION needs a byteStride of 8");
    EXPECT_EQ(error_with("mode", "VERTICES"),
              "scene.gltf: bufferViews[0].extensions.EXT_meshopt_compression.mode: expected one of \"ATTRIBUTES\", "
              "\"TRIANGLES\", \"INDICES\", got \"VERTICES\"");
}

TEST(GltfChildProcess, BringsBackWhatTheChildWroteOrWhyNot) {
    using traces::in_child_process;
    const auto good = in_child_process(3, [](std::span<unsigned char> out, std::span<char>) {
        std::memcpy(out.data(), "abc", 3);
        return 0;
    });
    EXPECT_EQ(std::string(good.bytes.begin(), good.bytes.end()), "abc");
    EXPECT_EQ(good.failure, "");
    const auto told = in_child_process(3, [](std::span<unsigned char>, std::span<char> line) {
        std::strcpy(line.data(), "no\nsuch thing");
        return 1;
    });
    EXPECT_EQ(told.failure, "no such thing");
    const auto crash = in_child_process(3, [](std::span<unsigned char>, std::span<char>) -> int { std::abort(); });
    EXPECT_TRUE(crash.failure.starts_with("the library ended with signal 6")) << crash.failure;
    const auto thrown = in_child_process(3, [](std::span<unsigned char>, std::span<char>) -> int { throw 1; });
    EXPECT_EQ(thrown.failure, "the library failed");
}

// Two by two texels of red, green, blue and white, lossy.
constexpr const char* webp_2x2 =
    "data:image/webp;base64,UklGRkwAAABXRUJQVlA4IEAAAAAQAgCdASoCAAIAAAAAJaQADqAPw5NCld8AAP7//qnH/7/V/4uX/91Zaf/n/f/"
    "53q1AiVOsd/6wD/8NQP2AAAAA";

GltfFile image_file(const char* uri) {
    GltfFile file = support::triangle_file();
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = file.add({0, 0, 1, 0, 0, 1}, "VEC2");
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.json["images"] = {{{"uri", uri}}};
    file.json["textures"] = json::parse(R"([{"extensions": {"EXT_texture_webp": {"source": 0}}}])");
    file.json["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    return file;
}

TEST(GltfTextures, WebpIsDecodedWhenItIsRead) {
    if (!has_module("ropsim_textures.so")) GTEST_SKIP() << "built without images";
    const Scene scene = image_file(webp_2x2).load();
    const pipeline::Texture& texture = scene.resources->textures.at(0);
    EXPECT_TRUE(texture.levels[0].rgba.empty());
    scene.resources->read_textures();
    ASSERT_EQ(texture.levels[0].rgba.size(), 16U);
    EXPECT_EQ(texture.levels[0].rgba[3], 255);
    EXPECT_EQ(texture.levels.size(), 2U);
}

TEST(GltfTextures, OtherKindsAreNamed) {
    EXPECT_EQ(image_file("data:image/ktx2;base64,q0tUWCAyMLsNChoKAAAAAAAAAAAA").error(),
              "scene.gltf: images[0]: expected PNG, JPEG or WebP data, got KTX2 (Basis Universal), which no package of "
              "Debian 12 decodes");
    GltfFile basis = image_file("data:,");
    basis.json["textures"] = json::parse(R"([{"extensions": {"KHR_texture_basisu": {"source": 0}}}])");
    const Scene scene = basis.load();
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_EQ(scene.notes[0], "texture 0 has no PNG, JPEG or WebP image (KTX2 is not read) and is left out");
}

// The header of a PNG of 16384 x 16384 texels with nothing behind it.
TEST(GltfTextures, LargeOnesCostNothingUntilTheyAreRead) {
    GltfFile file = image_file("");
    file.json["textures"] = json::parse(R"([{"source": 0}, {"source": 1}])");
    const int view = file.add_view(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x40\0\0\0\x40\0\x08\6\0\0\0", 29));
    file.json["images"] = json::array({{{"bufferView", view}}, {{"bufferView", view}}});
    const Scene one = file.load();
    EXPECT_EQ(one.resources->textures.at(0).levels.size(), 15U);
    file.json["materials"].push_back(json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}})"));
    file.json["meshes"][0]["primitives"].push_back(file.json["meshes"][0]["primitives"][0]);
    file.json["meshes"][0]["primitives"][1]["material"] = 1;
    const Scene two = file.load();
    try {
        two.resources->read_textures();
        FAIL() << "more than 2 GiB of texels";
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(), "textures: expected at most 2048 MiB of texels, got 2730 MiB in 2 textures");
    }
}

} // namespace gltf_codecs_test
