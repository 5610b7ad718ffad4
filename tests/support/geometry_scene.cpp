#include "tests/support/geometry_scene.hpp"

#include "sim/random.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <utility>

namespace tests {

namespace {

void add_quad(std::vector<std::uint32_t>& indices, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    indices.insert(indices.end(), {a, b, c, b, d, c});
}

std::uint32_t add_buffer(pipeline::Resources& resources, std::string name, std::vector<std::byte> bytes) {
    resources.buffers.push_back({std::move(name), std::move(bytes), 0});
    return static_cast<std::uint32_t>(resources.buffers.size() - 1);
}

std::vector<std::byte> index_bytes(const SceneDraw& draw) {
    std::vector<std::byte> bytes;
    for (const std::uint32_t index : draw.indices)
        for (std::uint32_t i = 0; i < pipeline::bytes_of(draw.index_type); ++i)
            bytes.push_back(static_cast<std::byte>(index >> (8 * i) & 0xFFU));
    return bytes;
}

pipeline::Geometry geometry_of(pipeline::Resources& resources, const SceneDraw& draw) {
    using pipeline::Semantic;
    pipeline::Geometry geometry;
    geometry.topology = draw.topology;
    geometry.vertex_count = draw.vertex_count;
    geometry.index_type = draw.index_type;
    geometry.index_count = static_cast<std::uint32_t>(draw.indices.size());
    geometry.primitive_restart = draw.primitive_restart;
    const std::uint32_t vertices =
        add_buffer(resources, "vertices", std::vector<std::byte>(std::size_t{draw.vertex_count} * draw.vertex_bytes));
    constexpr std::array<std::pair<Semantic, std::uint8_t>, 3> layout{
        {{Semantic::position, 3}, {Semantic::normal, 3}, {Semantic::texcoord0, 2}}};
    std::uint32_t offset = 0;
    for (const auto& [semantic, components] : layout) {
        if (offset + components * 4U > draw.vertex_bytes) break;
        geometry.attributes.push_back({.semantic = semantic,
                                       .components = components,
                                       .buffer = vertices,
                                       .offset = offset,
                                       .stride = draw.vertex_bytes});
        offset += components * 4U;
    }
    if (draw.index_type != pipeline::IndexType::none)
        geometry.index_buffer = add_buffer(resources, "indices", index_bytes(draw));
    return geometry;
}

void add_ranges(pipeline::FragmentStream& stream, std::uint32_t draw, std::uint32_t instances,
                std::uint32_t primitives) {
    for (std::uint32_t instance = 0; instance < instances; ++instance) {
        const auto first = static_cast<std::uint32_t>(stream.primitives.size());
        stream.draws.own().push_back({draw, instance, first, primitives, 0, 0});
        stream.primitives.own().resize(first + primitives, pipeline::Primitive{.triangles = 1});
    }
}

} // namespace

IndexedMesh grid_mesh(std::uint32_t columns, std::uint32_t rows) {
    IndexedMesh mesh{"grid", (columns + 1) * (rows + 1), {}};
    mesh.indices.reserve(std::size_t{6} * columns * rows);
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t corner = row * (columns + 1) + column;
            add_quad(mesh.indices, corner, corner + 1, corner + columns + 1, corner + columns + 2);
        }
    return mesh;
}

IndexedMesh sphere_mesh(std::uint32_t rings, std::uint32_t segments) {
    IndexedMesh mesh{"sphere", (rings - 1) * segments + 2, {}};
    const auto vertex = [&](std::uint32_t ring, std::uint32_t segment) {
        if (ring == 0) return 0U;
        if (ring == rings) return mesh.vertex_count - 1;
        return 1 + (ring - 1) * segments + segment % segments;
    };
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t segment = 0; segment < segments; ++segment) {
            const std::uint32_t a = vertex(ring, segment);
            const std::uint32_t b = vertex(ring, segment + 1);
            const std::uint32_t c = vertex(ring + 1, segment);
            const std::uint32_t d = vertex(ring + 1, segment + 1);
            if (ring > 0) mesh.indices.insert(mesh.indices.end(), {a, b, c});
            if (ring + 1 < rings) mesh.indices.insert(mesh.indices.end(), {b, d, c});
        }
    return mesh;
}

IndexedMesh shuffled(IndexedMesh mesh, std::uint64_t seed) {
    sim::Random random(seed, "mesh order");
    for (std::size_t left = mesh.indices.size() / 3; left > 1; --left) {
        const std::size_t other = random.below(left);
        for (std::size_t i = 0; i < 3; ++i) std::swap(mesh.indices[3 * (left - 1) + i], mesh.indices[3 * other + i]);
    }
    mesh.name += " shuffled";
    return mesh;
}

IndexedMesh random_mesh(std::uint32_t triangles, std::uint32_t vertices, std::uint64_t seed) {
    sim::Random random(seed, "mesh");
    IndexedMesh mesh{"random", vertices, {}};
    for (std::uint32_t i = 0; i < 3 * triangles; ++i)
        mesh.indices.push_back(static_cast<std::uint32_t>(random.below(vertices)));
    return mesh;
}

IndexedMesh grass_mesh(std::uint32_t blades) {
    IndexedMesh mesh{"grass", 7 * blades, {}};
    for (std::uint32_t blade = 0; blade < blades; ++blade)
        for (std::uint32_t triangle = 0; triangle < 5; ++triangle)
            for (std::uint32_t corner = 0; corner < 3; ++corner) mesh.indices.push_back(7 * blade + triangle + corner);
    return mesh;
}

GeometryScene make_scene(const std::vector<SceneDraw>& draws) {
    GeometryScene scene;
    pipeline::Resources resources;
    resources.materials.emplace_back();
    for (const SceneDraw& draw : draws) {
        const auto index = static_cast<std::uint32_t>(scene.frame.draws.size());
        resources.geometries.push_back(geometry_of(resources, draw));
        resources.find_runs();
        pipeline::Draw frame_draw;
        frame_draw.name = "draw" + std::to_string(index);
        frame_draw.geometry = index;
        frame_draw.instances.resize(draw.instances, glm::mat4(1.0F));
        scene.frame.draws.push_back(std::move(frame_draw));
        scene.frame.needs.index_buffer |= draw.index_type != pipeline::IndexType::none;
        add_ranges(scene.stream, index, draw.instances, resources.geometries.back().primitive_count());
    }
    resources.place();
    scene.frame.resources = std::make_shared<const pipeline::Resources>(std::move(resources));
    rebuild(scene);
    return scene;
}

GeometryScene make_scene(const IndexedMesh& mesh) {
    return make_scene({SceneDraw{.vertex_count = mesh.vertex_count, .indices = mesh.indices}});
}

void set_fate(GeometryScene& scene, std::uint32_t index, pipeline::PrimitiveFate fate, std::uint8_t parts,
              bool clipped) {
    scene.stream.primitives.own()[index] = {0, parts, fate, clipped};
}

void rebuild(GeometryScene& scene) {
    scene.stream.triangles.own().clear();
    for (const pipeline::DrawRange& range : scene.stream.draws)
        for (std::uint32_t i = range.first_primitive; i < range.first_primitive + range.primitives; ++i) {
            pipeline::Primitive& primitive = scene.stream.primitives.own()[i];
            primitive.first_triangle = static_cast<std::uint32_t>(scene.stream.triangles.size());
            for (std::uint32_t part = 0; part < primitive.triangles; ++part)
                scene.stream.triangles.own().push_back({range.draw, i, 0, 0, 1});
        }
}

} // namespace tests
