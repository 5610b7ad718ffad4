#include "traces/gltf/json_check.hpp"

#include "sim/check.hpp"
#include "traces/gltf/property_check.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace traces::gltf {

using nlohmann::json;

namespace {

constexpr int deepest_nesting = 64;

// What to do about extensions that a frame cannot do without.
constexpr std::string_view with_assimp = "`assimp export FILE OUT.glb` (Debian: assimp-utils) writes a file without";
constexpr std::string_view no_converter = "no program of Debian 12 writes a file without";
constexpr std::array<std::pair<std::string_view, std::string_view>, 10> remedies = {{
    {"KHR_materials_clearcoat", with_assimp},
    {"KHR_materials_ior", with_assimp},
    {"KHR_materials_pbrSpecularGlossiness", with_assimp},
    {"KHR_materials_sheen", with_assimp},
    {"KHR_materials_volume", with_assimp},
    {"KHR_binary_glTF", with_assimp},
    {"KHR_materials_common", with_assimp},
    {"KHR_meshopt_compression", no_converter},
    {"KHR_texture_basisu", no_converter},
    {"EXT_texture_avif", no_converter},
}};

[[noreturn]] void fail(const std::string& file, std::string_view place, std::string_view expected) {
    throw sim::InputError(fmt::format("{}: {}: expected {}", file, place, expected));
}

json parsed(const std::string& file, std::string_view text) {
    const auto check_depth = [&file](int depth, json::parse_event_t, json&) {
        if (depth > deepest_nesting) fail(file, "JSON", fmt::format("at most {} levels of nesting", deepest_nesting));
        return true;
    };
    try {
        return json::parse(text, check_depth);
    } catch (const json::exception& error) {
        std::string message = error.what();
        const std::size_t tag = message.find("] "); // the library's exception number
        if (message.starts_with('[') && tag != std::string::npos) message.erase(0, tag + 2);
        throw sim::InputError(fmt::format("{}: {}", file, one_line(message)));
    }
}

struct Version {
    int major = 0, minor = 0;
};

std::optional<Version> version_in(const json& asset, const char* key) {
    const auto found = asset.find(key);
    if (found == asset.end() || !found->is_string()) return std::nullopt;
    const auto& text = found->get_ref<const std::string&>();
    const char* const end = text.data() + text.size();
    Version version;
    const auto major = std::from_chars(text.data(), end, version.major);
    if (major.ec != std::errc{} || major.ptr == end || *major.ptr != '.') return std::nullopt;
    const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
    if (minor.ec != std::errc{} || minor.ptr != end || version.major < 0 || version.minor < 0) return std::nullopt;
    return version;
}

void check_version(const std::string& file, const json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object()) fail(file, "asset.version", "\"2.0\"");
    const auto version = version_in(*asset, "version");
    if (!version || version->major != 2)
        fail(file, "asset.version", fmt::format("\"2.0\"{}", got(asset->value("version", json()))));
    if (!asset->contains("minVersion")) return;
    const auto least = version_in(*asset, "minVersion");
    if (!least || least->major != 2 || least->minor != 0)
        fail(file, "asset.minVersion", fmt::format("\"2.0\"{}", got((*asset)["minVersion"])));
}

void check_required(const std::string& file, const json& root) {
    const auto required = root.find("extensionsRequired");
    if (required == root.end()) return;
    if (!required->is_array()) fail(file, "extensionsRequired", fmt::format("a list of names{}", got(*required)));
    std::string missing;
    for (std::size_t i = 0; i < required->size(); ++i) {
        const json& item = (*required)[i];
        if (!item.is_string()) fail(file, fmt::format("extensionsRequired[{}]", i), fmt::format("a name{}", got(item)));
        const auto& name = item.get_ref<const std::string&>();
        if (is_read_extension(name)) continue;
        const auto remedy =
            std::find_if(remedies.begin(), remedies.end(), [&](const auto& known) { return known.first == name; });
        missing += fmt::format("{}{}", missing.empty() ? "" : ", ", one_line(name));
        if (remedy != remedies.end()) missing += fmt::format(" ({})", remedy->second);
    }
    if (!missing.empty())
        fail(file, "extensionsRequired", fmt::format("extensions that ropsim reads, got {}", missing));
}

bool glows(const json& material) {
    const auto factor = material.find("emissiveFactor");
    return factor != material.end() && factor->is_array() &&
           std::any_of(factor->begin(), factor->end(), [](const json& one) { return one.is_number() && one != 0; });
}

void note_unread(const json& root, std::vector<std::string>& notes) {
    const auto list = [&](const char* key) { return root.value(key, json::array()); };
    for (const json& name : list("extensionsUsed"))
        if (name.is_string() && !is_read_extension(name.get_ref<const std::string&>()))
            notes.push_back(fmt::format("extension {} is not read", one_line(name.get_ref<const std::string&>())));
    if (const json animations = list("animations"); animations.is_array() && !animations.empty())
        notes.push_back(
            fmt::format("animations ({}) are not played: the scene is in its rest pose", animations.size()));
    const json materials = list("materials");
    const auto glowing = std::count_if(materials.begin(), materials.end(), glows);
    if (glowing > 0)
        notes.push_back(fmt::format("emission ({} of {} materials) is drawn by workloads that ask for it alone",
                                    glowing, materials.size()));
}

} // namespace

bool is_read_extension(std::string_view name) {
    const auto names = read_extensions();
    return std::find(names.begin(), names.end(), name) != names.end();
}

json checked_json(const std::string& file, std::string_view text, std::vector<std::string>& notes) {
    json root = parsed(file, text);
    if (!root.is_object()) fail(file, "JSON", "an object");
    check_version(file, root);
    check_required(file, root);
    std::vector<std::string> unread;
    note_unread(root, unread);
    check_properties(file, root, notes);
    notes.insert(notes.end(), unread.begin(), unread.end());
    return root;
}

} // namespace traces::gltf
