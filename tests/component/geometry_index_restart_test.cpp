// Primitive restart in the index fetch unit: which triangles leave, and what the restarts cost.
#include "tests/support/index_fetch_kit.hpp"

#include <gtest/gtest.h>

namespace geometry_index_restart_test {

using namespace pipeline;
using tests::fetch;
using tests::FetchRun;
using tests::restarted;

TEST(IndexFetch, RestartedStripsGiveTheTrianglesOfSeparateOnesInEveryWidth) {
    constexpr std::uint32_t end = ~0U;
    // At the begin, twice in a row, strips of one and two vertices, at the end.
    const std::vector<std::uint32_t> indices{end, 1, 2, 3, 4, 5, end, end, 9, end, 8, 7, end, 20, 21, 22, 23, end};
    for (const IndexType type : {IndexType::u8, IndexType::u16, IndexType::u32}) {
        const FetchRun run = fetch(tests::make_scene({restarted(Topology::triangle_strip, type, indices)}), {});
        std::vector<std::array<std::uint32_t, 3>> triangles;
        for (const IndexedPrimitive& primitive : run.primitives) {
            EXPECT_EQ(primitive.primitive, triangles.size());
            triangles.push_back(primitive.vertices);
        }
        EXPECT_EQ(triangles, (std::vector<std::array<std::uint32_t, 3>>{
                                 {1, 2, 3}, {2, 4, 3}, {3, 4, 5}, {20, 21, 22}, {21, 23, 22}}));
        EXPECT_EQ(run.stats.indices.value, indices.size());
        EXPECT_EQ(run.stats.lines.value, (indices.size() * bytes_of(type) + 63) / 64);
    }
}

TEST(IndexFetch, RestartedFansKeepTheirOwnCentre) {
    const FetchRun run = fetch(
        tests::make_scene({restarted(Topology::triangle_fan, IndexType::u16, {0, 1, 2, 3, ~0U, 10, 11, 12, 13})}), {});
    ASSERT_EQ(run.primitives.size(), 4U);
    EXPECT_EQ(run.primitives[1].vertices, (std::array<std::uint32_t, 3>{2, 3, 0}));
    EXPECT_EQ(run.primitives[3].vertices, (std::array<std::uint32_t, 3>{12, 13, 10}));
    EXPECT_EQ(run.stats.indices.value, 9U);
}

TEST(IndexFetch, PointsAndLinesReadEachIndexOnce) {
    using Vertices = std::vector<std::array<std::uint32_t, 3>>;
    const auto vertices = [](Topology topology) {
        const FetchRun run =
            fetch(tests::make_scene({restarted(topology, IndexType::u16, {9, 8, 7, ~0U, 5, 4, ~0U, 3, ~0U})}), {});
        EXPECT_EQ(run.stats.indices.value, 9U);
        Vertices list;
        std::uint32_t bytes = 0;
        for (const IndexedPrimitive& primitive : run.primitives) {
            list.push_back(primitive.vertices);
            bytes += primitive.index_bytes;
        }
        EXPECT_LE(bytes, 18U);
        return list;
    };
    EXPECT_EQ(vertices(Topology::points), (Vertices{{9, 9, 9}, {8, 8, 8}, {7, 7, 7}, {5, 5, 5}, {4, 4, 4}, {3, 3, 3}}));
    EXPECT_EQ(vertices(Topology::lines), (Vertices{{9, 8, 8}, {5, 4, 4}}));
    EXPECT_EQ(vertices(Topology::line_strip), (Vertices{{9, 8, 8}, {8, 7, 7}, {5, 4, 4}}));
    EXPECT_EQ(vertices(Topology::line_loop), (Vertices{{9, 8, 8}, {8, 7, 7}, {7, 9, 9}, {5, 4, 4}, {4, 5, 5}}));
}

TEST(IndexFetch, IndicesThatMakeNoTriangleCostTheirBytesAndTime) {
    // Restarts alone: 4000 bytes and no triangle, twice; then a triangle behind as many, of which one line fits.
    const std::vector<std::uint32_t> nothing(1000, ~0U);
    std::vector<std::uint32_t> late = nothing;
    late.insert(late.end(), {3, 4, 5, ~0U, 6, 7});
    tests::SceneDraw draw = restarted(Topology::triangle_strip, IndexType::u32, nothing);
    draw.instances = 2;
    const tests::GeometryScene scene =
        tests::make_scene({draw, restarted(Topology::triangle_strip, IndexType::u32, late)});
    const FetchRun run = fetch(scene, {.lines_in_flight = 2, .bytes_per_clk = 4});
    ASSERT_EQ(run.primitives.size(), 1U);
    EXPECT_EQ(run.primitives[0].vertices, (std::array<std::uint32_t, 3>{3, 4, 5}));
    EXPECT_EQ(run.stats.indices.value, 3006U);
    EXPECT_EQ(run.stats.lines.value, 63U + 63 + 63);
    EXPECT_GE(run.cycles[0], 3003U); // one index a cycle
    EXPECT_EQ(run.stats.draws.value, 3U);
}

TEST(IndexFetch, RestartsWithinBudgetDelayNothingElse) {
    // One long strip and the same in strips of 10 vertices: the restarts and the doubled vertices cost their bytes.
    std::vector<std::uint32_t> cut;
    for (std::uint32_t i = 0; i < 100; ++i) {
        for (std::uint32_t k = 0; k < 10; ++k) cut.push_back(i + k);
        cut.push_back(~0U);
    }
    const FetchRun run = fetch(tests::make_scene({restarted(Topology::triangle_strip, IndexType::u16, cut)}),
                               {.lines_in_flight = 1024, .bytes_per_clk = 2});
    ASSERT_EQ(run.primitives.size(), 800U);
    EXPECT_EQ(run.stats.indices.value, 1100U);
    EXPECT_NEAR(static_cast<double>(run.cycles.back() - run.cycles.front()), 1100.0 - 3, 8); // 2 bytes a cycle
}

} // namespace geometry_index_restart_test
