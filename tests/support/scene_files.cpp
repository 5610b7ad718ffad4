#include "tests/support/scene_files.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"

#include <atomic>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace support {

using nlohmann::json;

namespace {

std::string base64(std::string_view bytes) {
    static constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j)
            group = group << 8U | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
        for (std::size_t j = 0; j < 4; ++j) text += i + j > bytes.size() ? '=' : letters[group >> (18 - 6 * j) & 63U];
    }
    return text;
}

std::size_t components_of(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type.back() - '0');
}

std::string chunk(const std::string& type, std::string bytes, char padding) {
    while (bytes.size() % 4 != 0) bytes += padding;
    const auto size = static_cast<std::uint32_t>(bytes.size());
    return std::string(reinterpret_cast<const char*>(&size), 4) + type + bytes;
}

} // namespace

TemporaryFolder::TemporaryFolder() {
    static std::atomic<unsigned> number{0};
    path_ = std::filesystem::temp_directory_path() / fmt::format("ropsim_scene_{}_{}", getpid(), ++number);
    std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
}

std::filesystem::path TemporaryFolder::write(const std::string& name, std::string_view bytes) const {
    std::ofstream file(path_ / name, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
}

GltfFile::GltfFile() { json["asset"]["version"] = "2.0"; }

int GltfFile::add_view(std::string_view bytes) {
    while (buffer_.size() % 4 != 0) buffer_ += '\0';
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
    buffer_ += bytes;
    return static_cast<int>(json["bufferViews"].size()) - 1;
}

int GltfFile::add_accessor(std::string_view bytes, const std::string& type, int component_type, bool normalized) {
    const std::size_t size = component_type == 5126 || component_type == 5125 ? 4 : component_type >= 5122 ? 2 : 1;
    ::nlohmann::json accessor = {{"bufferView", add_view(bytes)},
                                 {"componentType", component_type},
                                 {"count", bytes.size() / size / components_of(type)},
                                 {"type", type}};
    if (normalized) accessor["normalized"] = true;
    json["accessors"].push_back(std::move(accessor));
    return static_cast<int>(json["accessors"].size()) - 1;
}

int GltfFile::add(const std::vector<float>& values, const std::string& type) {
    return add_integers(values, type, 5126);
}

json GltfFile::with_buffer(bool data_uri) const {
    ::nlohmann::json result = json;
    if (buffer_.empty() || result.contains("buffers")) return result;
    result["buffers"].push_back({{"byteLength", buffer_.size()}});
    if (data_uri) result["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(buffer_);
    return result;
}

std::string GltfFile::text() const { return with_buffer(true).dump(); }

std::string GltfFile::binary() const {
    const std::string chunks =
        chunk("JSON", with_buffer(false).dump(), ' ') + chunk(std::string("BIN\0", 4), buffer_, '\0');
    const std::array<std::uint32_t, 2> numbers{2, static_cast<std::uint32_t>(12 + chunks.size())};
    return "glTF" + std::string(reinterpret_cast<const char*>(numbers.data()), 8) + chunks;
}

traces::Scene GltfFile::load() const {
    const TemporaryFolder folder;
    return traces::load_scene(folder.write("scene.gltf", text()).string());
}

std::string GltfFile::error() const {
    const TemporaryFolder folder;
    return load_error(folder.write("scene.gltf", text()).string(), folder.path());
}

GltfFile triangle_file() {
    GltfFile file;
    file.add({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    file.json["meshes"] = json::parse(R"([{"primitives": [{"attributes": {"POSITION": 0}}]}])");
    file.json["nodes"] = json::parse(R"([{"mesh": 0}])");
    file.json["scenes"] = json::parse(R"([{"nodes": [0]}])");
    return file;
}

std::string load_error(const std::string& spec, const std::filesystem::path& folder) {
    try {
        traces::load_scene(spec);
        return {};
    } catch (const sim::InputError& error) {
        std::string text = error.what();
        const std::string prefix = folder.string() + "/";
        if (!folder.empty() && text.starts_with(prefix)) text.erase(0, prefix.size());
        return text;
    }
}

glm::vec3 position_at(const traces::Scene& scene, std::uint32_t geometry, std::uint32_t i) {
    const pipeline::Geometry& one = scene.resources->geometries.at(geometry);
    return glm::vec3(pipeline::AttributeReader(*scene.resources, *one.find(pipeline::Semantic::position))(i));
}

} // namespace support
