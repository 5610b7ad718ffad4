// A mesh as buffers of a scene.
#include "sim/check.hpp"
#include "traces/generators/mesh.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace traces {

using pipeline::ComponentType;
using pipeline::Geometry;
using pipeline::IndexType;
using pipeline::Resources;
using pipeline::Semantic;
using pipeline::VertexAttribute;

namespace {

constexpr std::uint32_t vertices_of_16_bits = 65536;

std::uint32_t rounded_up(std::uint32_t value, std::uint32_t to) { return (value + to - 1) / to * to; }

struct Box {
    glm::dvec3 lo{0.0}, hi{0.0};

    Box(const std::vector<glm::vec3>& positions, const MeshPart& part) {
        for (std::uint32_t i = 0; i < part.vertices; ++i) {
            const glm::dvec3 position(positions[part.first_vertex + i]);
            lo = i == 0 ? position : glm::min(lo, position);
            hi = i == 0 ? position : glm::max(hi, position);
        }
    }
};

std::vector<AttributeFormat> attributes_of(const Mesh& mesh, const MeshFormat& format) {
    if (format.attributes) return *format.attributes;
    std::vector<AttributeFormat> list;
    if (!mesh.normals.empty()) list.push_back({Semantic::normal, ComponentType::f32, 3});
    if (!mesh.colours.empty()) list.push_back({Semantic::colour, ComponentType::u8, 4});
    return list;
}

std::string name_of(Semantic semantic) {
    switch (slot_of(semantic)) {
    case pipeline::Slot::position:
        return "positions";
    case pipeline::Slot::normal:
        return "normals";
    case pipeline::Slot::colour:
        return semantic == Semantic::colour ? "colours" : "secondary colours";
    case pipeline::Slot::texcoord:
        return std::string(sim::enum_name(semantic));
    case pipeline::Slot::generic:
        break;
    }
    return "generic";
}

/// Values of the attributes of one part.
class VertexValues {
  public:
    VertexValues(const Mesh& mesh, const Box& mesh_box, const PositionGrid* grid)
        : mesh_(mesh), lo_(mesh_box.lo), grid_(grid) {
        for (int axis = 0; axis < 3; ++axis)
            if (mesh_box.hi[axis] > lo_[axis]) per_extent_[axis] = 1.0 / (mesh_box.hi[axis] - lo_[axis]);
    }

    glm::dvec4 operator()(Semantic semantic, std::uint32_t vertex) const {
        switch (slot_of(semantic)) {
        case pipeline::Slot::position:
            return {grid_ != nullptr ? grid_->code(mesh_.positions[vertex]) : glm::dvec3(mesh_.positions[vertex]), 1.0};
        case pipeline::Slot::normal:
            return {normal(vertex), 0.0};
        case pipeline::Slot::colour:
            return colour(semantic, vertex);
        default:
            return {(glm::dvec3(mesh_.positions[vertex]) - lo_) * per_extent_, 1.0};
        }
    }

  private:
    // Matrices take normals along by their cofactors, so a normal on a stretched grid is stretched beforehand.
    glm::dvec3 normal(std::uint32_t vertex) const {
        if (mesh_.normals.empty()) return {0.0, 0.0, 1.0};
        const glm::dvec3 normal(mesh_.normals[vertex]);
        return grid_ != nullptr ? glm::normalize(normal * grid_->step) : normal;
    }
    glm::dvec4 colour(Semantic semantic, std::uint32_t vertex) const {
        if (semantic == Semantic::secondary_colour) return {0.0, 0.0, 0.0, 1.0};
        if (mesh_.colours.empty()) return glm::dvec4(1.0);
        const Colour& colour = mesh_.colours[vertex];
        return glm::dvec4(colour[0], colour[1], colour[2], colour[3]) / 255.0;
    }

    const Mesh& mesh_;
    glm::dvec3 lo_;
    glm::dvec3 per_extent_{0.0};
    const PositionGrid* grid_;
};

/// The buffers of a mesh under construction.
class MeshWriter {
  public:
    MeshWriter(Resources& resources, const Mesh& mesh, const MeshFormat& format)
        : resources_(resources), mesh_(mesh), format_(format) {
        CHECK(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
        CHECK(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size());
        const bool grid = format.position == PositionFormat::s16;
        lay_out({Semantic::position, grid ? ComponentType::s16 : ComponentType::f32, 3});
        for (const AttributeFormat& one : attributes_of(mesh, format)) lay_out(one);
        if (format_.layout == VertexLayout::interleaved)
            for (VertexAttribute& attribute : attributes_) attribute.stride = next_offset_;
        add_buffers();
    }

    void write_vertices(const MeshPart& part, const VertexValues& values) {
        for (const VertexAttribute& attribute : attributes_) {
            std::byte* target = resources_.buffers[attribute.buffer].bytes.data() + attribute.offset;
            for (std::uint64_t i = part.first_vertex; i < std::uint64_t{part.first_vertex} + part.vertices; ++i)
                write_element(target + i * attribute.stride, attribute.type, attribute.components, attribute.normalized,
                              values(attribute.semantic, static_cast<std::uint32_t>(i)));
        }
    }

    // Indices of each part count from its first vertex, so that parts of up to 65,536 vertices get by with 16 bits.
    void write_indices(const MeshPart& part, IndexType type) {
        std::byte* target = resources_.buffers[index_buffer_].bytes.data();
        const std::uint32_t size = bytes_of(type);
        for (std::size_t i = part.first_index; i < std::size_t{part.first_index} + part.indices; ++i) {
            const std::uint32_t index = mesh_.indices[i] - part.first_vertex;
            const auto narrow = static_cast<std::uint16_t>(index);
            std::memcpy(target + i * size, type == IndexType::u16 ? static_cast<const void*>(&narrow) : &index, size);
        }
    }

    void add_index_buffer(IndexType type) {
        index_buffer_ = add_buffer(mesh_.name + " indices", mesh_.indices.size() * bytes_of(type));
    }

    Geometry geometry_of(const MeshPart& part, IndexType type) const {
        Geometry geometry;
        geometry.attributes = attributes_;
        for (VertexAttribute& attribute : geometry.attributes)
            attribute.offset += std::uint64_t{part.first_vertex} * attribute.stride;
        geometry.vertex_count = part.vertices;
        geometry.index_type = type;
        geometry.index_buffer = type == IndexType::none ? 0 : index_buffer_;
        geometry.index_offset = std::uint64_t{part.first_index} * bytes_of(type);
        geometry.index_count = type == IndexType::none ? part.vertices : part.indices;
        return geometry;
    }

  private:
    void lay_out(const AttributeFormat& one) {
        VertexAttribute attribute;
        attribute.semantic = one.semantic;
        attribute.type = one.type;
        attribute.components = one.components;
        attribute.normalized =
            one.semantic != Semantic::position && one.type != ComponentType::f32 && one.type != ComponentType::f16;
        attribute.stride = rounded_up(attribute.bytes(), format_.align);
        if (format_.layout == VertexLayout::interleaved) attribute.offset = next_offset_;
        next_offset_ += attribute.stride;
        attributes_.push_back(attribute);
    }

    void add_buffers() {
        const std::size_t count = mesh_.positions.size();
        if (format_.layout == VertexLayout::interleaved) add_buffer(mesh_.name + " vertices", count * next_offset_);
        for (VertexAttribute& attribute : attributes_) {
            if (format_.layout == VertexLayout::separate)
                add_buffer(fmt::format("{} {}", mesh_.name, name_of(attribute.semantic)), count * attribute.stride);
            attribute.buffer = static_cast<std::uint32_t>(resources_.buffers.size() - 1);
        }
    }

    std::uint32_t add_buffer(std::string name, std::size_t bytes) {
        resources_.buffers.push_back({std::move(name), std::vector<std::byte>(bytes), 0});
        return static_cast<std::uint32_t>(resources_.buffers.size() - 1);
    }

    Resources& resources_;
    const Mesh& mesh_;
    const MeshFormat& format_;
    std::vector<VertexAttribute> attributes_; ///< of the first vertex of the mesh
    std::uint32_t next_offset_ = 0;
    std::uint32_t index_buffer_ = 0;
};

IndexType index_type_of(const Mesh& mesh, const std::vector<MeshPart>& parts, IndexWidth width,
                        std::string_view place) {
    if (mesh.indices.empty()) return IndexType::none;
    std::uint32_t most = 0;
    for (const MeshPart& part : parts) most = std::max(most, part.vertices);
    if (width == IndexWidth::u16 && most > vertices_of_16_bits)
        throw sim::InputError(fmt::format("{}: index: expected u32 or at most {} vertices in a draw, got u16 and {}",
                                          place, vertices_of_16_bits, most));
    return width == IndexWidth::u32 || most > vertices_of_16_bits ? IndexType::u32 : IndexType::u16;
}

} // namespace

MeshPart whole(const Mesh& mesh) {
    return {0, static_cast<std::uint32_t>(mesh.positions.size()), 0, static_cast<std::uint32_t>(mesh.indices.size())};
}

std::vector<MeshPart> equal_parts(const Mesh& mesh, std::uint32_t vertices, std::uint32_t indices) {
    CHECK(vertices > 0);
    std::vector<MeshPart> parts;
    MeshPart left = whole(mesh);
    while (left.vertices > 0) {
        parts.push_back(
            {left.first_vertex, std::min(vertices, left.vertices), left.first_index, std::min(indices, left.indices)});
        left.first_vertex += parts.back().vertices;
        left.vertices -= parts.back().vertices;
        left.first_index += parts.back().indices;
        left.indices -= parts.back().indices;
    }
    return parts;
}

void add_draws(Scene& scene, const Mesh& mesh, const std::vector<MeshPart>& parts, const MeshFormat& format,
               std::string_view place) {
    Resources& resources = *scene.resources;
    const IndexType type = index_type_of(mesh, parts, format.index, place);
    const Box mesh_box(mesh.positions, whole(mesh));
    MeshWriter writer(resources, mesh, format);
    if (type != IndexType::none) writer.add_index_buffer(type);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        glm::mat4 to_world(1.0F);
        PositionGrid grid;
        if (format.position == PositionFormat::s16) {
            const Box box(mesh.positions, parts[i]);
            grid = PositionGrid(box.lo, box.hi);
            to_world = grid.to_model();
        }
        writer.write_vertices(parts[i], {mesh, mesh_box, format.position == PositionFormat::s16 ? &grid : nullptr});
        if (type != IndexType::none) writer.write_indices(parts[i], type);
        Geometry geometry = writer.geometry_of(parts[i], type);
        geometry.name = parts.size() == 1 ? mesh.name : fmt::format("{} {}", mesh.name, i);
        scene.draws.push_back({geometry.name, static_cast<std::uint32_t>(resources.geometries.size()), 0, {to_world}});
        resources.geometries.push_back(std::move(geometry));
    }
}

} // namespace traces
