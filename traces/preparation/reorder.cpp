// A2: triangles in an order that the vertex caches like (specification 004, section 3.1), with meshoptimizer's
// algorithms. Its release 0.18 checks nothing: it wants whole triangles and indices below the number of vertices.
#include "sim/check.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/patches.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/steps.hpp"
#include "traces/preparation/table.hpp"

#include <algorithm>
#include <meshoptimizer.h>

namespace traces {

static_assert(sim::fully_described<ReorderParams>);

namespace {

std::vector<std::uint32_t> ordered(const std::vector<std::uint32_t>& indices, std::uint32_t vertices,
                                   const ReorderParams& params) {
    std::vector<std::uint32_t> result(indices.size());
    switch (params.algorithm) {
    case ReorderAlgorithm::cache:
        meshopt_optimizeVertexCache(result.data(), indices.data(), indices.size(), vertices);
        break;
    case ReorderAlgorithm::strip:
        meshopt_optimizeVertexCacheStrip(result.data(), indices.data(), indices.size(), vertices);
        break;
    case ReorderAlgorithm::fifo:
    case ReorderAlgorithm::pca:
    case ReorderAlgorithm::oblivious:
        meshopt_optimizeVertexCacheFifo(result.data(), indices.data(), indices.size(), vertices, params.cache);
        break;
    }
    return result;
}

/// Patch by patch, each in numbers of its own for as long as it is ordered.
std::vector<std::uint32_t> ordered_in_patches(const TriangleMesh& mesh, const ReorderParams& params) {
    const Patches patches = split_into_patches(mesh, params.patch);
    std::vector<std::uint32_t> number(mesh.vertices, no_vertex), result;
    result.reserve(mesh.indices.size());
    std::size_t first = 0;
    for (const std::size_t end : patches.ends) {
        std::vector<std::uint32_t> local, vertices;
        for (std::size_t i = first * 3; i < end * 3; ++i) {
            const std::uint32_t vertex = mesh.indices[std::size_t{patches.triangles[i / 3]} * 3 + i % 3];
            if (number[vertex] == no_vertex) {
                number[vertex] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(vertex);
            }
            local.push_back(number[vertex]);
        }
        for (const std::uint32_t index : ordered(local, static_cast<std::uint32_t>(vertices.size()), params))
            result.push_back(vertices[index]);
        for (const std::uint32_t vertex : vertices) number[vertex] = no_vertex;
        first = end;
    }
    return result;
}

/// Triangles by the mean place of their vertices in a cache-oblivious layout.
std::vector<std::uint32_t> ordered_by_layout(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> places = places_along_a_split(mesh);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> triangles; // three times the mean place, number
    for (std::uint32_t i = 0; i < mesh.indices.size(); i += 3)
        triangles.emplace_back(
            std::uint64_t{places[mesh.indices[i]]} + places[mesh.indices[i + 1]] + places[mesh.indices[i + 2]], i / 3);
    std::sort(triangles.begin(), triangles.end());
    std::vector<std::uint32_t> result;
    result.reserve(mesh.indices.size());
    for (const auto& [place, triangle] : triangles)
        for (std::size_t corner = 0; corner < 3; ++corner)
            result.push_back(mesh.indices[std::size_t{triangle} * 3 + corner]);
    return result;
}

std::vector<std::uint32_t> triangles_in_order(const TriangleMesh& mesh, const ReorderParams& params) {
    switch (params.algorithm) {
    case ReorderAlgorithm::pca:
        return ordered_in_patches(mesh, params);
    case ReorderAlgorithm::oblivious:
        return ordered_by_layout(mesh);
    default:
        return ordered(mesh.indices, mesh.vertices, params);
    }
}

void order_vertices(TriangleMesh& mesh) {
    std::vector<std::uint32_t> new_number(mesh.vertices);
    const std::size_t count =
        meshopt_optimizeVertexFetchRemap(new_number.data(), mesh.indices.data(), mesh.indices.size(), mesh.vertices);
    renumber_vertices(mesh, new_number, static_cast<std::uint32_t>(count));
}

Applied apply(Scene scene, const ReorderParams& params) {
    const DrawnTriangles before = drawn_triangles(scene);
    Applied applied;
    applied.scene =
        change_meshes(std::move(scene), TopologyWanted::list, [&](TriangleMesh& mesh) { reorder_mesh(mesh, params); });
    check_same_triangles(before, drawn_triangles(applied.scene), false);
    return applied;
}

} // namespace

void reorder_mesh(TriangleMesh& mesh, const ReorderParams& params) {
    CHECK(mesh.topology == pipeline::Topology::triangles && mesh.indices.size() % 3 == 0);
    if (mesh.indices.empty()) return;
    CHECK(*std::max_element(mesh.indices.begin(), mesh.indices.end()) < mesh.vertices);
    mesh.indices = triangles_in_order(mesh, params);
    if (params.fetch) order_vertices(mesh);
}

Preparation reorder_preparation() {
    return make_preparation<ReorderParams>("reorder", "triangles, and vertices, in an order that the caches like (A2)",
                                           apply);
}

} // namespace traces
