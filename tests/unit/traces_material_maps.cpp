// Maps of materials: what the glTF reader takes of a file, what it refuses, and the formulas behind them.
#include "pipeline/functional/number_formats.hpp"
#include "sim/check.hpp"
#include "tests/support/scene_files.hpp"
#include "tests/support/trace_files.hpp"
#include "traces/deferred/emission.hpp"
#include "traces/deferred/material_reads.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace traces_material_maps_test {

using nlohmann::json;
using pipeline::MaterialMaps;
using traces::phong_power;
using traces::tilted;

// Red, green; blue, transparent white.
constexpr const char* image_2x2 =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAE0lEQVR42mP4z8DwHwyBNAgwAABIyQj4xTT9BQAAAABJRU5E"
    "rkJggg==";

support::GltfFile file_with(const char* material) {
    support::GltfFile file = support::triangle_file();
    const int coordinates = file.add({0, 0, 1, 0, 0, 1}, "VEC2");
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = coordinates;
    primitive["material"] = 0;
    file.json["images"] = {{{"uri", image_2x2}}};
    file.json["samplers"] = json::parse(R"([{"wrapS": 33071, "wrapT": 33648, "minFilter": 9987, "magFilter": 9728}])");
    file.json["textures"] = json::parse(R"([{"source": 0, "sampler": 0}, {"source": 0}])");
    file.json["materials"] = json::array({json::parse(material)});
    return file;
}

MaterialMaps maps_of(const char* material) { return file_with(material).load().resources->materials.at(0).maps; }

TEST(MaterialMaps, AMaterialWithoutAnyStatesNothing) {
    EXPECT_EQ(maps_of("{}"), MaterialMaps{});
    EXPECT_EQ(maps_of(R"({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 1}})"), MaterialMaps{});
    EXPECT_FALSE(MaterialMaps{}.shines());
    EXPECT_FALSE(MaterialMaps{}.glows());
    EXPECT_TRUE(maps_of(R"({"pbrMetallicRoughness": {"roughnessFactor": 0.5}})").shines());
    EXPECT_TRUE(maps_of(R"({"emissiveFactor": [0, 0, 0.5]})").glows());
    EXPECT_FALSE(maps_of(R"({"emissiveTexture": {"index": 0}})").glows()); // times a factor of 0
}

TEST(MaterialMaps, EachPropertyOfAFileIsKept) {
    const auto scene = file_with(R"({"normalTexture": {"index": 0, "scale": 2.5, "texCoord": 1},
        "emissiveTexture": {"index": 0}, "emissiveFactor": [0.25, 0.5, 0.75],
        "pbrMetallicRoughness": {"metallicFactor": 0.125, "roughnessFactor": 0.625, "metallicRoughnessTexture":
            {"index": 1, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25], "texCoord": 1}}}},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0.375, "specularTexture":
            {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 3]}}}}}})")
                           .load();
    const MaterialMaps& maps = scene.resources->materials.at(0).maps;
    EXPECT_EQ(maps.normal_scale, 2.5F);
    EXPECT_EQ(maps.normal.texcoord, 1U);
    EXPECT_EQ(maps.emissive_factor, glm::vec3(0.25F, 0.5F, 0.75F));
    EXPECT_EQ(maps.metallic_factor, 0.125F);
    EXPECT_EQ(maps.roughness_factor, 0.625F);
    EXPECT_EQ(maps.roughness.texcoord, 1U);
    EXPECT_EQ(maps.roughness.uv_transform[2], glm::vec3(0.5F, 0.25F, 1.0F));
    EXPECT_EQ(maps.specular_factor, 0.375F);
    EXPECT_EQ(maps.specular.uv_transform[1].y, 3.0F);
    EXPECT_EQ(maps.specular.texture, maps.normal.texture);  // one image, sampler and encoding
    EXPECT_NE(maps.roughness.texture, maps.normal.texture); // another sampler
    EXPECT_NE(maps.emissive.texture, maps.normal.texture);  // another encoding
    EXPECT_EQ(scene.resources->maps.size(), 3U);
    EXPECT_TRUE(scene.resources->textures.empty());
    EXPECT_TRUE(maps.read(0) && maps.read(1));
}

TEST(MaterialMaps, TexelsAreMadeWhenSomebodyAsks) {
    const auto scene = file_with(R"({"normalTexture": {"index": 0}})").load();
    EXPECT_TRUE(scene.resources->maps.at(0).texture.levels.empty());
    const pipeline::Texture& texture = scene.resources->read_map(0);
    ASSERT_EQ(texture.levels.size(), 2U);
    EXPECT_FALSE(texture.srgb);
    EXPECT_EQ(texture.levels[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, //
                                                                 0, 0, 255, 255, 255, 255, 255, 0}));
    EXPECT_EQ(texture.wrap_v, pipeline::Wrap::mirror);
    EXPECT_EQ(&scene.resources->read_map(0), &texture);
}

TEST(MaterialMaps, BadOnesAreToldWithTheirPlace) {
    EXPECT_EQ(file_with(R"({"normalTexture": {"index": 2}})").error(),
              "scene.gltf: materials[0].normalTexture.index: expected the number of one of 2 textures, got 2");
    EXPECT_EQ(file_with(R"({"normalTexture": {}})").error(),
              "scene.gltf: materials[0].normalTexture.index: expected the number of one of 2 textures, got nothing");
    EXPECT_EQ(file_with(R"({"emissiveFactor": [0, 0, 2]})").error(),
              "scene.gltf: materials[0].emissiveFactor[2]: expected a number from 0 to 1, got 2");
    EXPECT_EQ(file_with(R"({"pbrMetallicRoughness": {"roughnessFactor": -1}})").error(),
              "scene.gltf: materials[0].pbrMetallicRoughness.roughnessFactor: expected a number from 0 to 1, got -1");
    EXPECT_EQ(
        file_with(R"({"extensions": {"KHR_materials_specular": {"specularFactor": 3}}})").error(),
        "scene.gltf: materials[0].extensions.KHR_materials_specular.specularFactor: expected a number from 0 to 1, "
        "got 3");
    const auto scene = file_with(R"({"normalTexture": {"index": 0, "texCoord": 2}})").load();
    EXPECT_FALSE(scene.resources->materials.at(0).maps.normal.there());
    EXPECT_EQ(scene.notes.size(), 1U);
}

TEST(MaterialMaps, ThoseOfResourcesAreInRange) {
    auto scene = file_with(R"({"normalTexture": {"index": 0}})").load();
    MaterialMaps& maps = scene.resources->materials.at(0).maps;
    maps.emissive.texture = 1;
    EXPECT_THROW(scene.resources->validate("test"), sim::InputError);
    maps.emissive.texture = 0;
    scene.resources->validate("test");
    maps.normal_scale = std::numeric_limits<float>::infinity();
    EXPECT_THROW(scene.resources->validate("test"), sim::InputError);
}

// The last record of the chunk is 196 bytes long and begins with the number of its material.
TEST(MaterialMaps, ATraceHasThemForMaterialsThatItHas) {
    traces::Trace trace = support::rich_trace();
    pipeline::Texture texture;
    texture.levels.push_back({1, 1, {128, 128, 255, 255}, 0});
    trace.scene.resources->maps.push_back({texture});
    MaterialMaps& maps = trace.scene.resources->materials.at(0).maps;
    maps.normal = {0, 1, glm::mat3(2.0F)};
    maps.emissive_factor = {0.25F, 0.5F, 0.75F};
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "maps.rtrace";
    traces::write_trace(trace, file);
    const traces::Trace again = traces::read_trace(file);
    EXPECT_EQ(again.scene.resources->materials.at(0).maps, maps);
    EXPECT_EQ(again.scene.resources->maps.at(0).texture.levels.at(0).rgba, texture.levels[0].rgba);

    std::vector<support::Chunk> chunks = support::chunks_in(file);
    const auto chunk = std::find_if(chunks.begin(), chunks.end(),
                                    [](const support::Chunk& one) { return one.type == traces::rtrace::chunk::maps; });
    ASSERT_NE(chunk, chunks.end());
    chunk->content.at(chunk->content.size() - 196) = std::byte{200};
    EXPECT_NE(support::refusal_of(support::file_of(chunks)).find("chunk MAPS: expected numbers of "),
              std::string::npos);
    chunks.erase(chunk);
    EXPECT_EQ(support::refusal_of(support::file_of(chunks)), ""); // nothing is stated then
}

// A quarter of 2 / roughness^4 - 2, from 1 to 255.
TEST(MaterialMaps, RoughnessIsAPowerOfPhongsLobe) {
    EXPECT_EQ(phong_power(1.0F), 1.0F); // of 0
    EXPECT_NEAR(phong_power(std::sqrt(0.5F)), 1.5F, 1e-5F);
    EXPECT_NEAR(phong_power(0.5F), 7.5F, 1e-5F);
    EXPECT_NEAR(phong_power(0.25F), 127.5F, 1e-4F);
    EXPECT_EQ(phong_power(0.2F), 255.0F); // of 312
    EXPECT_EQ(phong_power(0.0F), 255.0F);
}

// The lobes agree where they fall: half the angle, a quarter of the exponent (small angles).
TEST(MaterialMaps, AQuarterOfBlinnsExponentIsPhongs) {
    for (const double blinn : {32.0, 128.0, 1000.0}) {
        const double angle = 2.0 * std::acos(std::pow(0.5, 1.0 / blinn)); // where Blinn's lobe is one half
        EXPECT_NEAR(std::pow(std::cos(angle), blinn / 4.0), 0.5, 1.5 / blinn);
    }
}

glm::vec4 texel(int r, int g, int b) {
    const auto& table = pipeline::unorm8_decode_table();
    return {table[static_cast<std::size_t>(r)], table[static_cast<std::size_t>(g)], table[static_cast<std::size_t>(b)],
            1.0F};
}

TEST(MaterialMaps, ATexelOf128LeavesANormalAsItIs) {
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3F, -0.7F, 0.2F));
    const glm::vec4 tangent(1.0F, 0.0F, 0.0F, -1.0F);
    EXPECT_EQ(tilted(normal, tangent, texel(128, 128, 255), 1.0F), normal);
    EXPECT_EQ(tilted(normal, tangent, texel(9, 200, 255), 0.0F), normal);
    EXPECT_EQ(tilted(normal, glm::vec4(0.0F), texel(9, 200, 255), 1.0F), normal);         // no tangent
    EXPECT_EQ(tilted(normal, glm::vec4(normal, 1.0F), texel(9, 200, 255), 1.0F), normal); // none across
    EXPECT_EQ(tilted(glm::vec3(0.0F), tangent, texel(9, 200, 255), 1.0F), glm::vec3(0.0F));
}

TEST(MaterialMaps, ATiltIsWithinTheFrameOfNormalAndTangent) {
    const glm::vec3 up(0.0F, 0.0F, 1.0F);
    const glm::vec3 leaning = tilted(up, {1.0F, 0.0F, 0.0F, 1.0F}, texel(204, 128, 229), 1.0F);
    EXPECT_NEAR(leaning.x / leaning.z, 76.0F / 101.0F, 1e-6F);
    EXPECT_EQ(leaning.y, 0.0F);
    EXPECT_NEAR(glm::length(leaning), 1.0F, 1e-6F);
    for (const float sign : {1.0F, -1.0F}) // cross(z, x) = y
        EXPECT_NEAR(tilted(up, {1.0F, 0.0F, 0.0F, sign}, texel(128, 204, 229), 1.0F).y, sign * 0.60126F, 1e-4F);
    // A tangent that is not orthogonal is made so.
    EXPECT_NEAR(tilted(up, {0.6F, 0.0F, 0.8F, 1.0F}, texel(204, 128, 229), 1.0F).x, leaning.x, 1e-6F);
    EXPECT_EQ(tilted(up, {1.0F, 0.0F, 0.0F, 1.0F}, texel(255, 128, 128), 1.0F), glm::vec3(1.0F, 0.0F, 0.0F));
    EXPECT_NEAR(tilted(up, {1.0F, 0.0F, 0.0F, 1.0F}, texel(1, 128, 128), 1.0F).x, -1.0F, 1e-6F);
    EXPECT_EQ(tilted(up, {1.0F, 0.0F, 0.0F, 1.0F}, texel(0, 128, 128), 1.0F), glm::vec3(-1.0F, 0.0F, 0.0F));
}

TEST(MaterialMaps, EmissionTravelsInTheBitsThatAreFree) {
    for (std::uint32_t code = 0; code < 65536; code += 7) {
        const glm::vec3 light = traces::emission_of_16(code);
        ASSERT_EQ(traces::emission_16(light), code);
        ASSERT_EQ(traces::emission_16(traces::emission_of_channels(traces::emission_channels(light))), code);
    }
    for (std::uint32_t code = 0; code < 4096; ++code)
        ASSERT_EQ(traces::emission_12(traces::emission_of_12(code)), code);
    EXPECT_EQ(traces::emission_16(glm::vec3(2.0F, -1.0F, 1.0F)), 31U << 11U | 31U);
}

} // namespace traces_material_maps_test
