// What preparing a mesh must not change: the triangles that are drawn.
#pragma once

#include "traces/scene.hpp"

#include <cstdint>
#include <span>

namespace traces {

/// A fingerprint of a scene's triangles that their order, and which corner comes first, do not matter to; which way
/// they wind does. A corner is the bytes of its attributes; material and instances count, too.
struct DrawnTriangles {
    std::uint64_t triangles = 0;  ///< with three different corners, instances not counted
    std::uint64_t hash = 0;       ///< sum of their hashes, modulo 2^64
    std::uint64_t degenerate = 0; ///< the others
    std::uint64_t degenerate_hash = 0;
    bool lists = true; ///< no strips or fans, whose degenerate triangles are not to be kept
};
DrawnTriangles drawn_triangles(const Scene& scene);

/// CHECKs that both draw the same triangles; the degenerate ones too where both are made of lists and nobody drops
/// them.
void check_same_triangles(const DrawnTriangles& before, const DrawnTriangles& after, bool drops_degenerate);

/// For changes that keep the order of draws, triangles and corners: CHECKs that order, and that every attribute reads
/// as before but those of `changed`. Returns the largest distance between a drawn position before and after, over all
/// instances, in scene units.
double check_same_order(const Scene& before, const Scene& after, std::span<const pipeline::Semantic> changed);

} // namespace traces
