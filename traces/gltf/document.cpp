#include "traces/gltf/document.hpp"

#include "sim/check.hpp"
#include "traces/gltf/decompress.hpp"
#include "traces/gltf/file_data.hpp"
#include "traces/gltf/json_check.hpp"
#include "traces/gltf/property_check.hpp"

#include <nlohmann/json.hpp>

namespace traces::gltf {

using nlohmann::json;
using namespace nlohmann::literals;

namespace {

/// Moves a property out of an object; null when it has none.
json take(json& owner, const char* key) {
    const auto found = owner.find(key);
    if (found == owner.end()) return nullptr;
    json value = std::move(*found);
    owner.erase(found);
    return value;
}

// What tinygltf refuses or reads in its own way, taken out of the JSON before and put into the model afterwards:
// buffers longer than their byteLength, images, skins without inverse bind matrices, indices without a bufferView
// (sparse).
class SetAside {
  public:
    explicit SetAside(json& root)
        : buffers_(take(root, "buffers")), images_(take(root, "images")), skins_(take(root, "skins")) {
        if (const auto meshes = root.find("meshes"); meshes != root.end())
            for (json& mesh : *meshes)
                for (json& primitive : mesh["primitives"]) {
                    indices_.push_back(primitive.value("indices", -1));
                    primitive.erase("indices");
                }
    }

    void put_back(const Document& document, tinygltf::Model& model, FileData& files, const Parts& parts) const {
        for (std::size_t i = 0; i < buffers_.size(); ++i)
            model.buffers.push_back(buffer_of(document, buffers_[i], i, files, parts));
        for (const json& image : images_) model.images.push_back(image_of(image, files));
        for (const json& skin : skins_) model.skins.push_back(skin_of(skin));
        std::size_t next = 0;
        for (tinygltf::Mesh& mesh : model.meshes)
            for (tinygltf::Primitive& primitive : mesh.primitives) primitive.indices = indices_.at(next++);
    }

  private:
    static tinygltf::Buffer buffer_of(const Document& document, const json& source, std::size_t index, FileData& files,
                                      const Parts& parts) {
        tinygltf::Buffer buffer;
        const auto length = source.at("byteLength").get<std::size_t>();
        const std::string place = fmt::format("buffers[{}]", index);
        if (const auto uri = source.find("uri"); uri != source.end()) {
            std::optional<Bytes> bytes = files.at(uri->get_ref<const std::string&>());
            document.require(bytes.has_value(), place + ".uri", "a readable file or base64 data, got '{}'",
                             short_uri(uri->get_ref<const std::string&>()));
            buffer.data = std::move(*bytes);
        } else if (source.contains("/extensions/EXT_meshopt_compression"_json_pointer)) {
            return buffer; // its bufferViews are decoded from another one
        } else {
            document.require(index == 0 && parts.binary.has_value(), place + ".uri",
                             "a file, as there is no binary chunk for this buffer");
            buffer.data.assign(parts.binary->begin(), parts.binary->end());
        }
        document.require(length <= buffer.data.size(), place + ".byteLength",
                         "at most {}, the bytes that are there, got {}", buffer.data.size(), length);
        buffer.data.resize(length);
        return buffer;
    }

    // Images stay encoded until a picture needs them; those in a bufferView stay there. What cannot be read is an error
    // only where it is needed.
    static tinygltf::Image image_of(const json& source, FileData& files) {
        tinygltf::Image image;
        image.as_is = true;
        image.name = source.value("name", std::string());
        image.bufferView = source.value("bufferView", -1);
        image.uri = source.value("uri", std::string());
        if (image.bufferView >= 0 || image.uri.empty()) return image;
        if (std::optional<Bytes> bytes = files.at(image.uri)) image.image = std::move(*bytes);
        image.uri = short_uri(image.uri);
        return image;
    }

    static tinygltf::Skin skin_of(const json& source) {
        tinygltf::Skin skin;
        skin.name = source.value("name", std::string());
        skin.inverseBindMatrices = source.value("inverseBindMatrices", -1);
        skin.joints = source.at("joints").get<std::vector<int>>();
        return skin;
    }

    json buffers_, images_, skins_;
    std::vector<int> indices_; ///< of all primitives of all meshes
};

tinygltf::Model parsed(const std::string& name, const json& root) {
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string error, warning;
    const std::string text = root.dump();
    bool good = false;
    try {
        good =
            loader.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "");
    } catch (const std::exception& exception) {
        error = exception.what();
        good = false;
    }
    // A property that was passed over is an error, too.
    if (good && error.empty()) return model;
    if (error.empty()) error = warning;
    throw sim::InputError(
        fmt::format("{}: expected valid glTF 2.0: {}", name, one_line(error.substr(0, error.find('\n')))));
}

std::string why_unread(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) return "there is no such file";
    if (std::filesystem::is_directory(status)) return "expected a file, got a folder";
    return std::filesystem::file_size(path, error) > largest_file ? "expected a file of at most 2 GiB"
                                                                  : "cannot be read";
}

} // namespace

Document::Document(const std::filesystem::path& path) : name_(path.string()) {
    const std::optional<Bytes> bytes = read_file(path);
    if (!bytes) throw sim::InputError(fmt::format("{}: {}", name_, why_unread(path)));
    ContentHash hash;
    hash.add(std::as_bytes(std::span(*bytes)));
    const Parts parts = parts_of(name_, *bytes);
    json root = checked_json(name_, parts.json, notes);
    const SetAside set_aside(root);
    model_ = parsed(name_, root);
    FileData files(path, hash);
    set_aside.put_back(*this, model_, files, parts);
    decompress(*this, model_);
    hash_ = hash.hex();
}

void Document::fail(std::string_view place, std::string_view expected) const {
    throw sim::InputError(fmt::format("{}: {}: expected {}", name_, place, expected));
}

std::span<const unsigned char> Document::view_bytes(int view, std::string_view place) const {
    const auto& one = at(model_.bufferViews, view, place, "bufferView");
    const std::string where = fmt::format("bufferViews[{}]", view);
    const auto& buffer = at(model_.buffers, one.buffer, where, "buffer");
    require(one.byteLength <= buffer.data.size() && one.byteOffset <= buffer.data.size() - one.byteLength, where,
            "byteLength {} from byteOffset {} within buffer {} of {} bytes", one.byteLength, one.byteOffset, one.buffer,
            buffer.data.size());
    return std::span(buffer.data).subspan(one.byteOffset, one.byteLength);
}

std::string place_of(std::string_view kind, std::size_t index, const std::string& name) {
    return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} \"{}\"", kind, index, one_line(name));
}

} // namespace traces::gltf
