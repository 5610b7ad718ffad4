#include "traces/gltf/document.hpp"

#include "sim/check.hpp"
#include "traces/gltf/json_check.hpp"
#include "traces/hash.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>

namespace traces::gltf {

namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::uint64_t largest_file = 1ULL << 31U;

std::optional<Bytes> read_file(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
    const std::uint64_t size = std::filesystem::file_size(path, error);
    if (error || size > largest_file) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    Bytes bytes(size);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!file || static_cast<std::uint64_t>(file.gcount()) != size) return std::nullopt;
    return bytes;
}

std::uint32_t u32_at(const Bytes& bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// The JSON in a .glb container (glTF 2.0, section 4.4), after checking that no length leads out of the file.
std::string_view json_in_container(const std::string& name, const Bytes& bytes) {
    const auto fail = [&](std::string_view place, const std::string& expected) {
        throw sim::InputError(fmt::format("{}: {}: expected {}", name, place, expected));
    };
    if (bytes.size() < 20) fail("header", fmt::format("at least 20 bytes, got {}", bytes.size()));
    if (u32_at(bytes, 4) != 2) fail("header", fmt::format("version 2, got {}", u32_at(bytes, 4)));
    const std::size_t length = u32_at(bytes, 8);
    if (length > bytes.size())
        fail("header", fmt::format("a file of {} bytes, got {}: it is cut off", length, bytes.size()));
    for (std::size_t offset = 12; offset < length;) {
        if (length - offset < 8) fail(fmt::format("byte {}", offset), "a chunk header of 8 bytes");
        const std::size_t chunk = u32_at(bytes, offset);
        if (chunk > length - offset - 8)
            fail(fmt::format("chunk at byte {}", offset),
                 fmt::format("at most {} bytes, got {}", length - offset - 8, chunk));
        offset += 8 + chunk;
    }
    if (std::memcmp(bytes.data() + 16, "JSON", 4) != 0) fail("chunk at byte 12", "type JSON");
    return {reinterpret_cast<const char*>(bytes.data()) + 20, u32_at(bytes, 12)};
}

// tinygltf's view of the file system: only regular files of bounded size, all of them hashed as they are read.
struct Files {
    ContentHash hash;
};

bool file_exists(const std::string& path, void*) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

std::string same_path(const std::string& path, void*) { return path; }

bool read_whole_file(Bytes* out, std::string* error, const std::string& path, void* files) {
    std::optional<Bytes> bytes = read_file(path);
    if (!bytes) {
        if (error != nullptr) *error += "cannot be read: " + path;
        return false;
    }
    static_cast<Files*>(files)->hash.add(std::as_bytes(std::span(*bytes)));
    *out = std::move(*bytes);
    return true;
}

// Images are decoded when a material asks for them. Those in a bufferView stay there: tinygltf does not check that the
// view lies in its buffer before it gets here.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
    image->as_is = true;
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    return true;
}

std::string first_line(std::string text) {
    text = text.substr(0, text.find('\n'));
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    if (text.size() > 200) text.resize(200);
    return text;
}

tinygltf::Model parsed(const std::string& name, const std::filesystem::path& path, const Bytes& bytes, bool binary,
                       Files& files) {
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks({file_exists, same_path, read_whole_file, nullptr, &files});
    loader.SetImageLoader(keep_encoded, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    const auto size = static_cast<unsigned>(bytes.size());
    const std::string folder = path.parent_path().empty() ? "." : path.parent_path().string();
    bool good = false;
    try {
        good = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, folder)
                      : loader.LoadASCIIFromString(&model, &error, &warning,
                                                   reinterpret_cast<const char*>(bytes.data()), size, folder);
    } catch (const std::exception& exception) {
        error = exception.what();
        good = false;
    }
    // A property that was passed over is an error, too.
    if (!good || !error.empty())
        throw sim::InputError(
            fmt::format("{}: expected valid glTF 2.0: {}", name, first_line(error.empty() ? warning : error)));
    return model;
}

} // namespace

Document::Document(const std::filesystem::path& path) : name_(path.string()) {
    const std::optional<Bytes> bytes = read_file(path);
    if (!bytes) throw sim::InputError(fmt::format("{}: expected a readable file of at most 2 GiB", name_));
    Files files;
    files.hash.add(std::as_bytes(std::span(*bytes)));
    const bool binary = bytes->size() >= 4 && std::memcmp(bytes->data(), "glTF", 4) == 0;
    check_json(name_, binary ? json_in_container(name_, *bytes)
                             : std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
    model_ = parsed(name_, path, *bytes, binary, files);
    hash_ = files.hash.hex();
    note_unread_extensions();
}

void Document::fail(std::string_view place, std::string_view expected) const {
    throw sim::InputError(fmt::format("{}: {}: expected {}", name_, place, expected));
}

std::span<const unsigned char> Document::view_bytes(int view, std::string_view place) const {
    const auto& one = at(model_.bufferViews, view, place, "bufferView");
    const std::string where = fmt::format("bufferView {}", view);
    const auto& buffer = at(model_.buffers, one.buffer, where, "buffer");
    require(one.byteLength <= buffer.data.size() && one.byteOffset <= buffer.data.size() - one.byteLength, where,
            "{} bytes from byte {} within buffer {} of {} bytes", one.byteLength, one.byteOffset, one.buffer,
            buffer.data.size());
    return std::span(buffer.data).subspan(one.byteOffset, one.byteLength);
}

void Document::note_unread_extensions() {
    for (const std::string& extension : model_.extensionsUsed)
        if (!is_read_extension(extension)) notes.push_back(fmt::format("extension {} is not read", extension));
    if (!model_.animations.empty())
        notes.push_back(
            fmt::format("animations ({}) are not played: the scene is in its rest pose", model_.animations.size()));
}

std::string place_of(std::string_view kind, std::size_t index, const std::string& name) {
    return name.empty() ? fmt::format("{} {}", kind, index)
                        : fmt::format("{} {} \"{}\"", kind, index, first_line(name));
}

} // namespace traces::gltf
