// Malformed glTF as a class: every property of three small files takes twelve values, one at a time. Each outcome is a
// refusal that names the property, the unchanged picture, a note, or a value that glTF's schema allows.
#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/hash.hpp"

#include <array>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <set>

namespace gltf_mutations_test {

using nlohmann::json;
using support::GltfFile;
using traces::Scene;

// What a picture depends on, decoded: neither names nor how it lies in memory.
class PictureHash {
  public:
    static std::string of(const Scene& scene) {
        PictureHash hash(scene);
        scene.resources->read_textures();
        for (const pipeline::Draw& draw : scene.draws) hash.add_draw(draw);
        for (const traces::Camera& c : scene.cameras) {
            hash.add(c.to_world);
            hash.add(std::array{c.fovy, c.xmag, c.ymag, c.near, c.far, c.orthographic ? 1.0F : 0.0F});
        }
        for (const traces::Light& l : scene.lights) {
            hash.add(l.to_world);
            hash.add(l.colour);
            hash.add(std::array{l.intensity, l.range, l.inner_cone, l.outer_cone, static_cast<float>(l.kind)});
        }
        return hash.hash_.hex();
    }

  private:
    explicit PictureHash(const Scene& scene) : resources_(*scene.resources) {}

    template <class T>
    void add(const T& value) {
        hash_.add_values(std::span(&value, 1));
    }

    void add_draw(const pipeline::Draw& draw) {
        hash_.add_values(std::span(draw.instances));
        const pipeline::Geometry& geometry = resources_.geometries[draw.geometry];
        add(geometry.topology);
        for (const pipeline::VertexAttribute& attribute : geometry.attributes) {
            add(attribute.semantic);
            const pipeline::AttributeReader read(resources_, attribute);
            for (std::uint32_t i = 0; i < geometry.vertex_count; ++i) add(read(i));
        }
        if (geometry.index_type != pipeline::IndexType::none) {
            const auto& bytes = resources_.buffers[geometry.index_buffer].bytes;
            hash_.add(std::span(bytes).subspan(geometry.index_offset,
                                               std::size_t{geometry.index_count} * bytes_of(geometry.index_type)));
        }
        add_material(resources_.materials[draw.material]);
    }

    void add_material(const pipeline::Material& m) {
        add(m.base_colour);
        add(m.uv_transform);
        add(std::array{m.alpha_cutoff, m.transmission});
        add(std::array{static_cast<int>(m.texcoord), static_cast<int>(m.alpha_mode), m.double_sided ? 1 : 0,
                       m.unlit ? 1 : 0});
        if (m.base_texture < 0) return;
        const pipeline::Texture& t = resources_.textures[static_cast<std::size_t>(m.base_texture)];
        add(std::array{static_cast<int>(t.wrap_u), static_cast<int>(t.wrap_v), static_cast<int>(t.min_filter),
                       static_cast<int>(t.mag_filter)});
        hash_.add_values(std::span(t.levels[0].rgba));
    }

    const pipeline::Resources& resources_;
    traces::ContentHash hash_;
};

// Red, green; blue, transparent white.
constexpr const char* image_2x2 =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAE0lEQVR42mP4z8DwHwyBNAgwAABIyQj4xTT9BQAAAABJRU5ErkJggg==";

constexpr std::string_view common = R"({
    "asset": {"version": "2.0", "minVersion": "2.0", "generator": "g", "copyright": "c"},
    "scene": 0, "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_unlit"],
    "cameras": [{"name": "c", "type": "perspective",
                 "perspective": {"yfov": 0.7, "aspectRatio": 1.5, "znear": 0.25, "zfar": 100}},
                {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 3, "znear": 0.125, "zfar": 50}}],
    "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "spot", "color": [0.25, 0.75, 0.125], "intensity": 7, "range": 9,
         "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.75}}, {"type": "point"}]}},
    "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                    "samplers": [{"input": 0, "output": 0, "interpolation": "LINEAR"}]}]})";

GltfFile begin() {
    GltfFile file;
    file.json = json::parse(common);
    return file;
}

const std::vector<float> four_corners{-0.5F, -0.5F, 0, 0.75F, -0.5F, 0, 0.5F, 0.5F, 0, -0.5F, 0.25F, 0};

// A textured quadrilateral on two joints.
GltfFile skinned_file() {
    GltfFile file = begin();
    file.add(four_corners, "VEC3");
    file.add({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2");
    file.add_integers(std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0}, "VEC4", 5121);
    file.add({0.75F, 0.25F, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0, 1, 0, 0, 0}, "VEC4");
    file.add({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, "MAT4");
    file.add_integers(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
    file.json["accessors"][0]["min"] = {-0.5, -0.5, 0};
    file.json["accessors"][0]["max"] = {0.75, 0.5, 0};
    file.json["accessors"][0]["byteOffset"] = 0;
    file.json["accessors"][0]["normalized"] = false;
    file.json["bufferViews"][0]["byteStride"] = 12;
    file.json["bufferViews"][0]["target"] = 34962;
    file.json["meshes"] = json::parse(R"([{"name": "m", "primitives": [{"mode": 4, "material": 0, "indices": 5,
        "attributes": {"POSITION": 0, "TEXCOORD_0": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}}]}])");
    file.json["skins"] = json::parse(R"([{"inverseBindMatrices": 4, "skeleton": 1, "joints": [1, 2]}])");
    file.json["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0}, {"children": [2, 3], "rotation": [0, 0, 0.6, 0.8]},
        {"translation": [0.125, 1, 0], "scale": [1.5, 2, 1]}, {"camera": 0, "translation": [0, 0, 5]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}, "KHR_node_visibility": {"visible": true}}},
        {"camera": 1, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 4, 1]}])");
    file.json["scenes"] = json::parse(R"([{"name": "s", "nodes": [0, 1, 4, 5]}])");
    file.json["images"] = {{{"uri", image_2x2}, {"mimeType", "image/png"}}};
    file.json["samplers"] = json::parse(R"([{"wrapS": 33071, "wrapT": 33648, "minFilter": 9987, "magFilter": 9728}])");
    file.json["textures"] = json::parse(R"([{"source": 0, "sampler": 0}])");
    file.json["materials"] = json::parse(R"([{"alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "emissiveFactor": [0, 0, 0], "normalTexture": {"index": 0, "scale": 2}, "occlusionTexture": {"index": 0, "strength": 0.75},
        "extensions": {"KHR_materials_unlit": {}, "KHR_materials_transmission": {"transmissionFactor": 0.125}},
        "pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.75, 0.125, 0.875], "metallicFactor": 0.25, "roughnessFactor": 0.75,
            "baseColorTexture": {"index": 0, "texCoord": 0, "extensions":
                {"KHR_texture_transform": {"offset": [0.25, 0.125], "rotation": 0.25, "scale": [2, 3], "texCoord": 0}}}}}])");
    return file;
}

// Quantised positions and colours, in three places.
GltfFile instanced_file() {
    GltfFile file = begin();
    file.add_integers(std::vector<std::int16_t>{0, 0, 0, 0, 8192, 0, 0, 0, 8192, 16384, 0, 0, 0, 8192, 4096, 0}, "VEC4",
                      5122, true);
    file.json["accessors"][0]["type"] = "VEC3";
    file.json["bufferViews"][0]["byteStride"] = 8;
    file.add_integers(std::vector<std::uint8_t>{0, 64, 128, 255, 1, 2, 3, 4, 9, 8, 7, 6, 50, 60, 70, 80}, "VEC4", 5121,
                      true);
    file.add_integers(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5121);
    file.add({0, 0, 0, 1, 0, 0, 0, 1.5F, 0}, "VEC3");
    file.add({0, 0, 0, 1, 0, 0, 0.6F, 0.8F, 0, 0, 0, 1}, "VEC4");
    file.add({1, 1, 1, 2, 1, 1, 1, 1, 1}, "VEC3");
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization"};
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.json["materials"] = json::parse(R"([{"alphaMode": "BLEND"}, {"doubleSided": false}])");
    file.json["meshes"] = json::parse(
        R"([{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, "material": 0}]}])");
    file.json["nodes"] = json::parse(R"([{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing":
        {"attributes": {"TRANSLATION": 3, "ROTATION": 4, "SCALE": 5}}}}, {"camera": 0, "translation": [0, 0, 5]}])");
    file.json["scenes"] = json::parse(R"([{"nodes": [0, 1]}, {"nodes": [0]}])");
    return file;
}

// Two morph targets, one of them sparse, as are the positions.
GltfFile morphed_file() {
    GltfFile file = begin();
    file.add(four_corners, "VEC3");
    const int places = file.add_view({"\1\0\3\0", 4});
    const std::array<float, 6> moved{1, -0.75F, 0, -0.75F, 0.75F, 0};
    const int values = file.add_view({reinterpret_cast<const char*>(moved.data()), sizeof moved});
    const json sparse = {{"count", 2},
                         {"indices", {{"bufferView", places}, {"byteOffset", 0}, {"componentType", 5123}}},
                         {"values", {{"bufferView", values}, {"byteOffset", 0}}}};
    file.json["accessors"][0]["sparse"] = sparse;
    file.json["accessors"].push_back({{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}, {"sparse", sparse}});
    file.add({0, 0, 1, 0, 0, 1, 0, 0.6F, 0.8F, 0, 0, 1}, "VEC3");
    file.add({0, 0.125F, 0, 0, 0.25F, 0, 0.25F, 0, 0, 0, 0, 0}, "VEC3");
    file.json["meshes"] = json::parse(R"([{"weights": [0.25, 0.75], "primitives": [{"mode": 6,
        "attributes": {"POSITION": 0, "NORMAL": 2}, "targets": [{"POSITION": 1}, {"POSITION": 3, "NORMAL": 3}]}]}])");
    file.json["nodes"] = json::parse(R"([{"mesh": 0, "weights": [0.5, 0.125]}, {"mesh": 0, "translation": [1, 0, 0]},
        {"camera": 0, "translation": [0, 0, 5]}])");
    file.json["scenes"] = json::parse(R"([{"nodes": [0, 1, 2]}])");
    return file;
}

const std::array<const char*, 12> values{"-1",   "4294967296", "0.5",   "1.0", "1e300", "true",
                                         "null", "\"1\"",      "\"x\"", "[]",  "{}",    "[1]"};

// Which of the values glTF's schema allows in a property so that the picture may be another one. Written from the
// schema, not from the importer.
bool schema_allows(const std::string& property, bool element, const std::string& value) {
    const auto any_of = [](const std::string& name, const std::set<std::string>& names) {
        return names.contains(name);
    };
    static const std::set<std::string> numbers{"translation", "rotation", "scale", "matrix", "weights", "offset"};
    static const std::set<std::string> units{"baseColorFactor", "transmissionFactor", "color"};
    static const std::set<std::string> positive{"range", "znear", "zfar", "xmag", "ymag", "intensity", "alphaCutoff"};
    static const std::set<std::string> angles{"yfov", "innerConeAngle", "outerConeAngle"};
    static const std::set<std::string> indices{"scene",
                                               "nodes",
                                               "children",
                                               "mesh",
                                               "camera",
                                               "skin",
                                               "material",
                                               "index",
                                               "source",
                                               "sampler",
                                               "bufferView",
                                               "buffer",
                                               "indices",
                                               "POSITION",
                                               "NORMAL",
                                               "TEXCOORD_0",
                                               "JOINTS_0",
                                               "COLOR_0",
                                               "WEIGHTS_0",
                                               "light",
                                               "ROTATION",
                                               "SCALE",
                                               "TRANSLATION",
                                               "joints",
                                               "texCoord",
                                               "mode",
                                               "byteOffset",
                                               "byteLength",
                                               "count",
                                               "byteStride",
                                               "inverseBindMatrices"};
    static const std::set<std::string> optional_members{"cameras",
                                                        "nodes",
                                                        "materials",
                                                        "samplers",
                                                        "textures",
                                                        "extensions",
                                                        "pbrMetallicRoughness",
                                                        "attributes",
                                                        "images",
                                                        "KHR_texture_transform",
                                                        "KHR_materials_transmission",
                                                        "KHR_node_visibility",
                                                        "spot",
                                                        "targets",
                                                        "scenes"};
    if (any_of(property, numbers))
        return any_of(value, {"-1", "4294967296", "0.5", "1.0"}) || (!element && value == "[1]");
    if (any_of(property, units) || any_of(property, angles)) return any_of(value, {"0.5", "1.0"});
    if (any_of(property, positive)) return any_of(value, {"4294967296", "0.5", "1.0"});
    if (property == "doubleSided" || property == "normalized" || property == "visible") return value == "true";
    if (any_of(property, optional_members) && value == "{}") return true;
    if (any_of(property, indices)) return value == "1.0" || (!element && value == "[1]");
    return false;
}

struct Mutation {
    json::json_pointer place;
    std::string property; ///< the key, of a list for its elements
    bool element = false;
};

void collect(const json& value, const json::json_pointer& place, const std::string& property,
             std::vector<Mutation>& list) {
    if (!place.empty())
        list.push_back({place, property,
                        value.is_null()
                            ? false
                            : !place.back().empty() && std::isdigit(static_cast<unsigned char>(place.back()[0])) != 0});
    if (value.is_object())
        for (const auto& [key, member] : value.items()) collect(member, place / key, key, list);
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], place / i, property, list);
}

void expect_nothing_silent(const GltfFile& file) {
    const support::TemporaryFolder folder;
    const json document = json::parse(file.text());
    const auto load = [&](const json& changed) {
        return traces::load_scene(folder.write("scene.gltf", changed.dump()).string());
    };
    const Scene original = load(document);
    const std::string picture = PictureHash::of(original);
    std::vector<Mutation> mutations;
    collect(document, json::json_pointer(), "", mutations);
    std::size_t refused = 0;
    for (const Mutation& mutation : mutations)
        for (const char* value : values) {
            json changed = document;
            changed[mutation.place] = json::parse(value);
            const std::string what = fmt::format("{} = {}", mutation.place.to_string(), value);
            try {
                const Scene scene = load(changed);
                const bool same = PictureHash::of(scene) == picture, noted = scene.notes != original.notes;
                EXPECT_TRUE(same || noted || schema_allows(mutation.property, mutation.element, value))
                    << what << ": another picture without a word";
            } catch (const sim::InputError& error) {
                ++refused;
                const std::string text = error.what();
                EXPECT_TRUE(text.find(mutation.property) != std::string::npos ||
                            schema_allows(mutation.property, mutation.element, value))
                    << what << ": " << text;
                EXPECT_EQ(text.find('\n'), std::string::npos) << text;
            }
        }
    EXPECT_GT(refused, 5 * mutations.size()); // most of the values are wrong nearly everywhere
}

TEST(GltfMutations, OfATexturedSkinnedMesh) { expect_nothing_silent(skinned_file()); }
TEST(GltfMutations, OfAnInstancedQuantisedMesh) { expect_nothing_silent(instanced_file()); }
TEST(GltfMutations, OfAMorphedMeshWithSparseAccessors) { expect_nothing_silent(morphed_file()); }

} // namespace gltf_mutations_test
