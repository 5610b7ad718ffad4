// Vertices whose attributes are equal bit for bit become one.
#include "sim/check.hpp"
#include "sim/counted.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/table.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace traces {

namespace {

struct WeldParams {
    static constexpr auto fields() { return std::tuple<>(); }
};

void weld_mesh(TriangleMesh& mesh) {
    if (mesh.indices.empty()) return;
    const Columns columns = columns_of(mesh);
    std::vector<meshopt_Stream> streams;
    for (const Column& column : columns) {
        const std::uint32_t size = column.format.bytes();
        streams.push_back({column.elements.data(), size, size});
    }
    CHECK(streams.size() <= 16); // what meshoptimizer takes
    std::vector<std::uint32_t> new_number(mesh.vertices);
    const std::size_t count = meshopt_generateVertexRemapMulti(
        new_number.data(), mesh.indices.data(), mesh.indices.size(), mesh.vertices, streams.data(), streams.size());
    renumber_vertices(mesh, new_number, static_cast<std::uint32_t>(count));
}

Applied apply(Scene scene, const WeldParams&) {
    const DrawnTriangles before = drawn_triangles(scene);
    const std::uint64_t vertices = scene.vertices;
    Applied applied;
    applied.scene = change_meshes(std::move(scene), TopologyWanted::list, weld_mesh);
    check_same_triangles(before, drawn_triangles(applied.scene), false);
    applied.notes.push_back(fmt::format("{} became {}", sim::counted(vertices, "vertex"), applied.scene.vertices));
    return applied;
}

} // namespace

Preparation weld_preparation() {
    return make_preparation<WeldParams>("weld", "vertices with equal attributes become one", apply);
}

} // namespace traces
