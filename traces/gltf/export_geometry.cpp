#include "traces/gltf/export_geometry.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "traces/preparation/formats.hpp"
#include "traces/preparation/triangle_mesh.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>

namespace traces::gltf {

using pipeline::ComponentType;
using pipeline::Geometry;
using pipeline::IndexType;
using pipeline::Semantic;
using pipeline::Slot;
using pipeline::VertexAttribute;

namespace {

constexpr std::uint32_t largest_stride = 252; ///< glTF 2.0, section 5.11.4

std::string attribute_name(Semantic semantic) {
    switch (semantic) {
    case Semantic::position:
        return "POSITION";
    case Semantic::normal:
        return "NORMAL";
    case Semantic::colour:
        return "COLOR_0";
    case Semantic::secondary_colour:
        return "COLOR_1";
    case Semantic::generic:
        return "_GENERIC";
    default:
        return fmt::format("TEXCOORD_{}", static_cast<unsigned>(semantic) - static_cast<unsigned>(Semantic::texcoord0));
    }
}

int component_type_of(ComponentType type) {
    switch (type) {
    case ComponentType::s8:
        return 5120;
    case ComponentType::u8:
        return 5121;
    case ComponentType::s16:
        return 5122;
    case ComponentType::u16:
        return 5123;
    case ComponentType::u32:
        return 5125;
    default:
        return 5126;
    }
}

const char* type_name(std::uint32_t components) {
    static constexpr std::array<const char*, 4> names{"SCALAR", "VEC2", "VEC3", "VEC4"};
    return names.at(components - 1);
}

/// How glTF takes an attribute.
enum class Fit : std::uint8_t { core, quantised, none };

Fit fit_of(const VertexAttribute& attribute) {
    const bool is_float = attribute.type == ComponentType::f32, normalized = attribute.normalized;
    const bool is_unsigned = attribute.type == ComponentType::u8 || attribute.type == ComponentType::u16;
    const bool is_signed = attribute.type == ComponentType::s8 || attribute.type == ComponentType::s16;
    if (!is_float && !is_unsigned && !is_signed) return Fit::none;
    switch (pipeline::slot_of(attribute.semantic)) {
    case Slot::position:
        return attribute.components != 3 ? Fit::none : is_float ? Fit::core : Fit::quantised;
    case Slot::normal:
        if (attribute.components != 3 || is_unsigned || (is_signed && !normalized)) return Fit::none;
        return is_float ? Fit::core : Fit::quantised;
    case Slot::colour:
        return attribute.components >= 3 && (is_float || (is_unsigned && normalized)) ? Fit::core : Fit::none;
    case Slot::texcoord:
        if (attribute.components != 2) return Fit::none;
        return is_float || (is_unsigned && normalized) ? Fit::core : Fit::quantised;
    case Slot::generic:
        break;
    }
    return Fit::core; // an attribute of one's own may have any format
}

VertexAttribute as_floats(const VertexAttribute& attribute) {
    std::uint8_t components = attribute.components;
    const Slot slot = pipeline::slot_of(attribute.semantic);
    if (slot == Slot::position || slot == Slot::normal) components = 3;
    if (slot == Slot::texcoord) components = 2;
    if (slot == Slot::colour) components = std::max<std::uint8_t>(components, 3) == 3 ? 3 : 4;
    return with_format(attribute, ComponentType::f32, components, false);
}

bool lies_as_gltf_wants(const TriangleMesh& mesh) {
    for (const VertexAttribute& attribute : mesh.attributes)
        if (attribute.offset % 4 != 0 || attribute.stride % 4 != 0 || attribute.stride > largest_stride) return false;
    return true;
}

Grouping narrow(const Columns& columns, const Grouping& groups) {
    Grouping result;
    for (const std::vector<std::size_t>& group : groups) {
        std::uint32_t stride = 0;
        for (const std::size_t i : group) stride += columns[i].format.bytes() + 3;
        if (stride <= largest_stride) {
            result.push_back(group);
            continue;
        }
        for (const std::size_t i : group) result.push_back({i});
    }
    return result;
}

/// Changes what glTF cannot say; leaves everything else where it lies.
void adapt(GlbFile& file, TriangleMesh& mesh) {
    bool changes = !lies_as_gltf_wants(mesh);
    for (const VertexAttribute& attribute : mesh.attributes) changes = changes || fit_of(attribute) == Fit::none;
    if (!changes) return;
    Columns columns = columns_of(mesh);
    for (Column& column : columns) {
        if (fit_of(column.format) != Fit::none) continue;
        file.notes.push_back(
            fmt::format("{}: {} is written as floats", mesh.name, attribute_name(column.format.semantic)));
        column = column_from(as_floats(column.format), values_of(column));
    }
    lay_out(mesh, columns, narrow(columns, grouping_of(mesh)), 4);
}

/// Least and greatest of each axis, as stored: glTF does not normalise them.
std::array<glm::dvec3, 2> bounds_of(const TriangleMesh& mesh, VertexAttribute position) {
    position.normalized = false;
    const pipeline::AttributeReader read(mesh.streams[position.buffer].records.data(), position);
    glm::dvec3 lo(std::numeric_limits<double>::max()), hi(std::numeric_limits<double>::lowest());
    for (std::uint32_t i = 0; i < mesh.vertices; ++i) {
        const glm::dvec3 value{glm::vec3(read(i))};
        lo = glm::min(lo, value);
        hi = glm::max(hi, value);
    }
    return {lo, hi};
}

nlohmann::ordered_json export_attributes(GlbFile& file, const TriangleMesh& mesh) {
    std::vector<std::size_t> views;
    for (const TriangleMesh::Stream& stream : mesh.streams)
        views.push_back(file.add_view(stream.records, stream.stride, vertex_target));
    auto attributes = nlohmann::ordered_json::object();
    for (const VertexAttribute& attribute : mesh.attributes) {
        nlohmann::ordered_json accessor = {{"bufferView", views[attribute.buffer]},
                                           {"byteOffset", attribute.offset},
                                           {"componentType", component_type_of(attribute.type)},
                                           {"count", mesh.vertices},
                                           {"type", type_name(attribute.components)}};
        if (attribute.normalized && attribute.type != ComponentType::f32) accessor["normalized"] = true;
        if (attribute.semantic == Semantic::position) {
            const auto [lo, hi] = bounds_of(mesh, attribute);
            accessor["min"] = {lo.x, lo.y, lo.z};
            accessor["max"] = {hi.x, hi.y, hi.z};
        }
        if (fit_of(attribute) == Fit::quantised) file.use_extension("KHR_mesh_quantization", true);
        attributes[attribute_name(attribute.semantic)] = file.add("accessors", std::move(accessor));
    }
    return attributes;
}

/// The type of the file's indices: glTF keeps the largest value of each free (section 3.7.2.1).
IndexType index_type_of(GlbFile& file, const TriangleMesh& mesh, IndexType wanted) {
    const std::uint32_t largest = *std::max_element(mesh.indices.begin(), mesh.indices.end());
    IndexType type = std::max(wanted, IndexType::u8);
    while (type != IndexType::u32 && largest >= pipeline::restart_index(type))
        type = static_cast<IndexType>(static_cast<int>(type) + 1);
    if (wanted != IndexType::none && type != wanted)
        file.notes.push_back(
            fmt::format("{}: index {} is written with {} bits", mesh.name, largest, 8 * pipeline::bytes_of(type)));
    return type;
}

std::size_t export_indices(GlbFile& file, const TriangleMesh& mesh, IndexType wanted) {
    const IndexType type = index_type_of(file, mesh, wanted);
    const std::uint32_t size = pipeline::bytes_of(type);
    std::vector<std::byte> bytes(mesh.indices.size() * size);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        for (std::uint32_t byte = 0; byte < size; ++byte)
            bytes[i * size + byte] = static_cast<std::byte>(mesh.indices[i] >> (8 * byte) & 0xFFU);
    const int component_type = type == IndexType::u8 ? 5121 : type == IndexType::u16 ? 5123 : 5125;
    return file.add("accessors", {{"bufferView", file.add_view(bytes, 0, index_target)},
                                  {"componentType", component_type},
                                  {"count", mesh.indices.size()},
                                  {"type", "SCALAR"}});
}

} // namespace

std::optional<nlohmann::ordered_json> export_geometry(GlbFile& file, const pipeline::Resources& resources,
                                                      const Geometry& geometry) {
    const TopologyWanted wanted = geometry.primitive_restart ? TopologyWanted::list : TopologyWanted::as_it_is;
    if (geometry.primitive_restart)
        file.notes.push_back(fmt::format("{}: strips with primitive restart are written as a list", geometry.name));
    TriangleMesh mesh = take_mesh(resources, geometry, wanted);
    if (mesh.indices.size() < 3) {
        file.notes.push_back(fmt::format("{}: has no triangles and is left out", geometry.name));
        return std::nullopt;
    }
    adapt(file, mesh);
    nlohmann::ordered_json primitive;
    primitive["attributes"] = export_attributes(file, mesh);
    bool counts_up = geometry.index_type == IndexType::none && mesh.indices.size() == mesh.vertices;
    for (std::uint32_t i = 0; counts_up && i < mesh.vertices; ++i) counts_up = mesh.indices[i] == i;
    if (!counts_up) primitive["indices"] = export_indices(file, mesh, geometry.index_type);
    if (mesh.topology == pipeline::Topology::triangle_strip) primitive["mode"] = 5;
    if (mesh.topology == pipeline::Topology::triangle_fan) primitive["mode"] = 6;
    return primitive;
}

std::size_t export_floats(GlbFile& file, std::span<const float> values, std::uint32_t components) {
    return file.add("accessors", {{"bufferView", file.add_view(std::as_bytes(values))},
                                  {"componentType", 5126},
                                  {"count", values.size() / components},
                                  {"type", type_name(components)}});
}

} // namespace traces::gltf
