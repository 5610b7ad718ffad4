// Models of the post-transform cache against closed forms and a brute-force FIFO.
#include "pipeline/geometry/vertex_reuse_models.hpp"
#include "tests/support/geometry_scene.hpp"

#include <algorithm>
#include <deque>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace {

using pipeline::FifoReuse;
using pipeline::LruReuse;
using pipeline::MesaReuse;
using pipeline::ReuseModel;
using pipeline::VertexReuseModel;
using tests::IndexedMesh;

template <class Model>
std::uint32_t runs_of(Model& model, const IndexedMesh& mesh) {
    const std::uint32_t before = model.runs();
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        model.triangle({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
    return model.runs() - before;
}

std::uint32_t fifo_runs(const IndexedMesh& mesh, std::uint32_t entries, std::uint32_t warp = 0,
                        std::uint32_t group = 0) {
    FifoReuse fifo(entries, warp, group);
    fifo.begin_draw(mesh.vertex_count);
    return runs_of(fifo, mesh);
}

std::uint32_t mesa_runs(const IndexedMesh& mesh, bool indexed = true) {
    MesaReuse mesa;
    mesa.begin_draw(mesh.vertex_count, indexed);
    return runs_of(mesa, mesh);
}

TEST(VertexReuseModels, G1GrassHasAnAcmrOf1Point4ForAnyFifoOfAtLeast3) {
    for (const std::uint32_t blades : {1U, 100U, 3000U}) {
        const IndexedMesh mesh = tests::grass_mesh(blades);
        EXPECT_EQ(mesh.vertex_count, 7 * blades);
        EXPECT_EQ(mesh.indices.size(), 15 * blades);
        for (const std::uint32_t entries : {3U, 16U, 24U, 1000U}) EXPECT_EQ(fifo_runs(mesh, entries), 7 * blades);
    }
}

TEST(VertexReuseModels, StripMissesOncePerTriangleAfterTheFirst) {
    IndexedMesh mesh{"strip", 102, {}};
    for (std::uint32_t i = 0; i < 100; ++i) mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 2});
    EXPECT_EQ(fifo_runs(mesh, 3), 102U);
}

TEST(VertexReuseModels, GridThatFitsMissesEachVertexOnceAndElseTwice) {
    // A row of 10 columns needs the 11 vertices of the row above: 2 * 11 are enough.
    const IndexedMesh mesh = tests::grid_mesh(10, 50);
    EXPECT_EQ(fifo_runs(mesh, 22), 11U * 51U);
    EXPECT_EQ(fifo_runs(mesh, 8), 2U * 11U * 50U);
}

TEST(VertexReuseModels, FifoDoesNotRenewOnAHitAndForgetsTheOldest) {
    FifoReuse fifo(3, 0, 0);
    fifo.begin_draw(10);
    EXPECT_EQ(fifo.triangle({0, 1, 2}).missed, 0b111);
    EXPECT_EQ(fifo.triangle({0, 3, 1}).missed, 0b010); // 0 was hit, but 3 pushes it out
    EXPECT_EQ(fifo.triangle({0, 1, 2}).missed, 0b111); // 0 is shaded again, so 1 has gone, so 2 has gone
    EXPECT_EQ(fifo.runs(), 7U);
}

RC_GTEST_PROP(VertexReuseModels, FifoEqualsAQueueOfVertices, ()) {
    const auto entries = *rc::gen::inRange(3U, 20U);
    const auto vertices = *rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange(0U, 30U));
    FifoReuse fifo(entries, 0, 0);
    fifo.begin_draw(30);
    std::deque<std::pair<std::uint32_t, std::uint32_t>> queue; // vertex, run
    std::uint32_t runs = 0;
    for (std::size_t i = 0; i + 2 < vertices.size(); i += 3) {
        const auto result = fifo.triangle({vertices[i], vertices[i + 1], vertices[i + 2]});
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto is_it = [&](const auto& entry) { return entry.first == vertices[i + corner]; };
            auto place = std::find_if(queue.begin(), queue.end(), is_it);
            RC_ASSERT((result.missed >> corner & 1) == (place == queue.end() ? 1 : 0));
            if (place == queue.end()) {
                queue.emplace_back(vertices[i + corner], ++runs);
                if (queue.size() > entries) queue.pop_front();
                place = queue.end() - 1;
            }
            RC_ASSERT(result.sequences[corner] == place->second);
        }
    }
    RC_ASSERT(fifo.runs() == runs);
}

std::uint32_t lru_runs(const IndexedMesh& mesh, std::uint32_t entries) {
    LruReuse lru(entries);
    lru.begin_draw(mesh.vertex_count);
    return runs_of(lru, mesh);
}

TEST(VertexReuseModels, LruRenewsOnAHitAndForgetsTheVertexUsedLongestAgo) {
    LruReuse lru(3);
    lru.begin_draw(10);
    EXPECT_EQ(lru.triangle({0, 1, 2}).missed, 0b111);
    const auto second = lru.triangle({0, 3, 0}); // 3 pushes 1 out, because 0 has just been used
    EXPECT_EQ(second.missed, 0b010);
    EXPECT_EQ(second.sequences, (std::array<std::uint32_t, 3>{1, 4, 1}));
    EXPECT_EQ(lru.triangle({2, 0, 3}).missed, 0);
    EXPECT_EQ(lru.triangle({1, 0, 3}).missed, 0b001); // pushes 2 out
    EXPECT_EQ(lru.triangle({2, 2, 2}).missed, 0b001); // pushes 1 out
    EXPECT_EQ(lru.runs(), 6U);
}

TEST(VertexReuseModels, LruKeepsTheCentreOfAFanThatAFifoLoses) {
    IndexedMesh fan{"fan", 102, {}};
    for (std::uint32_t i = 0; i < 100; ++i) fan.indices.insert(fan.indices.end(), {i + 1, i + 2, 0});
    EXPECT_EQ(lru_runs(fan, 3), 102U);
    // A FIFO of 4 loses the centre with every fourth vertex that follows it.
    EXPECT_GT(fifo_runs(fan, 4), 102U + 20U);
    EXPECT_EQ(lru_runs(tests::grass_mesh(100), 3), 700U);
}

RC_GTEST_PROP(VertexReuseModels, LruEqualsAListSortedByTimeOfUse, ()) {
    const auto entries = *rc::gen::inRange(3U, 20U);
    const auto draws = *rc::gen::container<std::vector<std::vector<std::uint32_t>>>(
        rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange(0U, 30U)));
    LruReuse lru(entries);
    std::uint32_t runs = 0;
    for (const auto& vertices : draws) {
        lru.begin_draw(30);
        std::vector<std::pair<std::uint32_t, std::uint32_t>> list; // vertex, run; used longest ago first
        for (std::size_t i = 0; i + 2 < vertices.size(); i += 3) {
            const auto result = lru.triangle({vertices[i], vertices[i + 1], vertices[i + 2]});
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const auto is_it = [&](const auto& entry) { return entry.first == vertices[i + corner]; };
                const auto place = std::find_if(list.begin(), list.end(), is_it);
                RC_ASSERT((result.missed >> corner & 1) == (place == list.end() ? 1 : 0));
                auto entry = std::make_pair(vertices[i + corner], runs + 1);
                if (place == list.end()) {
                    ++runs;
                    if (list.size() == entries) list.erase(list.begin());
                } else {
                    entry = *place;
                    list.erase(place);
                }
                list.push_back(entry);
                RC_ASSERT(result.sequences[corner] == entry.second);
            }
        }
    }
    RC_ASSERT(lru.runs() == runs);
}

TEST(VertexReuseModels, BatchesOf32And96And384IndicesShadeEachOfTheirVerticesOnce) {
    // Triangles that all share one vertex, the two others new: 1 + 2n vertices in n triangles.
    IndexedMesh star{"star", 2401, {}};
    for (std::uint32_t i = 0; i < 1200; ++i) star.indices.insert(star.indices.end(), {0, 2 * i + 1, 2 * i + 2});
    for (const std::uint32_t indices : {32U, 96U, 384U}) {
        const std::uint32_t triangles = indices / 3;
        VertexReuseModel batch(
            {.model = ReuseModel::batch, .entries = 1U << 20U, .warp_vertices = 0, .group_triangles = triangles});
        batch.begin_draw(star.vertex_count, true);
        const std::uint32_t batches = (1200 + triangles - 1) / triangles;
        EXPECT_EQ(runs_of(batch, star), 2400 + batches) << indices;
    }
}

TEST(VertexReuseModels, WarpIsFlushedWhenATriangleDoesNotFit) {
    FifoReuse warp(1000, 4, 0);
    warp.begin_draw(10);
    warp.triangle({0, 1, 2});
    EXPECT_EQ(warp.triangle({0, 1, 3}).missed, 0b100); // the fourth vertex fits
    EXPECT_EQ(warp.triangle({0, 1, 4}).missed, 0b111); // a fifth does not
}

TEST(VertexReuseModels, GroupIsFlushedWhenItsTrianglesAreUsedUp) {
    FifoReuse group(1000, 0, 2);
    group.begin_draw(10);
    group.triangle({0, 1, 2});
    EXPECT_EQ(group.triangle({0, 1, 2}).missed, 0);
    EXPECT_EQ(group.triangle({0, 1, 2}).missed, 0b111);
}

TEST(VertexReuseModels, EveryInstanceBeginsEmptyWithRunningSequenceNumbers) {
    for (const ReuseModel kind : {ReuseModel::fifo, ReuseModel::batch, ReuseModel::mesa, ReuseModel::lru}) {
        VertexReuseModel model({.model = kind});
        model.begin_draw(3, true);
        EXPECT_EQ(model.triangle({0, 1, 2}).sequences, (std::array<std::uint32_t, 3>{1, 2, 3}));
        model.begin_draw(3, true);
        const auto again = model.triangle({0, 1, 2});
        EXPECT_EQ(again.missed, 0b111);
        EXPECT_EQ(again.sequences, (std::array<std::uint32_t, 3>{4, 5, 6}));
        EXPECT_EQ(model.runs(), 6U);
    }
}

TEST(VertexReuseModels, MesaForgetsEverythingAfter1023Indices) {
    IndexedMesh mesh{"one triangle again and again", 3, {}};
    for (int i = 0; i < 341; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
    EXPECT_EQ(mesa_runs(mesh), 3U);
    mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
    EXPECT_EQ(mesa_runs(mesh), 6U);
}

TEST(VertexReuseModels, MesaVerticesThatShareASlotEvictEachOther) {
    MesaReuse mesa;
    mesa.begin_draw(1000, true);
    mesa.triangle({0, 1, 2});
    EXPECT_EQ(mesa.triangle({256, 1, 2}).missed, 0b001);
    EXPECT_EQ(mesa.triangle({0, 1, 2}).missed, 0b001);
}

TEST(VertexReuseModels, MesaShadesEachVertexOnceWithoutAnIndexBuffer) {
    IndexedMesh strip{"strip", 5002, {}};
    for (std::uint32_t i = 0; i < 5000; ++i) strip.indices.insert(strip.indices.end(), {i, i + 1, i + 2});
    EXPECT_EQ(mesa_runs(strip, false), 5002U);
    IndexedMesh fan{"fan", 5002, {}};
    for (std::uint32_t i = 0; i < 5000; ++i) fan.indices.insert(fan.indices.end(), {i + 1, i + 2, 0});
    EXPECT_EQ(mesa_runs(fan, false), 5002U);
}

} // namespace
