#include "traces/gltf/decompress.hpp"

#include "sim/check.hpp"
#include "traces/child_process.hpp"
#include "traces/draco_module/draco_module.h"
#include "traces/meshopt_module/meshopt_module.h"

namespace traces::gltf {

namespace {

constexpr const char* meshopt_name = "EXT_meshopt_compression";
constexpr const char* draco_name = "KHR_draco_mesh_compression";
constexpr std::size_t largest_part = std::size_t{1} << 31U;

template <class Module>
const Module& module_of(const char* file, const char* function, std::uint32_t version, const char* purpose,
                        const char* package) {
    const auto* table = load_module<Module>(file, function, purpose, package);
    if (table == nullptr || table->version != version)
        throw sim::InputError(fmt::format("{} needs {} of this version of ropsim", purpose, file));
    return *table;
}

const RopsimMeshoptModule& meshopt_module() {
    return module_of<RopsimMeshoptModule>("ropsim_meshopt.so", ROPSIM_MESHOPT_MODULE_FUNCTION,
                                          ROPSIM_MESHOPT_MODULE_VERSION, meshopt_name, "libmeshoptimizer2d");
}

const RopsimDracoModule& draco_module() {
    return module_of<RopsimDracoModule>("ropsim_draco.so", ROPSIM_DRACO_MODULE_FUNCTION, ROPSIM_DRACO_MODULE_VERSION,
                                        draco_name, "libdraco7");
}

std::size_t number_in(const tinygltf::Value& object, const char* key) {
    return object.Has(key) ? static_cast<std::size_t>(object.Get(key).GetNumberAsInt()) : 0;
}

std::string text_in(const tinygltf::Value& object, const char* key, const char* fallback) {
    return object.Has(key) ? object.Get(key).Get<std::string>() : fallback;
}

template <class Work>
std::vector<unsigned char> decoded(const Document& document, const std::string& place, std::size_t size, Work work) {
    document.require(size <= largest_part, place, "at most {} bytes when decoded, got {}", largest_part, size);
    ChildResult result = in_child_process(size, work);
    document.require(result.failure.empty(), place, "data that can be decoded: {}", result.failure);
    return std::move(result.bytes);
}

std::uint32_t component_bytes(int type) {
    return static_cast<std::uint32_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
}

int add_view(tinygltf::Model& model, std::vector<unsigned char> bytes) {
    tinygltf::BufferView view;
    view.buffer = static_cast<int>(model.buffers.size());
    view.byteLength = bytes.size();
    model.buffers.emplace_back().data = std::move(bytes);
    model.bufferViews.push_back(std::move(view));
    return static_cast<int>(model.bufferViews.size()) - 1;
}

void decode_view(const Document& document, tinygltf::Model& model, std::size_t index) {
    const auto found = model.bufferViews[index].extensions.find(meshopt_name);
    if (found == model.bufferViews[index].extensions.end()) return;
    const tinygltf::Value source = found->second;
    const std::string place = fmt::format("bufferViews[{}].extensions.{}", index, meshopt_name);
    const std::string mode = text_in(source, "mode", ""), filter = text_in(source, "filter", "NONE");
    const auto mode_number = mode == "ATTRIBUTES"  ? ROPSIM_MESHOPT_ATTRIBUTES
                             : mode == "TRIANGLES" ? ROPSIM_MESHOPT_TRIANGLES
                                                   : ROPSIM_MESHOPT_INDICES;
    const auto filter_number = filter == "OCTAHEDRAL"    ? ROPSIM_MESHOPT_OCTAHEDRAL
                               : filter == "QUATERNION"  ? ROPSIM_MESHOPT_QUATERNION
                               : filter == "EXPONENTIAL" ? ROPSIM_MESHOPT_EXPONENTIAL
                                                         : ROPSIM_MESHOPT_NONE;
    const std::size_t count = number_in(source, "count"), stride = number_in(source, "byteStride");
    const std::size_t offset = number_in(source, "byteOffset"), length = number_in(source, "byteLength");
    const std::vector<unsigned char>& bytes = model.buffers.at(number_in(source, "buffer")).data;
    document.require(length <= bytes.size() && offset <= bytes.size() - length, place,
                     "byteLength {} from byteOffset {} within its buffer of {} bytes", length, offset, bytes.size());
    const std::size_t size = count * stride;
    document.require(size == model.bufferViews[index].byteLength, place,
                     "count times byteStride to be the bufferView's byteLength {}, got {}",
                     model.bufferViews[index].byteLength, size);
    const RopsimMeshoptModule& module = meshopt_module();
    auto values = decoded(document, place, size, [&](std::span<unsigned char> out, std::span<char> line) {
        return module.decode(bytes.data() + offset, length, mode_number, filter_number, count, stride, out.data(),
                             line.data(), line.size());
    });
    model.bufferViews[index].buffer = static_cast<int>(model.buffers.size());
    model.bufferViews[index].byteOffset = 0;
    model.buffers.emplace_back().data = std::move(values);
}

/// What a primitive's accessors are to hold, one after the other in the decoded bytes.
struct DracoPart {
    int accessor;
    RopsimDracoAttribute attribute;
    std::size_t offset, size;
};

void decode_primitive(const Document& document, tinygltf::Model& model, tinygltf::Primitive& primitive,
                      const std::string& place) {
    const auto found = primitive.extensions.find(draco_name);
    if (found == primitive.extensions.end()) return;
    document.require(primitive.mode == TINYGLTF_MODE_TRIANGLES, place, "a primitive of mode 4, got {}", primitive.mode);
    document.require(primitive.indices >= 0, place, "a primitive with indices");
    const tinygltf::Value& ids = found->second.Get("attributes");
    std::vector<DracoPart> parts;
    std::size_t size = 0;
    const auto room_for = [&](int accessor, std::uint32_t id) {
        const tinygltf::Accessor& data = document.at(model.accessors, accessor, place, "accessor");
        const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(data.type));
        document.require(components >= 1 && components <= 4, place, "accessors of 1 to 4 components");
        const auto wide = static_cast<std::uint32_t>(components);
        const std::size_t bytes = data.count * wide * component_bytes(data.componentType);
        parts.push_back({accessor, {id, static_cast<std::uint32_t>(data.componentType), wide, nullptr}, size, bytes});
        size = (size + bytes + 3) / 4 * 4;
    };
    room_for(primitive.indices, 0);
    for (const std::string& name : ids.Keys()) {
        const auto accessor = primitive.attributes.find(name);
        document.require(accessor != primitive.attributes.end(), place, "{} among the primitive's attributes, too",
                         name);
        room_for(accessor->second, static_cast<std::uint32_t>(ids.Get(name).GetNumberAsInt()));
        document.require(model.accessors[static_cast<std::size_t>(accessor->second)].count ==
                             model.accessors[static_cast<std::size_t>(parts.at(1).accessor)].count,
                         place, "attributes of the same count");
    }
    document.require(parts.size() > 1, place, "at least one of its attributes");
    const auto bytes = document.view_bytes(found->second.Get("bufferView").GetNumberAsInt(), place);
    const RopsimDracoModule& module = draco_module();
    const auto values = decoded(document, place, size, [&](std::span<unsigned char> out, std::span<char> line) {
        std::vector<RopsimDracoAttribute> attributes;
        for (std::size_t i = 1; i < parts.size(); ++i) {
            attributes.push_back(parts[i].attribute);
            attributes.back().values = out.data() + parts[i].offset;
        }
        const auto count_of = [&](std::size_t part) {
            return static_cast<std::uint32_t>(model.accessors[static_cast<std::size_t>(parts[part].accessor)].count);
        };
        const RopsimDracoMesh mesh{count_of(1),
                                   attributes.data(),
                                   static_cast<std::uint32_t>(attributes.size()),
                                   parts[0].attribute.component_type,
                                   count_of(0),
                                   out.data() + parts[0].offset};
        return module.decode(bytes.data(), bytes.size(), &mesh, line.data(), line.size());
    });
    for (const DracoPart& part : parts) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(part.offset);
        const int view = add_view(model, {begin, begin + static_cast<std::ptrdiff_t>(part.size)});
        tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(part.accessor)];
        accessor.bufferView = view;
        accessor.byteOffset = 0;
    }
}

} // namespace

void decompress(const Document& document, tinygltf::Model& model) {
    for (std::size_t i = 0; i < model.bufferViews.size(); ++i) decode_view(document, model, i);
    for (std::size_t m = 0; m < model.meshes.size(); ++m)
        for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p)
            decode_primitive(document, model, model.meshes[m].primitives[p],
                             fmt::format("meshes[{}].primitives[{}].extensions.{}", m, p, draco_name));
}

} // namespace traces::gltf
