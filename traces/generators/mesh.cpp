#include "traces/generators/mesh.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace traces {

using pipeline::Buffer;
using pipeline::ComponentType;
using pipeline::Geometry;
using pipeline::IndexType;
using pipeline::Resources;
using pipeline::Semantic;
using pipeline::VertexAttribute;

namespace {

// One attribute of a mesh as bytes.
struct Column {
    Semantic semantic;
    ComponentType type;
    std::uint8_t components;
    bool normalized;
    const char* name;
    const std::byte* data;

    std::uint32_t size() const { return pipeline::bytes_of(type) * components; }
};

std::vector<Column> columns_of(const Mesh& mesh) {
    const auto bytes = [](const auto& list) { return reinterpret_cast<const std::byte*>(list.data()); };
    CHECK(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    CHECK(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size());
    std::vector<Column> columns{{Semantic::position, ComponentType::f32, 3, false, "positions", bytes(mesh.positions)}};
    if (!mesh.normals.empty())
        columns.push_back({Semantic::normal, ComponentType::f32, 3, false, "normals", bytes(mesh.normals)});
    if (!mesh.colours.empty())
        columns.push_back({Semantic::colour, ComponentType::u8, 4, true, "colours", bytes(mesh.colours)});
    return columns;
}

std::uint32_t add_buffer(Resources& resources, std::string name, std::size_t bytes) {
    resources.buffers.push_back({std::move(name), std::vector<std::byte>(bytes), 0});
    return static_cast<std::uint32_t>(resources.buffers.size() - 1);
}

std::vector<VertexAttribute> add_vertices(Resources& resources, const Mesh& mesh, VertexLayout layout) {
    const std::vector<Column> columns = columns_of(mesh);
    const std::size_t count = mesh.positions.size();
    std::vector<VertexAttribute> attributes;
    std::uint32_t together = 0;
    for (const Column& column : columns) together += column.size();

    std::uint32_t buffer = 0, offset = 0;
    if (layout == VertexLayout::interleaved) buffer = add_buffer(resources, mesh.name + " vertices", count * together);
    for (const Column& column : columns) {
        const std::uint32_t size = column.size();
        if (layout == VertexLayout::separate)
            buffer = add_buffer(resources, fmt::format("{} {}", mesh.name, column.name), count * size);
        const std::uint32_t stride = layout == VertexLayout::separate ? size : together;
        std::byte* target = resources.buffers[buffer].bytes.data() + offset;
        for (std::size_t i = 0; i < count; ++i) std::memcpy(target + i * stride, column.data + i * size, size);
        attributes.push_back(
            {column.semantic, column.type, column.components, column.normalized, buffer, offset, stride});
        if (layout == VertexLayout::interleaved) offset += size;
    }
    return attributes;
}

// Indices of each part count from its first vertex, so that parts of up to 65,536 vertices get by with 16 bits.
std::uint32_t add_indices(Resources& resources, const Mesh& mesh, IndexType type, std::uint32_t vertices_per_part,
                          std::uint32_t indices_per_part) {
    const std::uint32_t size = pipeline::bytes_of(type);
    const std::uint32_t buffer = add_buffer(resources, mesh.name + " indices", mesh.indices.size() * size);
    std::byte* target = resources.buffers[buffer].bytes.data();
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(i / indices_per_part * vertices_per_part);
        const std::uint32_t index = mesh.indices[i] - first;
        const auto narrow = static_cast<std::uint16_t>(index);
        if (type == IndexType::u16)
            std::memcpy(target + i * size, &narrow, size);
        else
            std::memcpy(target + i * size, &index, size);
    }
    return buffer;
}

} // namespace

std::uint32_t add_mesh_in_parts(Resources& resources, const Mesh& mesh, VertexLayout layout,
                                std::uint32_t vertices_per_part, std::uint32_t indices_per_part) {
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    const auto indices = static_cast<std::uint32_t>(mesh.indices.size());
    const auto attributes = add_vertices(resources, mesh, layout);
    const bool indexed = indices > 0;
    Geometry part;
    part.index_type = !indexed                                         ? IndexType::none
                      : std::min(vertices, vertices_per_part) <= 65536 ? IndexType::u16
                                                                       : IndexType::u32;
    if (indexed) part.index_buffer = add_indices(resources, mesh, part.index_type, vertices_per_part, indices_per_part);
    std::uint32_t parts = 0;
    for (std::uint64_t first = 0; first < vertices; first += vertices_per_part, ++parts) {
        const std::uint64_t first_index = std::uint64_t{parts} * indices_per_part;
        part.name = first == 0 && vertices <= vertices_per_part ? mesh.name : fmt::format("{} {}", mesh.name, parts);
        part.attributes = attributes;
        part.vertex_count = static_cast<std::uint32_t>(std::min<std::uint64_t>(vertices_per_part, vertices - first));
        for (VertexAttribute& attribute : part.attributes) attribute.offset += first * attribute.stride;
        part.index_offset = first_index * pipeline::bytes_of(part.index_type);
        part.index_count =
            !indexed ? part.vertex_count
                     : static_cast<std::uint32_t>(std::min<std::uint64_t>(indices_per_part, indices - first_index));
        resources.geometries.push_back(part);
    }
    return parts;
}

std::uint32_t add_mesh(Resources& resources, const Mesh& mesh, VertexLayout layout) {
    const auto all_indices = static_cast<std::uint32_t>(std::max<std::size_t>(1, mesh.indices.size()));
    add_mesh_in_parts(resources, mesh, layout, static_cast<std::uint32_t>(mesh.positions.size()), all_indices);
    return static_cast<std::uint32_t>(resources.geometries.size() - 1);
}

Scene scene_of_material(std::string material, const glm::vec4& colour) {
    Scene scene;
    scene.resources = std::make_shared<pipeline::Resources>();
    pipeline::Material only;
    only.name = std::move(material);
    only.base_colour = colour;
    only.double_sided = true;
    scene.resources->materials.push_back(std::move(only));
    return scene;
}

void add_draw(Scene& scene, std::uint32_t geometry) {
    scene.draws.push_back({scene.resources->geometries[geometry].name, geometry, 0, {glm::mat4(1.0F)}});
}

void compute_normals(Mesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0F));
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const glm::vec3 twice_area =
            glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        for (const std::uint32_t corner : {a, b, c}) mesh.normals[corner] += twice_area;
    }
    for (glm::vec3& normal : mesh.normals) {
        const float length = glm::length(normal);
        normal = length > 0.0F ? normal / length : glm::vec3(0.0F, 1.0F, 0.0F);
    }
}

Colour colour_of(std::uint64_t number) {
    // Steps of the golden ratio around the colour wheel never come near a recent hue.
    const double hue = static_cast<double>(number % 1000003) * 0.6180339887498949;
    const double turn = (hue - std::floor(hue)) * 6.0;
    const auto ramp = [&](double centre) {
        const double distance = std::abs(turn - centre) > 3.0 ? 6.0 - std::abs(turn - centre) : std::abs(turn - centre);
        return static_cast<std::uint8_t>(255.0 * (0.15 + 0.85 * std::clamp(2.0 - distance, 0.0, 1.0)));
    };
    return {ramp(0.0), ramp(2.0), ramp(4.0), 255};
}

std::vector<float> layer_depths(std::uint32_t n, DepthOrder order, std::uint64_t seed) {
    std::vector<float> depths(n);
    for (std::uint32_t i = 0; i < n; ++i) depths[i] = static_cast<float>((i + 1.0) / (n + 1.0));
    if (order == DepthOrder::back_to_front) std::reverse(depths.begin(), depths.end());
    sim::Random random(seed, "layer depths");
    if (order == DepthOrder::random) shuffle(depths, random);
    return depths;
}

} // namespace traces
