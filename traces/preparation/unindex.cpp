// Without index buffers: every corner of every triangle is a vertex of its own.
#include "sim/counted.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/table.hpp"

#include <fmt/format.h>
#include <numeric>

namespace traces {

namespace {

struct UnindexParams {
    static constexpr auto fields() { return std::tuple<>(); }
};

void repeat_vertices(TriangleMesh& mesh) {
    for (TriangleMesh::Stream& stream : mesh.streams) {
        std::vector<std::byte> records;
        records.reserve(mesh.indices.size() * stream.stride);
        for (const std::uint32_t index : mesh.indices) {
            const auto first = stream.records.begin() + static_cast<std::ptrdiff_t>(std::size_t{index} * stream.stride);
            records.insert(records.end(), first, first + stream.stride);
        }
        stream.records = std::move(records);
    }
    mesh.vertices = static_cast<std::uint32_t>(mesh.indices.size());
    std::iota(mesh.indices.begin(), mesh.indices.end(), 0U); // counting up needs no index buffer
    mesh.index_type = pipeline::IndexType::none;
}

Applied apply(Scene scene, const UnindexParams&) {
    const DrawnTriangles before = drawn_triangles(scene);
    const std::uint64_t vertices = scene.vertices;
    Applied applied;
    applied.scene = change_meshes(std::move(scene), TopologyWanted::list, repeat_vertices);
    check_same_triangles(before, drawn_triangles(applied.scene), false);
    applied.notes.push_back(fmt::format("{} became {}", sim::counted(vertices, "vertex"), applied.scene.vertices));
    return applied;
}

} // namespace

Preparation unindex_preparation() {
    return make_preparation<UnindexParams>("unindex", "no index buffer: each corner is a vertex of its own", apply);
}

} // namespace traces
