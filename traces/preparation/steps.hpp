// Preparations as functions, for those that are made of others.
#pragma once

#include "traces/generators/mesh.hpp"
#include "traces/preparation/triangle_mesh.hpp"

#include <cstdint>

namespace traces {

enum class ReorderAlgorithm : std::uint8_t { fifo, cache, strip, pca, oblivious };

/// Of A2.
struct ReorderParams {
    ReorderAlgorithm algorithm = ReorderAlgorithm::fifo;
    std::uint32_t cache = 16;
    std::uint32_t patch = 4096;
    bool fetch = true;

    static constexpr auto fields() {
        using P = ReorderParams;
        return std::tuple(
            sim::field<&P::algorithm>(
                "what the order is made for: a FIFO, any cache, strips, patches in space (principal axes) with a FIFO "
                "inside, or a layout of the vertices along such axes with the triangles at the mean "
                "of their places (as cache-oblivious layouts are used)"),
            sim::field<&P::cache>("shaded vertices that the FIFO holds (fifo, pca)").unit("vertices").range(3, 65536),
            sim::field<&P::patch>("distinct vertices of a patch at most (pca)").unit("vertices").range(3, 1U << 30U),
            sim::field<&P::fetch>("vertices in the order in which the triangles name them first"));
    }
};

/// Reorders the triangles of a list, and its vertices where the parameters say so.
void reorder_mesh(TriangleMesh& mesh, const ReorderParams& params);

/// A1: consecutive triangles of a list in meshes of at most `vertices` distinct vertices and, unless 0, `triangles`
/// triangles, with the narrowest indices of at least 16 bits. vertices >= 3.
std::vector<TriangleMesh> cut_into_batches(TriangleMesh mesh, std::uint32_t vertices, std::uint32_t triangles);

/// Lays the attributes out anew.
void interleave_mesh(TriangleMesh& mesh, VertexLayout layout, std::uint32_t align);

} // namespace traces

template <>
struct sim::EnumNames<traces::ReorderAlgorithm> {
    static constexpr std::array<std::string_view, 5> names{"fifo", "cache", "strip", "pca", "oblivious"};
};
