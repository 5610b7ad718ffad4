#include "traces/gltf/export_materials.hpp"

#include "sim/check.hpp"

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <tiny_gltf.h>
#include <vector>

namespace traces::gltf {

using nlohmann::ordered_json;
using pipeline::Material;
using pipeline::Texture;

namespace {

constexpr std::array<int, 3> wraps{TINYGLTF_TEXTURE_WRAP_REPEAT, TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE,
                                   TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT};
constexpr std::array<int, 6> filters{TINYGLTF_TEXTURE_FILTER_NEAREST,
                                     TINYGLTF_TEXTURE_FILTER_LINEAR,
                                     TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST,
                                     TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST,
                                     TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR,
                                     TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR};

template <class Enum, std::size_t n>
int code_of(const std::array<int, n>& codes, Enum value) {
    return codes.at(static_cast<std::size_t>(value));
}

std::vector<unsigned char> png_of(const Texture::Level& level) {
    tinygltf::Image image;
    image.width = static_cast<int>(level.width);
    image.height = static_cast<int>(level.height);
    image.component = 4;
    image.bits = 8;
    image.pixel_type = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    image.image = level.rgba;
    const std::string folder, name = "texture.png"; // only the extension matters: the image goes into a data URI
    std::string uri, mime_type;
    CHECK(tinygltf::WriteImageData(&folder, &name, &image, true, &uri, nullptr));
    std::vector<unsigned char> bytes;
    CHECK(tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false));
    return bytes;
}

/// Of uv' = translation * rotation * scale * uv, as KHR_texture_transform wants it.
ordered_json transform_of(const glm::mat3& matrix) {
    const glm::dvec2 x{glm::vec2(matrix[0])}, y{glm::vec2(matrix[1])};
    const double mirrored = x.x * y.y - x.y * y.x < 0.0 ? -1.0 : 1.0;
    return {{"offset", {matrix[2].x, matrix[2].y}},
            {"rotation", std::atan2(-x.y, x.x)},
            {"scale", {glm::length(x), mirrored * glm::length(y)}}};
}

ordered_json extensions_of(GlbFile& file, const Material& material) {
    auto extensions = ordered_json::object();
    if (material.unlit) extensions["KHR_materials_unlit"] = ordered_json::object();
    if (material.transmission > 0.0F)
        extensions["KHR_materials_transmission"] = {{"transmissionFactor", material.transmission}};
    for (const auto& item : extensions.items()) file.use_extension(item.key().c_str(), false);
    return extensions;
}

} // namespace

std::size_t MaterialWriter::use_texture(std::int32_t texture) {
    const auto [entry, is_new] = textures_.try_emplace(texture, 0);
    if (!is_new) return entry->second;
    const Texture& source = resources_.textures.at(static_cast<std::size_t>(texture));
    const std::vector<unsigned char> png = png_of(source.levels.at(0));
    const std::size_t view = file_.add_view(std::as_bytes(std::span(png)));
    const std::size_t image = file_.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    const std::size_t sampler = file_.add("samplers", {{"magFilter", code_of(filters, source.mag_filter)},
                                                       {"minFilter", code_of(filters, source.min_filter)},
                                                       {"wrapS", code_of(wraps, source.wrap_u)},
                                                       {"wrapT", code_of(wraps, source.wrap_v)}});
    entry->second = file_.add("textures", {{"name", source.name}, {"sampler", sampler}, {"source", image}});
    return entry->second;
}

std::size_t MaterialWriter::use(std::uint32_t number) {
    const auto [entry, is_new] = materials_.try_emplace(number, 0);
    if (!is_new) return entry->second;
    const Material& source = resources_.materials.at(number);
    const glm::vec4& colour = source.base_colour;
    ordered_json base = {{"baseColorFactor", {colour.r, colour.g, colour.b, colour.a}}};
    if (source.base_texture >= 0) {
        ordered_json texture = {{"index", use_texture(source.base_texture)}, {"texCoord", source.texcoord}};
        if (source.uv_transform != glm::mat3(1.0F)) {
            texture["extensions"]["KHR_texture_transform"] = transform_of(source.uv_transform);
            file_.use_extension("KHR_texture_transform", true);
        }
        base["baseColorTexture"] = std::move(texture);
    }
    static constexpr std::array<const char*, 3> modes{"OPAQUE", "MASK", "BLEND"};
    ordered_json material = {{"name", source.name},
                             {"pbrMetallicRoughness", std::move(base)},
                             {"alphaMode", modes.at(static_cast<std::size_t>(source.alpha_mode))},
                             {"doubleSided", source.double_sided}};
    if (source.alpha_mode == pipeline::AlphaMode::mask) material["alphaCutoff"] = source.alpha_cutoff;
    ordered_json extensions = extensions_of(file_, source);
    if (!extensions.empty()) material["extensions"] = std::move(extensions);
    entry->second = file_.add("materials", std::move(material));
    return entry->second;
}

} // namespace traces::gltf
