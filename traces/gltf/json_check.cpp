#include "traces/gltf/json_check.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace traces::gltf {

using nlohmann::json;

namespace {

constexpr int deepest_nesting = 64;

constexpr std::array<std::string_view, 6> read_extensions = {"EXT_mesh_gpu_instancing",    "KHR_lights_punctual",
                                                             "KHR_materials_transmission", "KHR_materials_unlit",
                                                             "KHR_mesh_quantization",      "KHR_texture_transform"};

// What to do about extensions that hide the data itself.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> compressions = {{
    {"KHR_draco_mesh_compression", "Draco-compressed geometry"},
    {"EXT_meshopt_compression", "meshopt-compressed buffers"},
    {"KHR_meshopt_compression", "meshopt-compressed buffers"},
    {"KHR_texture_basisu", "KTX2 textures"},
    {"EXT_texture_webp", "WebP textures"},
}};

// Properties of the core format whose value is an index, a count or a length.
constexpr std::array<std::string_view, 16> natural_numbers = {
    "buffer", "bufferView",          "byteLength", "byteOffset", "byteStride", "camera", "componentType", "count",
    "index",  "inverseBindMatrices", "material",   "mesh",       "mode",       "skin",   "source",        "texCoord"};

constexpr std::array<std::string_view, 12> lists = {"accessors", "buffers",   "bufferViews", "cameras",
                                                    "images",    "materials", "meshes",      "nodes",
                                                    "samplers",  "scenes",    "skins",       "textures"};

template <std::size_t n>
bool contains(const std::array<std::string_view, n>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void fail(const std::string& file, std::string_view place, std::string_view expected) {
    throw sim::InputError(fmt::format("{}: {}: expected {}", file, place, expected));
}

std::string one_line(std::string text) {
    const std::size_t tag = text.find("] "); // the library's exception number
    if (text.starts_with('[') && tag != std::string::npos) text.erase(0, tag + 2);
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
}

json parsed(const std::string& file, std::string_view text) {
    const auto check_depth = [&file](int depth, json::parse_event_t, json&) {
        if (depth > deepest_nesting) fail(file, "JSON", fmt::format("at most {} levels of nesting", deepest_nesting));
        return true;
    };
    try {
        return json::parse(text, check_depth);
    } catch (const json::exception& error) {
        throw sim::InputError(fmt::format("{}: {}", file, one_line(error.what())));
    }
}

void check_version(const std::string& file, const json& root) {
    const auto asset = root.find("asset");
    const bool present =
        asset != root.end() && asset->is_object() && asset->contains("version") && (*asset)["version"].is_string();
    if (!present || !(*asset)["version"].get_ref<const std::string&>().starts_with("2."))
        fail(file, "asset.version", "\"2.0\"");
}

void check_required(const std::string& file, const json& root) {
    const auto required = root.find("extensionsRequired");
    if (required == root.end()) return;
    if (!required->is_array()) fail(file, "extensionsRequired", "a list of names");
    for (const json& item : *required) {
        if (!item.is_string()) fail(file, "extensionsRequired", "a list of names");
        const auto& name = item.get_ref<const std::string&>();
        if (is_read_extension(name)) continue;
        const auto what = std::find_if(compressions.begin(), compressions.end(),
                                       [&](const auto& known) { return known.first == name; });
        const auto hint =
            what == compressions.end() ? std::string() : fmt::format(" ({}: convert the file without)", what->second);
        fail(file, "extensionsRequired", fmt::format("extensions that ropsim reads, got {}{}", one_line(name), hint));
    }
}

void check_numbers(const std::string& file, const json& value, const std::string& path) {
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) check_numbers(file, value[i], fmt::format("{}[{}]", path, i));
    if (!value.is_object()) return;
    for (const auto& [key, member] : value.items()) {
        if (key == "extras" || key == "extensions") continue;
        const std::string place = path.empty() ? key : fmt::format("{}.{}", path, key);
        if (contains(natural_numbers, key) &&
            !(member.is_number_unsigned() && member.get<std::uint64_t>() < (1ULL << 31U)))
            fail(file, one_line(place),
                 fmt::format("a natural number below 2^31, got {}", one_line(member.dump().substr(0, 40))));
        check_numbers(file, member, place);
    }
}

} // namespace

bool is_read_extension(std::string_view name) { return contains(read_extensions, name); }

void check_json(const std::string& file, std::string_view text) {
    const json root = parsed(file, text);
    if (!root.is_object()) fail(file, "JSON", "an object");
    check_version(file, root);
    check_required(file, root);
    for (const std::string_view list : lists) {
        const auto found = root.find(list);
        if (found == root.end()) continue;
        if (!found->is_array()) fail(file, list, "a list");
        for (std::size_t i = 0; i < found->size(); ++i)
            if (!(*found)[i].is_object()) fail(file, fmt::format("{}[{}]", list, i), "an object");
    }
    check_numbers(file, root, "");
}

} // namespace traces::gltf
