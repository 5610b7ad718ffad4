#include "tests/support/preparation_kit.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"

#include <algorithm>

namespace tests {

using traces::Mesh;
using traces::Scene;

namespace {

std::vector<float> corner_values(const pipeline::Resources& resources, const pipeline::Geometry& geometry,
                                 const glm::mat4& matrix, std::uint32_t vertex) {
    std::vector<float> values;
    for (const pipeline::VertexAttribute& attribute : geometry.attributes) {
        glm::vec4 value = pipeline::AttributeReader(resources, attribute)(vertex);
        if (attribute.semantic == pipeline::Semantic::position) value = matrix * glm::vec4(glm::vec3(value), 1.0F);
        for (int i = 0; i < 4; ++i) values.push_back(value[i]);
    }
    return values;
}

} // namespace

Scene scene_of(const std::vector<Mesh>& meshes, traces::VertexLayout layout) {
    Scene scene = traces::scene_of_material("grey", glm::vec4(0.5F, 0.5F, 0.5F, 1.0F));
    scene.name = "test";
    scene.hash = "0123456789abcdef";
    traces::MeshFormat format;
    format.layout = layout;
    for (const Mesh& mesh : meshes) traces::add_draws(scene, mesh, {traces::whole(mesh)}, format, "test");
    for (const pipeline::Geometry& geometry : scene.resources->geometries) scene.triangles += geometry.triangle_count();
    traces::finish_scene(scene);
    return scene;
}

Mesh hill_mesh(std::uint32_t columns, std::uint32_t rows, std::uint64_t seed) {
    sim::Random random(seed, "hill");
    Mesh mesh;
    mesh.name = "hill";
    for (std::uint32_t y = 0; y <= rows; ++y)
        for (std::uint32_t x = 0; x <= columns; ++x) {
            mesh.positions.emplace_back(x, random.uniform(), y);
            mesh.colours.push_back(traces::colour_of(random.below(1000)));
        }
    for (std::uint32_t y = 0; y < rows; ++y)
        for (std::uint32_t x = 0; x < columns; ++x) {
            const std::uint32_t a = y * (columns + 1) + x, c = a + columns + 1;
            for (const std::uint32_t corner : {a, c, a + 1, a + 1, c, c + 1}) mesh.indices.push_back(corner);
        }
    traces::compute_normals(mesh);
    return mesh;
}

Mesh soup_mesh(std::uint32_t triangles, std::uint32_t vertices, std::uint64_t seed) {
    sim::Random random(seed, "soup");
    Mesh mesh;
    mesh.name = "soup";
    for (std::uint32_t i = 0; i < vertices; ++i)
        mesh.positions.emplace_back(random.uniform(), random.uniform(), random.uniform());
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const auto a = static_cast<std::uint32_t>(random.below(vertices));
        const auto b = static_cast<std::uint32_t>((a + 1 + random.below(vertices - 1)) % vertices);
        std::uint32_t c = a;
        while (c == a || c == b) c = static_cast<std::uint32_t>(random.below(vertices));
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
    }
    return mesh;
}

Mesh degenerate_mesh(std::uint64_t seed) {
    Mesh mesh = hill_mesh(9, 7, seed);
    sim::Random random(seed, "degenerate");
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        indices.insert(indices.end(), {a, b, c});
        if (random.below(3) == 0) indices.insert(indices.end(), {b, a, b});
        if (random.below(5) == 0) indices.insert(indices.end(), {c, c, c});
    }
    mesh.indices = std::move(indices);
    return mesh;
}

std::vector<TriangleValues> triangle_values(const Scene& scene, bool with_degenerate) {
    std::vector<TriangleValues> list;
    for (const pipeline::Draw& draw : scene.draws) {
        const pipeline::Geometry& geometry = scene.resources->geometries.at(draw.geometry);
        const pipeline::PrimitiveReader read(*scene.resources, geometry);
        for (const glm::mat4& matrix : draw.instances)
            for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) {
                const std::array<std::uint32_t, 3> vertices = read(i);
                TriangleValues triangle;
                for (std::size_t corner = 0; corner < 3; ++corner)
                    triangle[corner] = corner_values(*scene.resources, geometry, matrix, vertices[corner]);
                const bool degenerate =
                    triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
                if (degenerate && !with_degenerate) continue;
                if (degenerate)
                    std::sort(triangle.begin(), triangle.end());
                else
                    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
                list.push_back(std::move(triangle));
            }
    }
    std::sort(list.begin(), list.end());
    return list;
}

traces::PreparedScene prepared_in_turn(const Scene& scene, const std::vector<std::string>& specs) {
    return traces::prepare_scene(scene, specs, {.entries = 16}, {.bytes = 16384, .line = 32, .ways = 4});
}

traces::PreparedScene prepared(const Scene& scene, const std::string& spec) { return prepared_in_turn(scene, {spec}); }

std::string preparation_error(const Scene& scene, const std::string& spec) {
    try {
        prepared(scene, spec);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

} // namespace tests
