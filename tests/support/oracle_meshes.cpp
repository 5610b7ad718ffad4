#include "tests/support/oracle_meshes.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "tests/support/paths.hpp"
#include "traces/scene.hpp"

#include <algorithm>

namespace tests {

namespace {

IndexedMesh largest_mesh(const std::filesystem::path& file) {
    const traces::Scene scene = traces::load_scene(file.string());
    const auto& geometries = scene.resources->geometries;
    const auto largest = std::max_element(geometries.begin(), geometries.end(), [](const auto& a, const auto& b) {
        return a.triangle_count() < b.triangle_count();
    });
    IndexedMesh mesh{file.stem().string(), largest->vertex_count, {}};
    const pipeline::PrimitiveReader read(*scene.resources, *largest);
    for (std::uint32_t i = 0; i < largest->triangle_count(); ++i)
        for (const std::uint32_t vertex : read(i)) mesh.indices.push_back(vertex);
    return mesh;
}

} // namespace

std::vector<IndexedMesh> oracle_meshes() {
    std::vector<IndexedMesh> meshes{grid_mesh(200, 150), shuffled(grid_mesh(120, 90), 1), sphere_mesh(90, 130),
                                    random_mesh(20'000, 9'000, 3), grass_mesh(4'000)};
    for (const char* file : {"scenes/stanford_bunny/stanford_bunny.glb", "scenes/stanford_dragon/stanford_dragon.gltf",
                             "scenes/suzanne/Suzanne.gltf"})
        if (const auto path = ropsim_test::shared_file(file)) meshes.push_back(largest_mesh(*path));
    return meshes;
}

} // namespace tests
