#include "traces/gltf/materials.hpp"

#include "traces/gltf/images.hpp"

#include <cmath>
#include <utility>

namespace traces::gltf {

using pipeline::AlphaMode;
using pipeline::Filter;
using pipeline::Material;
using pipeline::Texture;
using pipeline::Wrap;

namespace {

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

double number_in(const tinygltf::Value& object, const char* key, double fallback) {
    return object.Has(key) && object.Get(key).IsNumber() ? object.Get(key).GetNumberAsDouble() : fallback;
}

glm::vec2 pair_in(const tinygltf::Value& object, const char* key, const glm::vec2& fallback) {
    if (!object.Has(key) || !object.Get(key).IsArray() || object.Get(key).ArrayLen() != 2) return fallback;
    const tinygltf::Value& list = object.Get(key);
    if (!list.Get(0).IsNumber() || !list.Get(1).IsNumber()) return fallback;
    return {list.Get(0).GetNumberAsDouble(), list.Get(1).GetNumberAsDouble()};
}

// uv' = translation * rotation * scale * uv (KHR_texture_transform).
glm::mat3 uv_transform(const tinygltf::Value& transform) {
    const glm::vec2 offset = pair_in(transform, "offset", glm::vec2(0.0F));
    const glm::vec2 scale = pair_in(transform, "scale", glm::vec2(1.0F));
    const double angle = number_in(transform, "rotation", 0.0);
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    return {glm::vec3(c * scale.x, -s * scale.x, 0.0F), glm::vec3(s * scale.y, c * scale.y, 0.0F),
            glm::vec3(offset, 1.0F)};
}

Wrap wrap_of(int mode) {
    switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Wrap::mirror;
    default:
        return Wrap::repeat;
    }
}

Filter min_filter_of(int filter) {
    switch (filter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
        return Filter::nearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
        return Filter::linear;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        return Filter::nearest_mip_nearest;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
        return Filter::nearest_mip_linear;
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
        return Filter::linear_mip_linear;
    default:
        return Filter::linear_mip_nearest; // also where the file leaves the choice to the reader
    }
}

AlphaMode alpha_mode_of(const Document& document, const std::string& mode, std::string_view place) {
    if (mode == "MASK") return AlphaMode::mask;
    if (mode == "BLEND") return AlphaMode::blend;
    document.require(mode == "OPAQUE", place, "alphaMode OPAQUE, MASK or BLEND");
    return AlphaMode::opaque;
}

/// Which set of texture coordinates a texture reads, and how they are transformed.
template <class Info>
std::pair<int, glm::mat3> coordinates_of(const Info& info) {
    const auto* transform = extension(info.extensions, "KHR_texture_transform");
    if (transform == nullptr) return {info.texCoord, glm::mat3(1.0F)};
    return {static_cast<int>(number_in(*transform, "texCoord", info.texCoord)), uv_transform(*transform)};
}

bool is_read_set(Document& document, int set, std::string_view place) {
    if (set == 0 || set == 1) return true;
    document.notes.push_back(
        fmt::format("{}: texture coordinates {} are not read, its texture is left out", place, set));
    return false;
}

} // namespace

int Materials::image_of(int index, std::string_view place) {
    const auto& source = document_.at(document_.model().textures, index, place, "texture");
    int image = source.source;
    if (const auto* webp = extension(source.extensions, "EXT_texture_webp"); webp != nullptr && webp->Has("source"))
        image = webp->Get("source").GetNumberAsInt();
    if (image < 0) {
        const bool basis = extension(source.extensions, "KHR_texture_basisu") != nullptr;
        document_.notes.push_back(fmt::format("texture {} has no PNG, JPEG or WebP image{} and is left out", index,
                                              basis ? " (KTX2 is not read)" : ""));
    }
    return image;
}

Texture Materials::texture_without_texels(int index, std::string_view place) const {
    const auto& model = document_.model();
    const auto& source = document_.at(model.textures, index, place, "texture");
    Texture texture;
    texture.name = place_of("texture", static_cast<std::size_t>(index), source.name);
    if (source.sampler < 0) return texture;
    const auto& sampler = document_.at(model.samplers, source.sampler, texture.name, "sampler");
    texture.wrap_u = wrap_of(sampler.wrapS);
    texture.wrap_v = wrap_of(sampler.wrapT);
    texture.min_filter = min_filter_of(sampler.minFilter);
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) texture.mag_filter = Filter::nearest;
    return texture;
}

std::int32_t Materials::use_texture(int index, std::string_view place) {
    const int image = image_of(index, place);
    if (image < 0) return -1;
    const int sampler = document_.model().textures[static_cast<std::size_t>(index)].sampler;
    const auto [entry, is_new] = textures_.try_emplace({image, sampler}, 0);
    if (!is_new) return entry->second;
    Texture texture = texture_without_texels(index, place);
    EncodedImage encoded = encoded_image(document_, image);
    texture.make_empty_levels(encoded.width, encoded.height);
    texture.decode = std::move(encoded.decode);
    entry->second = static_cast<std::int32_t>(resources_.textures.size());
    resources_.textures.push_back(std::move(texture));
    return entry->second;
}

// Whoever asks for the texels learns what is wrong with the image; the others do without.
std::int32_t Materials::use_map(int index, bool srgb, std::string_view place) {
    const int image = image_of(index, place);
    if (image < 0) return -1;
    const int sampler = document_.model().textures[static_cast<std::size_t>(index)].sampler;
    const auto [entry, is_new] = maps_.try_emplace({image, sampler, srgb}, 0);
    if (!is_new) return entry->second;
    pipeline::LateTexture map;
    map.texture = texture_without_texels(index, place);
    map.texture.srgb = srgb;
    map.make = [empty = map.texture, read = late_image(document_, image)] {
        Texture made = empty;
        const EncodedImage encoded = read();
        made.make_empty_levels(encoded.width, encoded.height);
        made.levels[0].rgba = encoded.decode();
        made.make_mips();
        return made;
    };
    entry->second = static_cast<std::int32_t>(resources_.maps.size());
    resources_.maps.push_back(std::move(map));
    return entry->second;
}

void Materials::read_texture(Material& material, const tinygltf::TextureInfo& info, std::string_view place) {
    const auto [set, transform] = coordinates_of(info);
    material.uv_transform = transform;
    if (!is_read_set(document_, set, place)) return;
    material.texcoord = static_cast<std::uint8_t>(set);
    material.base_texture = use_texture(info.index, place);
}

template <class Info>
pipeline::MaterialMap Materials::map_of(const Info& info, bool srgb, std::string_view place) {
    if (info.index < 0) return {};
    const auto [set, transform] = coordinates_of(info);
    if (!is_read_set(document_, set, place)) return {};
    return {use_map(info.index, srgb, place), static_cast<std::uint8_t>(set), transform};
}

void Materials::read_maps(pipeline::MaterialMaps& maps, const tinygltf::Material& source, std::string_view place) {
    const auto& base = source.pbrMetallicRoughness;
    maps.normal = map_of(source.normalTexture, false, place);
    maps.normal_scale = static_cast<float>(source.normalTexture.scale);
    maps.roughness = map_of(base.metallicRoughnessTexture, false, place);
    maps.metallic_factor = static_cast<float>(base.metallicFactor);
    maps.roughness_factor = static_cast<float>(base.roughnessFactor);
    maps.emissive = map_of(source.emissiveTexture, true, place);
    document_.require(source.emissiveFactor.size() == 3, place, "3 numbers in emissiveFactor, got {}",
                      source.emissiveFactor.size());
    for (int i = 0; i < 3; ++i)
        maps.emissive_factor[i] = static_cast<float>(source.emissiveFactor[static_cast<std::size_t>(i)]);
    const auto* specular = extension(source.extensions, "KHR_materials_specular");
    if (specular == nullptr) return;
    maps.specular_factor = static_cast<float>(number_in(*specular, "specularFactor", 1.0));
    if (!specular->Has("specularTexture") || !specular->Get("specularTexture").IsObject()) return;
    const tinygltf::Value& texture = specular->Get("specularTexture");
    tinygltf::TextureInfo info;
    info.index = static_cast<int>(number_in(texture, "index", -1.0));
    info.texCoord = static_cast<int>(number_in(texture, "texCoord", 0.0));
    if (texture.Has("extensions") && texture.Get("extensions").Has("KHR_texture_transform"))
        info.extensions["KHR_texture_transform"] = texture.Get("extensions").Get("KHR_texture_transform");
    maps.specular = map_of(info, false, place);
}

Material Materials::read(const tinygltf::Material& source, std::string_view place) {
    const auto& base = source.pbrMetallicRoughness;
    document_.require(base.baseColorFactor.size() == 4, place, "4 numbers in baseColorFactor, got {}",
                      base.baseColorFactor.size());
    Material material;
    material.name = source.name;
    for (int i = 0; i < 4; ++i)
        material.base_colour[i] = static_cast<float>(base.baseColorFactor[static_cast<std::size_t>(i)]);
    material.alpha_mode = alpha_mode_of(document_, source.alphaMode, place);
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    material.double_sided = source.doubleSided;
    material.unlit = extension(source.extensions, "KHR_materials_unlit") != nullptr;
    if (const auto* transmission = extension(source.extensions, "KHR_materials_transmission"))
        material.transmission = static_cast<float>(number_in(*transmission, "transmissionFactor", 0.0));
    if (base.baseColorTexture.index >= 0) read_texture(material, base.baseColorTexture, place);
    read_maps(material.maps, source, place);
    return material;
}

std::uint32_t Materials::use(int index, std::string_view place) {
    const auto [entry, is_new] = materials_.try_emplace(index, static_cast<std::uint32_t>(resources_.materials.size()));
    if (!is_new) return entry->second;
    Material material;
    material.name = "default";
    if (index != -1) {
        const auto& source = document_.at(document_.model().materials, index, place, "material");
        material = read(source, place_of("material", static_cast<std::size_t>(index), source.name));
    }
    resources_.materials.push_back(std::move(material));
    return entry->second;
}

} // namespace traces::gltf
