// The checks that stand behind every preparation notice what they are there for.
#include "sim/check.hpp"
#include "tests/support/preparation_kit.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/rebuild.hpp"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

namespace traces_conservation_test {

using namespace tests;
using pipeline::Semantic;
using traces::DrawnTriangles;
using traces::Scene;
using traces::TopologyWanted;
using traces::TriangleMesh;

Scene changed(const Scene& scene, const std::function<void(TriangleMesh&)>& change) {
    return traces::change_meshes(scene, TopologyWanted::as_it_is, change);
}

void expect_same(const Scene& a, const Scene& b, bool drops_degenerate = false) {
    EXPECT_NO_THROW(
        traces::check_same_triangles(traces::drawn_triangles(a), traces::drawn_triangles(b), drops_degenerate));
}

void expect_other(const Scene& a, const Scene& b) {
    EXPECT_THROW(traces::check_same_triangles(traces::drawn_triangles(a), traces::drawn_triangles(b), false),
                 sim::InternalError);
}

TEST(Conservation, OrderAndFirstCornerDoNotMatter) {
    const Scene scene = scene_of({hill_mesh(5, 4, 1)});
    expect_same(scene, changed(scene, [](TriangleMesh& mesh) {
                    auto& list = mesh.indices;
                    std::rotate(list.begin(), list.begin() + 30, list.end());
                    std::rotate(list.begin() + 3, list.begin() + 4, list.begin() + 6);
                }));
}

TEST(Conservation, WindingCountsAndEveryTriangleOnce) {
    const Scene scene = scene_of({hill_mesh(5, 4, 1)});
    expect_other(scene, changed(scene, [](TriangleMesh& mesh) { std::swap(mesh.indices[6], mesh.indices[7]); }));
    expect_other(scene, changed(scene, [](TriangleMesh& mesh) { mesh.indices.resize(mesh.indices.size() - 3); }));
    expect_other(scene, changed(scene, [](TriangleMesh& mesh) { // one twice instead of its neighbour
                     std::copy_n(mesh.indices.begin(), 3, mesh.indices.begin() + 3);
                 }));
}

TEST(Conservation, EveryBitOfEveryAttributeCounts) {
    const Scene scene = scene_of({hill_mesh(5, 4, 1)});
    for (std::size_t stream = 0; stream < 3; ++stream)
        expect_other(scene,
                     changed(scene, [&](TriangleMesh& mesh) { mesh.streams.at(stream).records[7] ^= std::byte{1}; }));
}

TEST(Conservation, MaterialsAndPlacesCount) {
    Scene scene = scene_of({hill_mesh(5, 4, 1)}), moved = scene;
    moved.draws[0].instances[0][3].x = 1.0F;
    expect_other(scene, moved);
    Scene painted = scene;
    painted.draws[0].material = 1;
    expect_other(scene, painted);
}

TEST(Conservation, DegenerateTrianglesAreKeptUnlessTheyMayGo) {
    const Scene scene = scene_of({degenerate_mesh(1)});
    const Scene without = changed(scene, [](TriangleMesh& mesh) {
        std::vector<std::uint32_t> kept;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
            if (!traces::names_a_vertex_twice({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}))
                kept.insert(kept.end(), {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
        mesh.indices = kept;
    });
    EXPECT_GT(traces::drawn_triangles(scene).degenerate, 0U);
    expect_same(scene, without, true);
    expect_other(scene, without);
}

TEST(Conservation, SameOrderNoticesTurnedCornersAndChangedValues) {
    const Scene scene = scene_of({hill_mesh(5, 4, 1)});
    const auto compare = [&](const Scene& after, std::vector<Semantic> may_change) {
        return traces::check_same_order(scene, after, may_change);
    };
    EXPECT_EQ(compare(changed(scene, [](TriangleMesh&) {}), {}), 0.0);
    const Scene turned = changed(scene, [](TriangleMesh& mesh) {
        std::rotate(mesh.indices.begin(), mesh.indices.begin() + 1, mesh.indices.begin() + 3);
    });
    EXPECT_THROW(compare(turned, {}), sim::InternalError);
    const Scene shifted = changed(scene, [](TriangleMesh& mesh) {
        for (std::size_t i = 0; i < mesh.vertices; ++i) {
            float x = 0.0F;
            std::memcpy(&x, mesh.streams[0].records.data() + i * 12, 4);
            x += 0.25F;
            std::memcpy(mesh.streams[0].records.data() + i * 12, &x, 4);
        }
    });
    EXPECT_THROW(compare(shifted, {}), sim::InternalError);
    EXPECT_THROW(compare(shifted, {Semantic::normal}), sim::InternalError);
    EXPECT_EQ(compare(shifted, {Semantic::position}), 0.25);
}

} // namespace traces_conservation_test
