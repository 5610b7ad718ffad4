#include "traces/gltf/properties.hpp"

#include <array>

namespace traces::gltf {

namespace {

constexpr double largest_whole = std::numeric_limits<std::int32_t>::max();
constexpr double largest_float = 3.4028234e38;
constexpr double right_angle = 1.5707964;

constexpr Shape whole(double least = 0.0, double most = largest_whole) {
    return {.kind = Kind::whole, .of = {}, .least = least, .most = most};
}
constexpr Shape number(double least = -largest_float, double most = largest_float) {
    return {.kind = Kind::number, .of = {}, .least = least, .most = most};
}
constexpr Shape above_zero(double most = largest_float) {
    return {.kind = Kind::number, .of = {}, .least = 0.0, .most = most, .above = true};
}
constexpr Shape one_of(std::string_view values) { return {.kind = Kind::one_of, .of = values}; }
constexpr Shape words(std::string_view values) { return {.kind = Kind::words, .of = values}; }
constexpr Shape index_in(std::string_view list) { return {.kind = Kind::index, .of = list}; }
constexpr Shape object(std::string_view type) { return {.kind = Kind::object, .of = type}; }
constexpr Shape flag{.kind = Kind::flag};
constexpr Shape text{.kind = Kind::text};

constexpr Shape unit = number(0.0, 1.0);
constexpr std::size_t any = std::numeric_limits<std::size_t>::max();

// glTF 2.0, chapter 5 (properties reference), and the specifications of the extensions.
constexpr auto table = std::to_array<Property>({
    {"", "name", text.unread()},

    {"document", "asset", object("asset").needed()},
    {"document", "extensionsUsed", text.list(1).unique()},
    {"document", "extensionsRequired", text.list(1).unique()},
    {"document", "extensions", object("document.extensions")},
    {"document", "scene", index_in("/scenes")},
    {"document", "scenes", object("scene").list(0)},
    {"document", "nodes", object("node").list(0)},
    {"document", "meshes", object("mesh").list(0)},
    {"document", "skins", object("skin").list(0)},
    {"document", "cameras", object("camera").list(0)},
    {"document", "materials", object("material").list(0)},
    {"document", "textures", object("texture").list(0)},
    {"document", "samplers", object("sampler").list(0)},
    {"document", "images", object("image").list(0)},
    {"document", "accessors", object("accessor").list(0)},
    {"document", "bufferViews", object("bufferView").list(0)},
    {"document", "buffers", object("buffer").list(0)},
    {"document", "animations", object("animation").list(0).unread()},

    {"asset", "version", text.needed()},
    {"asset", "minVersion", text},
    {"asset", "generator", text.unread()},
    {"asset", "copyright", text.unread()},

    {"document.extensions", "KHR_lights_punctual", object("lights")},
    {"lights", "lights", object("light").list(1).needed()},
    {"light", "type", words("directional|point|spot").needed()},
    {"light", "color", unit.list(3, 3)},
    {"light", "intensity", number(0.0)},
    {"light", "range", above_zero()},
    {"light", "spot", object("light.spot")},
    {"light.spot", "innerConeAngle", number(0.0, right_angle)},
    {"light.spot", "outerConeAngle", above_zero(right_angle)},

    {"scene", "nodes", index_in("/nodes").list(1).unique()},

    {"node", "camera", index_in("/cameras")},
    {"node", "children", index_in("/nodes").list(1).unique()},
    {"node", "skin", index_in("/skins")},
    {"node", "mesh", index_in("/meshes")},
    {"node", "matrix", number().list(16, 16)},
    {"node", "translation", number().list(3, 3)},
    {"node", "rotation", number().list(4, 4)},
    {"node", "scale", number().list(3, 3)},
    {"node", "weights", number().list(1)},
    {"node", "extensions", object("node.extensions")},
    {"node.extensions", "EXT_mesh_gpu_instancing", object("instancing")},
    {"node.extensions", "KHR_lights_punctual", object("node.light")},
    {"node.extensions", "KHR_node_visibility", object("visibility")},
    {"instancing", "attributes", object("attributes").needed()},
    {"node.light", "light", index_in("/extensions/KHR_lights_punctual/lights").needed()},
    {"visibility", "visible", flag},

    {"mesh", "primitives", object("primitive").list(1).needed()},
    {"mesh", "weights", number().list(1)},
    {"primitive", "attributes", object("attributes").needed()},
    {"primitive", "indices", index_in("/accessors")},
    {"primitive", "material", index_in("/materials")},
    {"primitive", "mode", whole(0.0, 6.0)},
    {"primitive", "targets", object("attributes").list(1)},
    {"primitive", "extensions", object("primitive.extensions")},
    {"attributes", "*", index_in("/accessors")},
    {"primitive.extensions", "KHR_draco_mesh_compression", object("draco")},
    {"draco", "bufferView", index_in("/bufferViews").needed()},
    {"draco", "attributes", object("draco.attributes").needed()},
    {"draco.attributes", "*", whole()},

    {"skin", "inverseBindMatrices", index_in("/accessors")},
    {"skin", "skeleton", index_in("/nodes").unread()},
    {"skin", "joints", index_in("/nodes").list(1).unique().needed()},

    {"camera", "type", words("perspective|orthographic").needed()},
    {"camera", "perspective", object("perspective")},
    {"camera", "orthographic", object("orthographic")},
    {"perspective", "yfov", above_zero(3.14158).needed()},
    {"perspective", "aspectRatio", above_zero()},
    {"perspective", "znear", above_zero().needed()},
    {"perspective", "zfar", above_zero()},
    {"orthographic", "xmag", above_zero().needed()},
    {"orthographic", "ymag", above_zero().needed()},
    {"orthographic", "znear", number(0.0).needed()},
    {"orthographic", "zfar", above_zero().needed()},

    {"material", "pbrMetallicRoughness", object("pbrMetallicRoughness")},
    {"material", "normalTexture", object("normalTexture")},
    {"material", "occlusionTexture", object("occlusionTexture").unread()},
    {"material", "emissiveTexture", object("textureInfo")},
    {"material", "emissiveFactor", unit.list(3, 3)},
    {"material", "alphaMode", words("OPAQUE|MASK|BLEND")},
    {"material", "alphaCutoff", number(0.0)},
    {"material", "doubleSided", flag},
    {"material", "extensions", object("material.extensions")},
    {"pbrMetallicRoughness", "baseColorFactor", unit.list(4, 4)},
    {"pbrMetallicRoughness", "baseColorTexture", object("textureInfo")},
    {"pbrMetallicRoughness", "metallicFactor", unit},
    {"pbrMetallicRoughness", "roughnessFactor", unit},
    {"pbrMetallicRoughness", "metallicRoughnessTexture", object("textureInfo")},
    {"textureInfo", "index", index_in("/textures").needed()},
    {"textureInfo", "texCoord", whole()},
    {"textureInfo", "extensions", object("textureInfo.extensions")},
    {"normalTexture", "index", index_in("/textures").needed()},
    {"normalTexture", "texCoord", whole()},
    {"normalTexture", "scale", number()},
    {"normalTexture", "extensions", object("textureInfo.extensions")},
    {"occlusionTexture", "index", index_in("/textures").needed()},
    {"occlusionTexture", "texCoord", whole()},
    {"occlusionTexture", "strength", unit},
    {"textureInfo.extensions", "KHR_texture_transform", object("textureTransform")},
    {"textureTransform", "offset", number().list(2, 2)},
    {"textureTransform", "rotation", number()},
    {"textureTransform", "scale", number().list(2, 2)},
    {"textureTransform", "texCoord", whole()},
    {"material.extensions", "KHR_materials_specular", object("specular")},
    {"specular", "specularFactor", unit},
    {"specular", "specularTexture", object("textureInfo")},
    {"specular", "specularColorFactor", number(0.0).list(3, 3).unread()},
    {"specular", "specularColorTexture", object("textureInfo").unread()},
    {"material.extensions", "KHR_materials_transmission", object("transmission")},
    {"material.extensions", "KHR_materials_unlit", object("unlit")},
    {"transmission", "transmissionFactor", unit},
    {"transmission", "transmissionTexture", object("textureInfo").unread()},

    {"texture", "sampler", index_in("/samplers")},
    {"texture", "source", index_in("/images")},
    {"texture", "extensions", object("texture.extensions")},
    {"texture.extensions", "EXT_texture_webp", object("texture.image")},
    {"texture.extensions", "KHR_texture_basisu", object("texture.image")},
    {"texture.image", "source", index_in("/images")},
    {"sampler", "magFilter", one_of("9728|9729")},
    {"sampler", "minFilter", one_of("9728|9729|9984|9985|9986|9987")},
    {"sampler", "wrapS", one_of("33071|33648|10497")},
    {"sampler", "wrapT", one_of("33071|33648|10497")},
    {"image", "uri", text},
    {"image", "mimeType", text.unread()},
    {"image", "bufferView", index_in("/bufferViews")},

    {"accessor", "bufferView", index_in("/bufferViews")},
    {"accessor", "byteOffset", whole()},
    {"accessor", "componentType", one_of("5120|5121|5122|5123|5125|5126").needed()},
    {"accessor", "normalized", flag},
    {"accessor", "count", whole(1.0).needed()},
    {"accessor", "type", words("SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4").needed()},
    {"accessor", "max", number(-1e308, 1e308).list(1, 16).unread()},
    {"accessor", "min", number(-1e308, 1e308).list(1, 16).unread()},
    {"accessor", "sparse", object("sparse")},
    {"sparse", "count", whole(1.0).needed()},
    {"sparse", "indices", object("sparse.indices").needed()},
    {"sparse", "values", object("sparse.values").needed()},
    {"sparse.indices", "bufferView", index_in("/bufferViews").needed()},
    {"sparse.indices", "byteOffset", whole()},
    {"sparse.indices", "componentType", one_of("5121|5123|5125").needed()},
    {"sparse.values", "bufferView", index_in("/bufferViews").needed()},
    {"sparse.values", "byteOffset", whole()},

    {"bufferView", "buffer", index_in("/buffers").needed()},
    {"bufferView", "byteOffset", whole()},
    {"bufferView", "byteLength", whole(1.0).needed()},
    {"bufferView", "byteStride", whole(0.0, 252.0)}, // 0, as older exporters write it, is the same as none
    {"bufferView", "target", one_of("34962|34963").unread()},
    {"bufferView", "extensions", object("bufferView.extensions")},
    {"bufferView.extensions", "EXT_meshopt_compression", object("meshopt")},
    {"meshopt", "buffer", index_in("/buffers").needed()},
    {"meshopt", "byteOffset", whole()},
    {"meshopt", "byteLength", whole(1.0).needed()},
    {"meshopt", "byteStride", whole(1.0, 256.0).needed()},
    {"meshopt", "count", whole(1.0).needed()},
    {"meshopt", "mode", words("ATTRIBUTES|TRIANGLES|INDICES").needed()},
    {"meshopt", "filter", words("NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL")},
    {"buffer", "uri", text},
    {"buffer", "byteLength", whole(1.0).needed()},
    {"buffer", "extensions", object("buffer.extensions")},
    {"buffer.extensions", "EXT_meshopt_compression", object("meshopt.buffer")},
    {"meshopt.buffer", "fallback", flag},

    {"animation", "channels", object("channel").list(1, any).needed()},
    {"animation", "samplers", object("animation.sampler").list(1, any).needed()},
    {"channel", "sampler", whole().needed()},
    {"channel", "target", object("channel.target").needed()},
    {"channel.target", "node", index_in("/nodes")},
    {"channel.target", "path", text.needed()},
    {"animation.sampler", "input", index_in("/accessors").needed()},
    {"animation.sampler", "interpolation", words("LINEAR|STEP|CUBICSPLINE")},
    {"animation.sampler", "output", index_in("/accessors").needed()},
});

constexpr auto extensions = std::to_array<std::string_view>({
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
});

} // namespace

std::span<const Property> properties() { return table; }
std::span<const std::string_view> read_extensions() { return extensions; }

} // namespace traces::gltf
