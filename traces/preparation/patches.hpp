// Triangles in patches that lie together in space.
#pragma once

#include "traces/preparation/triangle_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace traces {

struct Patches {
    std::vector<std::uint32_t> triangles; ///< numbers of all triangles, patch by patch; ascending inside a patch
    std::vector<std::size_t> ends;        ///< one past the last of each patch, in `triangles`
};

/// Splits a list at the median along the principal axis of its triangles' centroids, again and again, until every patch
/// has at most `vertices` distinct vertices (specification 004, section 3.1, A2). vertices >= 3. Equal centroids are
/// told apart by the number of the triangle.
Patches split_into_patches(const TriangleMesh& mesh, std::uint32_t vertices);

/// The vertices of a mesh along such a split of their positions, down to single vertices: a layout that suits a cache
/// of any size (specification 004, section 3.1, A2: cache-oblivious layouts). Result: the place of every vertex.
std::vector<std::uint32_t> places_along_a_split(const TriangleMesh& mesh);

} // namespace traces
