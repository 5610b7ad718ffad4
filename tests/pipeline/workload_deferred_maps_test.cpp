// What deferred shading reads of materials beside their colour (material_reads.hpp): pictures and reads beside numbers
// computed by hand.
#include "pipeline/functional/frame_streams.hpp"
#include "reports/truth/truth.hpp"
#include "sim/check.hpp"
#include "tests/support/frame_surfaces.hpp"
#include "tests/support/ray_kit.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <utility>

namespace workload_deferred_maps_test {

using nlohmann::json;
using pipeline::Material;
using support::colours_named;
using support::Replay;
using support::surfaces_of;
using Settings = std::vector<std::string>;
using Texel = std::array<std::uint8_t, 4>;

constexpr std::array methods{"method=pm", "method=dp", "method=fwd", "method=fw", "method=kg"};
constexpr std::uint32_t side = 33; ///< pixels; the middle one sees the origin

/// A wall of base colour 0.5 in z = 0, 4 units wide, that looks along z, and a spot light 2 units before its middle.
/// Texture coordinates run from 0 to 1, u to the right and v down; `turn` is what they are multiplied by.
support::GltfFile wall_file(const glm::mat2& turn = glm::mat2(1.0F)) {
    support::GltfFile file;
    file.add({-2, 2, 0, 2, 2, 0, -2, -2, 0, 2, -2, 0}, "VEC3");
    file.add({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    std::vector<float> coordinates;
    for (const glm::vec2& at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)}) {
        const glm::vec2 turned = turn * at;
        coordinates.insert(coordinates.end(), {turned.x, turned.y});
    }
    file.add(coordinates, "VEC2");
    file.add_integers(std::vector<std::uint16_t>{0, 2, 3, 0, 3, 1}, "SCALAR", 5123);
    file.json["materials"] =
        json::parse(R"([{"name": "wall", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1]}}])");
    file.json["meshes"] = json::parse(R"([{"primitives": [{"material": 0, "indices": 3,
        "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]}])");
    file.json["extensions"]["KHR_lights_punctual"]["lights"] =
        json::parse(R"([{"type": "spot", "range": 10, "spot": {"innerConeAngle": 0.9, "outerConeAngle": 1.2}}])");
    file.json["nodes"] = json::parse(R"([{"mesh": 0},
        {"translation": [0, 0, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}])");
    file.json["scenes"] = json::parse(R"([{"nodes": [0, 1]}])");
    return file;
}

/// A map of one texel; the number of it.
std::int32_t add_map(traces::Scene& scene, const Texel& texel, bool srgb = false) {
    pipeline::Texture texture;
    texture.name = "one texel";
    texture.srgb = srgb;
    texture.levels.push_back({1, 1, std::vector<std::uint8_t>(texel.begin(), texel.end()), 0});
    scene.resources->maps.push_back({texture});
    return static_cast<std::int32_t>(scene.resources->maps.size()) - 1;
}

Material& material_of(traces::Scene& scene) { return scene.resources->materials.front(); }

Replay drawn(const traces::Scene& scene, Settings settings, std::uint32_t size = side) {
    support::ReplayOptions options;
    options.width = options.height = size;
    options.workload = "deferred";
    options.camera = "0,0,4,0,0,0,40";
    for (const char* usual : {"lights=1", "map_size=64"})
        if (std::none_of(settings.begin(), settings.end(),
                         [&](const std::string& one) { return one.starts_with(std::string(usual).substr(0, 6)); }))
            settings.emplace_back(usual);
    options.knobs = std::move(settings);
    return Replay(scene, options);
}

/// A texel of the middle of the picture.
glm::vec4 middle(const Replay& replay, const std::string& surface) {
    const std::vector<float> texels = colours_named(replay, surfaces_of(replay), surface);
    const float* at = texels.data() + (side / 2 * side + side / 2) * 4;
    return {at[0], at[1], at[2], at[3]};
}

glm::vec3 middle_of_picture(const Replay& replay) { return glm::vec3(middle(replay, "picture")); }

TEST(DeferredMaps, AFlatMapIsAsNone) {
    const traces::Scene bare = wall_file().load();
    traces::Scene mapped = bare;
    mapped.resources = std::make_shared<pipeline::Resources>(*bare.resources);
    material_of(mapped).maps.normal = {add_map(mapped, {128, 128, 255, 255})};
    for (const char* method : methods) {
        const Replay without = drawn(bare, {method}), with = drawn(mapped, {method});
        EXPECT_EQ(with.reference.colour, without.reference.colour) << method;
        EXPECT_NE(with.frame.needs.map_texcoords, without.frame.needs.map_texcoords) << method;
        EXPECT_EQ(with.run("blender").colour, without.reference.colour) << method;
    }
}

TEST(DeferredMaps, WhereNoMapIsReadNothingMoves) {
    const traces::Scene bare = wall_file().load();
    traces::Scene mapped = bare;
    mapped.resources = std::make_shared<pipeline::Resources>(*bare.resources);
    Material& material = material_of(mapped);
    material.maps.normal = {add_map(mapped, {0, 255, 9, 255})};
    material.maps.roughness_factor = 0.25F;
    material.maps.emissive_factor = glm::vec3(1.0F);
    for (const char* method : methods) {
        const Replay without = drawn(bare, {method}), ignored = drawn(mapped, {method, "maps=false"});
        EXPECT_EQ(ignored.frame.surfaces.size(), without.frame.surfaces.size()) << method;
        EXPECT_EQ(support::difference(ignored.run("blender"), without.run("blender")), "") << method;
    }
}

// Codes of the map less 128, over 127: (76, 0, 101) / 127 is (0.60126, 0, 0.79905) at unit length.
TEST(DeferredMaps, ATiltedNormalIsThatOfTheMapInTheFrameOfItsCoordinates) {
    struct Tilt {
        Texel texel;
        glm::mat2 turn;  ///< of the coordinates
        glm::vec3 scale; ///< of the wall's node
        glm::vec2 leans; ///< the normal, on the screen
    };
    const glm::mat2 straight(1.0F), mirrored_u(-1, 0, 0, 1), mirrored_v(1, 0, 0, -1), quarter(0, 1, -1, 0);
    const Texel along_u{204, 128, 229, 255}, against_v{128, 204, 229, 255};
    const glm::vec3 one(1.0F), mirror(-1, 1, 1);
    for (const Tilt& tilt : {Tilt{along_u, straight, one, {1, 0}}, Tilt{against_v, straight, one, {0, 1}},
                             Tilt{{52, 128, 229, 255}, straight, one, {-1, 0}}, Tilt{along_u, mirrored_u, one, {-1, 0}},
                             Tilt{against_v, mirrored_u, one, {0, 1}}, Tilt{along_u, mirrored_v, one, {1, 0}},
                             Tilt{against_v, mirrored_v, one, {0, -1}}, // u' = -v, v' = u of the wall:
                             Tilt{along_u, quarter, one, {0, 1}}, Tilt{against_v, quarter, one, {-1, 0}},
                             Tilt{along_u, straight, mirror, {-1, 0}}, Tilt{against_v, straight, mirror, {0, 1}}}) {
        support::GltfFile file = wall_file(tilt.turn);
        file.json["nodes"][0]["scale"] = {tilt.scale.x, tilt.scale.y, tilt.scale.z};
        traces::Scene scene = file.load();
        material_of(scene).maps.normal = {add_map(scene, tilt.texel)};
        const Replay replay = drawn(scene, {"method=dp", "ambient=0", "specular=0", "shadows=none"});
        const glm::vec3 normal = glm::vec3(middle(replay, "normals")) * 2.0F - 1.0F;
        const glm::vec3 expected(0.60126F * tilt.leans, 0.79905F);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(normal[i], expected[i], 2.0F / 1023.0F)
                << i << " of " << tilt.leans.x << ' ' << tilt.leans.y << ' ' << tilt.turn[0][0] << tilt.turn[0][1];
        // Light comes straight on, (1 - 2/10)^2 of it: the cosine is the normal's z.
        EXPECT_NEAR(middle(replay, "light").r, 0.64F * 0.79905F, 2.0F / 255.0F);
    }
}

TEST(DeferredMaps, AScaledNormalLeansMore) {
    traces::Scene scene = wall_file().load();
    material_of(scene).maps.normal = {add_map(scene, {204, 128, 229, 255})};
    material_of(scene).maps.normal_scale = 0.5F;
    const glm::vec3 normal = glm::vec3(middle(drawn(scene, {"method=dp"}), "normals")) * 2.0F - 1.0F;
    EXPECT_NEAR(normal.x / normal.z, 0.5F * 76.0F / 101.0F, 0.005F);
}

TEST(DeferredMaps, RoughnessIsThePowerAndStrengthAndMetalTheIntensity) {
    const auto specular = [](const pipeline::MaterialMaps& maps) {
        traces::Scene scene = wall_file().load();
        material_of(scene).maps = maps;
        return glm::ivec2(
            glm::round(glm::vec2(middle(drawn(scene, {"method=dp", "specular=0.8"}), "specular")) * 255.0F));
    };
    const auto factors = [](float metallic, float roughness, float strength) {
        pipeline::MaterialMaps maps;
        maps.metallic_factor = metallic;
        maps.roughness_factor = roughness;
        maps.specular_factor = strength;
        return maps;
    };
    EXPECT_EQ(specular({}), glm::ivec2(204, 32)); // nothing is stated
    EXPECT_EQ(specular(factors(0.0F, 1.0F, 1.0F)), glm::ivec2(204, 1));
    EXPECT_EQ(specular(factors(0.0F, 0.0F, 1.0F)), glm::ivec2(204, 255));
    // alpha^2 = 1/16: a quarter of 2 * 16 - 2
    EXPECT_EQ(specular(factors(0.0F, 0.5F, 0.5F)).x, 102);
    EXPECT_NEAR(specular(factors(0.0F, 0.5F, 1.0F)).y, 7.5, 0.51);
    EXPECT_EQ(specular(factors(1.0F, 0.0F, 0.5F)), glm::ivec2(255, 255));
}

TEST(DeferredMaps, MapsOfReflectionMultiplyTheirFactors) {
    traces::Scene scene = wall_file().load();
    pipeline::MaterialMaps& maps = material_of(scene).maps;
    maps.roughness = {add_map(scene, {7, 128, 0, 9})}; // green and blue count
    maps.specular = {add_map(scene, {1, 2, 3, 51})};
    const glm::vec4 specular = middle(drawn(scene, {"method=dp", "specular=1"}), "specular");
    EXPECT_NEAR(specular.r, 0.2F, 0.5F / 255.0F);
    const double alpha = std::pow(128.0 / 255.0, 2);
    EXPECT_NEAR(specular.g * 255.0F, 0.25 * (2.0 / (alpha * alpha) - 2.0), 0.51);
}

// What the formats leave of it: 5, 6 and 5 bits, 4 bits each, or 8.
TEST(DeferredMaps, SurfacesThatSendOutLightAreSeenWithoutAny) {
    traces::Scene scene = wall_file().load();
    for (const auto& [factor, texel] : {std::pair{glm::vec3(1, 0, 1), Texel{255, 255, 255, 255}},
                                        std::pair{glm::vec3(0.3F, 0.6F, 0.8F), Texel{255, 255, 255, 255}},
                                        std::pair{glm::vec3(1, 1, 1), Texel{188, 255, 0, 255}}}) {
        material_of(scene).maps.emissive_factor = factor;
        material_of(scene).maps.emissive = {add_map(scene, texel, true)};
        glm::vec3 expected = factor;
        if (texel[2] == 0) expected = {0.5029F, 1.0F, 0.0F}; // sRGB code 188
        for (const std::string method : methods) {
            const glm::vec3 seen = middle_of_picture(drawn(scene, {method, "lights=0", "ambient=0"}));
            const bool forward = method == "method=fw" || method == "method=fwd";
            const glm::vec3 half_step = forward                 ? glm::vec3(0.5F / 255.0F)
                                        : method == "method=kg" ? glm::vec3(0.5F / 15.0F)
                                                                : glm::vec3(0.5F / 31.0F, 0.5F / 63.0F, 0.5F / 31.0F);
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(seen[i], expected[i], half_step[i] + 0.51F / 255.0F) << method << ' ' << i;
        }
    }
}

TEST(DeferredMaps, WhatIsSentOutIsAddedToWhatIsReflected) {
    traces::Scene scene = wall_file().load();
    material_of(scene).maps.emissive_factor = {1.0F, 0.0F, 0.0F};
    for (const char* method : methods) {
        const glm::vec3 seen = middle_of_picture(drawn(scene, {method, "lights=0", "ambient=0.5"}));
        EXPECT_EQ(seen.r, 1.0F) << method;
        EXPECT_NEAR(seen.g, 0.25F, 1.0F / 255.0F) << method;
    }
}

// A map of one texel is one line for each quad and read; the first quad misses, if any.
TEST(DeferredMaps, EachMapIsReadOnceByEachQuadOfThePassesThatUseIt) {
    traces::Scene scene = wall_file().load();
    pipeline::MaterialMaps& maps = material_of(scene).maps;
    const auto reads = [&](const char* method, const char* pass) {
        const Replay replay = drawn(scene, {method, "shadows=none"});
        const pipeline::RunResult run = replay.run("blender", {"fragment.pipes=1", "texture.l1_bytes=65536"});
        const auto& counters = *support::pass_named(run, pass).counters;
        const std::uint64_t misses = support::counter(counters, "fragment/l1/texture_misses");
        const std::uint64_t quads = support::counter(counters, "fragment/quads");
        EXPECT_GE(quads, side / 2 * side / 2);
        const std::uint64_t lines = support::counter(counters, "fragment/l1/texture_hits") + misses;
        EXPECT_EQ(lines % quads, 0U) << method;
        EXPECT_LE(misses, lines / quads) << method; // a pass before may have read it
        return lines / quads;
    };
    EXPECT_EQ(reads("method=pm", "G-buffer"), 0U);
    maps.normal = {add_map(scene, {204, 128, 229, 255})};
    EXPECT_EQ(reads("method=pm", "G-buffer"), 1U);
    EXPECT_EQ(reads("method=kg", "G-buffer"), 1U);
    maps.roughness = {add_map(scene, {0, 128, 0, 255})};
    maps.specular = {add_map(scene, {0, 0, 0, 255})};
    EXPECT_EQ(reads("method=pm", "G-buffer"), 3U);
    maps.emissive = {add_map(scene, {9, 9, 9, 255}, true)};
    EXPECT_EQ(reads("method=pm", "G-buffer"), 3U); // its factor is 0
    maps.emissive_factor = glm::vec3(1.0F);
    EXPECT_EQ(reads("method=pm", "G-buffer"), 4U);
    EXPECT_EQ(reads("method=fw", "ambient"), 2U); // the normal, and what it sends out
    EXPECT_EQ(reads("method=fw", "light 0"), 3U); // all but that
}

TEST(DeferredMaps, OneTexelForTwoMapsIsOneSurface) {
    traces::Scene scene = wall_file().load();
    const std::int32_t map = add_map(scene, {255, 128, 0, 255});
    material_of(scene).maps.roughness = {map};
    material_of(scene).maps.specular = {map};
    const Replay replay = drawn(scene, {"method=pm"});
    EXPECT_EQ(std::count_if(replay.frame.surfaces.begin(), replay.frame.surfaces.end(),
                            [](const pipeline::SurfaceInfo& info) { return info.name.starts_with("map "); }),
              1);
}

TEST(DeferredMaps, DrawsWithoutTheCoordinatesOfAMapAreToldAndDrawnWithoutIt) {
    traces::Scene scene = wall_file().load();
    material_of(scene).maps.normal = {add_map(scene, {255, 128, 128, 255}), 1};
    const Replay replay = drawn(scene, {"method=dp"});
    const std::string told = "maps of materials: 1 draws have none of the coordinates that one asks for, and are drawn "
                             "without it";
    EXPECT_EQ(std::count(replay.frame.notes.begin(), replay.frame.notes.end(), told), 1);
    EXPECT_NEAR(middle(replay, "normals").b, 1.0F, 1.0F / 1023.0F);
}

// Red, green; blue, transparent white.
constexpr const char* image_2x2 =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAE0lEQVR42mP4z8DwHwyBNAgwAABIyQj4xTT9BQAAAABJRU5E"
    "rkJggg==";

support::GltfFile mapped_file() {
    support::GltfFile file = wall_file();
    file.json["images"] = {{{"uri", image_2x2}}};
    file.json["samplers"] = json::parse(R"([{"wrapS": 33071, "minFilter": 9728, "magFilter": 9728}])");
    file.json["textures"] = json::parse(R"([{"source": 0, "sampler": 0}])");
    file.json["materials"][0].update(json::parse(R"({"normalTexture": {"index": 0, "scale": 0.5},
        "emissiveTexture": {"index": 0}, "emissiveFactor": [0.25, 0.5, 0.75],
        "extensions": {"KHR_materials_specular": {"specularFactor": 0.5, "specularTexture": {"index": 0}}}})"));
    file.json["materials"][0]["pbrMetallicRoughness"].update(
        json::parse(R"({"metallicFactor": 0.25, "roughnessFactor": 0.75, "metallicRoughnessTexture": {"index": 0}})"));
    return file;
}

class DeferredMapsTruth : public support::RayTest {};

reports::Truth truth_of(const Replay& replay) {
    const traces::TruthMethod method =
        traces::truth_method(replay.scene, replay.frame, "deferred", traces::WorkloadOptions::of(replay.options.knobs));
    return reports::trace_truth(*method.frame, reports::RayScene(method.frame->resources, method.frame->draws), method);
}

/// Of red, green and blue, where rays are sure.
double mean_difference(const std::vector<float>& picture, const reports::Truth& truth) {
    double sum = 0.0;
    std::size_t compared = 0;
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
        if (truth.doubtful(pixel)) continue;
        for (std::size_t i = pixel * 4; i < pixel * 4 + 3; ++i, ++compared)
            sum += std::abs(static_cast<double>(picture[i]) - static_cast<double>(truth.colours[i]));
    }
    EXPECT_GT(compared, 1500U);
    return sum / static_cast<double>(compared);
}

// Predicted: nothing but rounding, 565 bits of what is sent out included (a quarter of 1/31 and of 1/63 in the mean);
// without maps half of the wall has other colours.
TEST_F(DeferredMapsTruth, RaysReadTheSameMaps) {
    const Settings settings{"method=dp", "shadows=none", "ambient=0.2"};
    const traces::Scene scene = mapped_file().load();
    const Replay replay = drawn(scene, settings, 32); // no pixel's centre lies between two texels
    const reports::Truth truth = truth_of(replay);
    EXPECT_LT(mean_difference(replay.reference.colour, truth), 0.012);
    Settings without = settings;
    without.emplace_back("maps=false");
    const Replay bare = drawn(scene, without, 32);
    EXPECT_LT(mean_difference(bare.reference.colour, truth_of(bare)), 0.004);
    EXPECT_GT(mean_difference(bare.reference.colour, truth), 0.05);
}

TEST(DeferredMaps, ACapturedFrameHasItsMaps) {
    const support::TemporaryFolder folder;
    const std::string file = folder.write("wall.gltf", mapped_file().text()).string();
    traces::CaptureRequest request;
    request.scene = file;
    request.camera = "0,0,4,0,0,0,40";
    request.width = request.height = side;
    request.workload = "deferred";
    request.settings = {"lights=1", "map_size=64"};
    traces::write_trace(traces::capture(request), folder.path() / "wall.rtrace");
    const traces::Trace trace = traces::read_trace(folder.path() / "wall.rtrace");
    ASSERT_EQ(trace.scene.resources->maps.size(), 2U); // sRGB-encoded and not
    const pipeline::Frame frame = traces::frame_of(trace);
    const auto streams = pipeline::rasterize_frame(frame);
    EXPECT_EQ(pipeline::run_reference(frame, streams).colour,
              drawn(traces::load_scene(file), {"map_size=64"}).reference.colour);
}

TEST(DeferredMaps, FramesThatReadNoMapsAreCapturedWithoutThem) {
    const support::TemporaryFolder folder;
    support::GltfFile file = mapped_file();
    file.json["images"][0]["uri"] = "data:image/png;base64,AAAA"; // nobody asks for it
    traces::CaptureRequest request;
    request.scene = folder.write("wall.gltf", file.text()).string();
    request.workload = "opaque";
    const traces::Trace trace = traces::capture(request);
    EXPECT_TRUE(trace.scene.resources->maps.empty());
    EXPECT_EQ(trace.scene.resources->materials[0].maps, pipeline::MaterialMaps{});
}

TEST(DeferredMaps, AnImageThatCannotBeReadIsAnErrorWhereItIsAskedFor) {
    support::GltfFile file = mapped_file();
    file.json["images"][0]["uri"] = "data:image/png;base64,AAAA";
    const traces::Scene scene = file.load();
    try {
        drawn(scene, {"method=pm"});
        FAIL();
    } catch (const sim::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("scene.gltf: images[0]: expected PNG, JPEG or WebP data"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_FALSE(drawn(scene, {"maps=false"}).reference.colour.empty());
}

} // namespace workload_deferred_maps_test
