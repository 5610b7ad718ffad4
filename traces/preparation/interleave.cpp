// Where the attributes of a vertex lie: side by side, or each in a buffer of its own (specification 004, section 4.7).
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/steps.hpp"
#include "traces/preparation/table.hpp"

#include <numeric>

namespace traces {

namespace {

struct InterleaveParams {
    VertexLayout layout = VertexLayout::interleaved;
    std::uint32_t align = 4;

    static constexpr auto fields() {
        using P = InterleaveParams;
        return std::tuple(
            sim::field<&P::layout>("attributes of a vertex side by side, or each in a buffer of its own"),
            sim::field<&P::align>("attributes and vertices begin at multiples of this").unit("bytes").range(1, 64));
    }
};
static_assert(sim::fully_described<InterleaveParams>);

Applied apply(Scene scene, const InterleaveParams& params) {
    const Scene before = scene;
    Applied applied;
    applied.scene = change_meshes(std::move(scene), TopologyWanted::as_it_is,
                                  [&](TriangleMesh& mesh) { interleave_mesh(mesh, params.layout, params.align); });
    check_same_order(before, applied.scene, {});
    return applied;
}

} // namespace

void interleave_mesh(TriangleMesh& mesh, VertexLayout layout, std::uint32_t align) {
    const Columns columns = columns_of(mesh);
    Grouping groups;
    if (layout == VertexLayout::separate) {
        for (std::size_t i = 0; i < columns.size(); ++i) groups.push_back({i});
    } else {
        groups.emplace_back(columns.size());
        std::iota(groups[0].begin(), groups[0].end(), std::size_t{0});
    }
    lay_out(mesh, columns, groups, align);
}

Preparation interleave_preparation() {
    return make_preparation<InterleaveParams>("interleave", "attributes side by side, or each on its own", apply);
}

} // namespace traces
