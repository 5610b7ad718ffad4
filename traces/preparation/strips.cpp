// A4: triangle strips, grown greedily in the order of the list by meshoptimizer (specification 004, section 3.1), and
// joined into one per geometry.
#include "sim/check.hpp"
#include "sim/counted.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/steps.hpp"
#include "traces/preparation/table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <meshoptimizer.h>

namespace traces {

enum class Stitch : std::uint8_t { degenerate, restart };

} // namespace traces

template <>
struct sim::EnumNames<traces::Stitch> {
    static constexpr std::array<std::string_view, 2> names{"degenerate", "restart"};
};

namespace traces {

namespace {

struct StripParams {
    bool reorder = true;
    Stitch stitch = Stitch::degenerate;

    static constexpr auto fields() {
        using P = StripParams;
        return std::tuple(
            sim::field<&P::reorder>(
                "the triangles first get an order that makes long strips; otherwise strips follow the given order"),
            sim::field<&P::stitch>("what joins strips: triangles that name a vertex twice, or primitive restart"));
    }
};
static_assert(sim::fully_described<StripParams>);

/// Triangles that name a vertex twice draw nothing, and would break strips.
void drop_degenerate(std::vector<std::uint32_t>& indices) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        if (names_a_vertex_twice({indices[i], indices[i + 1], indices[i + 2]})) continue;
        std::copy_n(indices.begin() + static_cast<std::ptrdiff_t>(i), 3,
                    indices.begin() + static_cast<std::ptrdiff_t>(kept));
        kept += 3;
    }
    indices.resize(kept);
}

void make_strip(TriangleMesh& mesh, const StripParams& params) {
    drop_degenerate(mesh.indices);
    if (mesh.indices.empty()) return;
    if (params.reorder) reorder_mesh(mesh, {.algorithm = ReorderAlgorithm::strip, .fetch = false});
    const std::size_t most = meshopt_stripifyBound(mesh.indices.size());
    CHECK_MSG(most <= std::numeric_limits<std::uint32_t>::max(), "a strip of 2^32 indices");
    std::vector<std::uint32_t> strip(most);
    mesh.primitive_restart = params.stitch == Stitch::restart;
    strip.resize(meshopt_stripify(strip.data(), mesh.indices.data(), mesh.indices.size(), mesh.vertices,
                                  mesh.primitive_restart ? no_vertex : 0));
    mesh.indices = std::move(strip);
    mesh.topology = pipeline::Topology::triangle_strip;
}

std::uint64_t indices_of(const Scene& scene) {
    std::uint64_t sum = 0;
    for (const pipeline::Geometry& geometry : scene.resources->geometries) sum += geometry.index_count;
    return sum;
}

Applied apply(Scene scene, const StripParams& params) {
    const DrawnTriangles before = drawn_triangles(scene);
    const std::uint64_t indices = indices_of(scene);
    Applied applied;
    applied.scene =
        change_meshes(std::move(scene), TopologyWanted::list, [&](TriangleMesh& mesh) { make_strip(mesh, params); });
    check_same_triangles(before, drawn_triangles(applied.scene), true);
    applied.notes.push_back(fmt::format("{} became {}", sim::counted(indices, "index"), indices_of(applied.scene)));
    return applied;
}

} // namespace

Preparation strips_preparation() {
    return make_preparation<StripParams>("strips", "triangle strips, one per geometry (A4)", apply);
}

} // namespace traces
