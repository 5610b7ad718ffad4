// Triangles in random order: the worst that can be asked of every cache, to compare with.
#include "sim/random.hpp"
#include "traces/generators/mesh.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/table.hpp"

#include <array>
#include <cstring>

namespace traces {

namespace {

struct ShuffleParams {
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        return std::tuple(sim::field<&ShuffleParams::seed>("of the random order; the same for every geometry"));
    }
};
static_assert(sim::fully_described<ShuffleParams>);

void shuffle_triangles(TriangleMesh& mesh, std::uint64_t seed) {
    std::vector<std::array<std::uint32_t, 3>> triangles(mesh.indices.size() / 3);
    const std::size_t bytes = mesh.indices.size() * sizeof(std::uint32_t);
    if (bytes == 0) return;
    std::memcpy(triangles.data(), mesh.indices.data(), bytes);
    sim::Random random(seed, "triangle order");
    shuffle(triangles, random);
    std::memcpy(mesh.indices.data(), triangles.data(), bytes);
}

Applied apply(Scene scene, const ShuffleParams& params) {
    const DrawnTriangles before = drawn_triangles(scene);
    Applied applied;
    applied.scene = change_meshes(std::move(scene), TopologyWanted::list,
                                  [&](TriangleMesh& mesh) { shuffle_triangles(mesh, params.seed); });
    check_same_triangles(before, drawn_triangles(applied.scene), false);
    return applied;
}

} // namespace

Preparation shuffle_preparation() {
    return make_preparation<ShuffleParams>("shuffle", "triangles in random order", apply);
}

} // namespace traces
