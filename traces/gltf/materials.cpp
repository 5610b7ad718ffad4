#include "traces/gltf/materials.hpp"

#include "traces/gltf/images.hpp"

#include <cmath>

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

} // namespace

std::int32_t Materials::use_texture(int index, std::string_view place) {
    const auto& model = document_.model();
    const auto& source = document_.at(model.textures, index, place, "texture");
    int image = source.source;
    if (const auto* webp = extension(source.extensions, "EXT_texture_webp"); webp != nullptr && webp->Has("source"))
        image = webp->Get("source").GetNumberAsInt();
    if (image < 0) {
        const bool basis = extension(source.extensions, "KHR_texture_basisu") != nullptr;
        document_.notes.push_back(fmt::format("texture {} has no PNG, JPEG or WebP image{} and is left out", index,
                                              basis ? " (KTX2 is not read)" : ""));
        return -1;
    }
    const auto [entry, is_new] = textures_.try_emplace({image, source.sampler}, 0);
    if (!is_new) return entry->second;
    Texture texture;
    texture.name = place_of("texture", static_cast<std::size_t>(index), source.name);
    if (source.sampler >= 0) {
        const auto& sampler = document_.at(model.samplers, source.sampler, texture.name, "sampler");
        texture.wrap_u = wrap_of(sampler.wrapS);
        texture.wrap_v = wrap_of(sampler.wrapT);
        texture.min_filter = min_filter_of(sampler.minFilter);
        if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) texture.mag_filter = Filter::nearest;
    }
    EncodedImage encoded = encoded_image(document_, image);
    texture.make_empty_levels(encoded.width, encoded.height);
    texture.decode = std::move(encoded.decode);
    entry->second = static_cast<std::int32_t>(resources_.textures.size());
    resources_.textures.push_back(std::move(texture));
    return entry->second;
}

void Materials::read_texture(Material& material, const tinygltf::TextureInfo& info, std::string_view place) {
    int set = info.texCoord;
    if (const auto* transform = extension(info.extensions, "KHR_texture_transform")) {
        material.uv_transform = uv_transform(*transform);
        set = static_cast<int>(number_in(*transform, "texCoord", set));
    }
    if (set < 0 || set > 1) {
        document_.notes.push_back(
            fmt::format("{}: texture coordinates {} are not read, its texture is left out", place, set));
        return;
    }
    material.texcoord = static_cast<std::uint8_t>(set);
    material.base_texture = use_texture(info.index, place);
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
