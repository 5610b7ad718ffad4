// Index fetch, primitive counter and vertex fetch between a source, a memory and a sink.
#include "models/gpu_library.hpp"
#include "pipeline/geometry/index_fetch.hpp"
#include "pipeline/geometry/vertex_fetch.hpp"
#include "pipeline/gpu_params.hpp"
#include "tests/support/index_fetch_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <set>

namespace geometry_fetch_test {

using namespace pipeline;
using sim::Cycle;
using Cycles = std::vector<Cycle>;
using tests::answer;
using tests::commands;
using tests::counting;
using tests::fetch;
using tests::FetchRun;
using tests::memory_latency;
using tests::pass_of;
using tests::Rig;
using tests::Sink;
using tests::Source;
using Memory = tests::Responder<MemoryRequest, MemoryResponse>;

// ---- index fetch

TEST(IndexFetch, FirstTriangleComesOneMemoryLatencyAfterItsDraw) {
    const FetchRun run = fetch(tests::make_scene(tests::grid_mesh(1, 1)), {});
    // Draw at 1, request to memory at 2, its answer at 2 + 100 + 1, the triangle a cycle later.
    EXPECT_EQ(run.cycles.front(), 2 + memory_latency + 1 + 1);
}

TEST(IndexFetch, TrianglesComeInOrderWithTheirIndices) {
    const tests::IndexedMesh mesh = tests::random_mesh(400, 70'000, 3);
    const FetchRun run = fetch(tests::make_scene(mesh), {});
    ASSERT_EQ(run.primitives.size(), 400U);
    for (std::uint32_t i = 0; i < 400; ++i) {
        EXPECT_EQ(run.primitives[i].primitive, i);
        for (std::uint32_t corner = 0; corner < 3; ++corner)
            EXPECT_EQ(run.primitives[i].vertices[corner], mesh.indices[3 * i + corner]);
    }
    EXPECT_EQ(run.stats.indices.value, 1200U);
}

TEST(IndexFetch, EveryLineOfTheBufferIsRequestedOnce) {
    const tests::GeometryScene scene = tests::make_scene(tests::grid_mesh(10, 10)); // 200 triangles, 2400 bytes
    const FetchRun run = fetch(scene, {.line = 64});
    std::set<std::uint64_t> addresses;
    const std::uint64_t first = scene.frame.resources->buffers[1].address;
    for (const MemoryRequest& request : run.requests) {
        EXPECT_EQ(request.address % 64, 0U);
        EXPECT_EQ(request.client, MemoryClient::index);
        EXPECT_GE(request.address, first);
        EXPECT_LT(request.address, first + 2400);
        EXPECT_TRUE(addresses.insert(request.address).second);
    }
    EXPECT_EQ(addresses.size(), (2400U + 63) / 64);
    EXPECT_EQ(run.stats.bytes.value, 64 * addresses.size());
}

TEST(IndexFetch, SixteenBitIndicesHalveTheBytes) {
    tests::SceneDraw draw{.vertex_count = 3000, .indices = counting(3000)};
    const FetchRun wide = fetch(tests::make_scene({draw}), {});
    draw.index_type = IndexType::u16;
    const FetchRun narrow = fetch(tests::make_scene({draw}), {});
    EXPECT_EQ(wide.stats.lines.value, (12'000U + 63) / 64);
    EXPECT_EQ(narrow.stats.lines.value, (6'000U + 63) / 64);
    for (std::size_t i = 0; i < 1000; ++i) EXPECT_EQ(wide.primitives[i].vertices, narrow.primitives[i].vertices);
}

TEST(IndexFetch, BytesPerCycleLimitTheRate) {
    const tests::GeometryScene scene = tests::make_scene(tests::grid_mesh(20, 50)); // 2000 triangles of 12 bytes
    for (const double rate : {4.0, 6.0, 8.0, 9.6, 12.0}) {
        const Cycles cycles = fetch(scene, {.lines_in_flight = 1024, .bytes_per_clk = rate}).cycles;
        const double per_triangle = static_cast<double>(cycles.back() - cycles.front()) / 1999;
        EXPECT_NEAR(per_triangle, 12 / rate, 0.01) << rate;
    }
}

TEST(IndexFetch, StripsReadOneNewIndexPerTriangle) {
    const tests::GeometryScene scene =
        tests::make_scene({{.topology = Topology::triangle_strip, .vertex_count = 1002, .indices = counting(1002)}});
    const FetchRun run = fetch(scene, {.lines_in_flight = 1024, .bytes_per_clk = 4});
    ASSERT_EQ(run.primitives.size(), 1000U);
    EXPECT_EQ(run.stats.indices.value, 1002U);
    EXPECT_NEAR(static_cast<double>(run.cycles.back() - run.cycles.front()), 999, 5); // 4 bytes each
}

TEST(IndexFetch, FansKeepTheirCentre) {
    const tests::GeometryScene scene =
        tests::make_scene({{.topology = Topology::triangle_fan, .vertex_count = 502, .indices = counting(502)}});
    const FetchRun run = fetch(scene, {.lines_in_flight = 2});
    ASSERT_EQ(run.primitives.size(), 500U);
    EXPECT_EQ(run.stats.indices.value, 502U);
    EXPECT_EQ(run.stats.lines.value, (502U * 4 + 63) / 64);
    EXPECT_EQ(run.primitives[499].vertices, (std::array<std::uint32_t, 3>{500, 501, 0}));
}

TEST(IndexFetch, LinesInFlightBoundTheRate) {
    const tests::GeometryScene scene = tests::make_scene(tests::grid_mesh(20, 50)); // 24,000 bytes
    const Cycles cycles = fetch(scene, {.line = 64, .lines_in_flight = 2}).cycles;
    const Cycle lines = 24'000 / 64;
    EXPECT_GE(cycles.back(), lines / 2 * (memory_latency + 2));
}

// Little's law: 12 bytes a cycle over the way to memory and back, with jitter.
TEST(IndexFetch, PHY_P13_SustainsATriangleOf32BitIndicesPerCycle) {
    const tests::GeometryScene scene = tests::make_scene(tests::grid_mesh(100, 100)); // 20,000 triangles
    pipeline::GpuParams gpu;
    models::load_gpu("neutral").read("", gpu);
    pipeline::IndexFetchParams params = gpu.geometry.index_fetch;
    params.primitives_per_clk = 2; // so that memory is the limit
    const Cycles cycles = fetch(scene, params, {}, sim::Mode::normal, 1, 321).cycles;
    EXPECT_GE(12.0 * 20'000 / static_cast<double>(cycles.back() - cycles.front()), 12.0);
}

TEST(IndexFetch, DrawsWithoutIndicesPassBetweenThoseWith) {
    const tests::GeometryScene scene = tests::make_scene({
        {.vertex_count = 6, .indices = {5, 4, 3, 2, 1, 0}, .instances = 2},
        {.index_type = IndexType::none, .vertex_count = 9, .indices = counting(9)},
        {.vertex_count = 3, .indices = {}}, // draws nothing
        {.index_type = IndexType::u8, .vertex_count = 3, .indices = {2, 1, 0}},
    });
    const FetchRun run = fetch(scene, {});
    ASSERT_EQ(run.primitives.size(), 4U + 3 + 1);
    EXPECT_EQ(run.primitives[2].vertices, (std::array<std::uint32_t, 3>{5, 4, 3})); // the second instance
    EXPECT_EQ(run.primitives[5].vertices, (std::array<std::uint32_t, 3>{3, 4, 5}));
    EXPECT_EQ(run.primitives[7].vertices, (std::array<std::uint32_t, 3>{2, 1, 0}));
    for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(run.primitives[i].primitive, i);
    EXPECT_EQ(run.stats.draws.value, 5U);
    EXPECT_EQ(run.stats.lines.value, 3U); // one for each instance that has an index buffer and draws
}

TEST(IndexFetch, LinesOfTheNextDrawAreRequestedWhileThisOneIsSent) {
    const std::vector<tests::SceneDraw> draws(10, {.vertex_count = 300, .indices = counting(300)});
    const FetchRun run = fetch(tests::make_scene(draws), {});
    // 1000 triangles at one per cycle, and the latency of the first line only.
    EXPECT_LT(run.cycles.back(), 1000 + 2 * memory_latency);
}

TEST(IndexFetch, BlockedOutputLosesNothing) {
    const FetchRun run = fetch(tests::make_scene(tests::grid_mesh(10, 10)), {.primitives_per_clk = 2}, {.every = 5});
    EXPECT_EQ(run.primitives.size(), 200U);
}

TEST(IndexFetch, SameInAllModes) {
    const tests::GeometryScene scene = tests::make_scene({
        {.vertex_count = 300, .indices = counting(300), .instances = 3},
        {.topology = Topology::triangle_strip,
         .index_type = IndexType::u16,
         .vertex_count = 90,
         .indices = counting(90)},
        tests::restarted(Topology::triangle_strip, IndexType::u8, {~0U, 1, 2, 3, 4, ~0U, ~0U, 5, 6, 7, ~0U, 8}),
    });
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        return fetch(scene, {.lines_in_flight = 3, .bytes_per_clk = 7.3}, {.every = 2}, mode, shuffle).cycles;
    });
}

TEST(PrimitiveCounter, CountsVerticesOfDrawsWithoutIndexBuffers) {
    const tests::GeometryScene scene = tests::make_scene({
        {.index_type = IndexType::none, .vertex_count = 9, .indices = counting(9)},
        {.topology = Topology::triangle_strip,
         .index_type = IndexType::none,
         .vertex_count = 5,
         .indices = counting(5)},
    });
    const GeometryPass pass = pass_of(scene);
    Rig rig;
    PrimitiveCounter stage(rig.context("counter"), pass);
    Source<DrawCommand> source(rig.context("source"), commands(scene));
    Sink<IndexedPrimitive> sink(rig.context("sink"));
    sim::connect(source.out, stage.draws_in, {});
    sim::connect(stage.primitives_out, sink.in, {});
    rig.simulation.run();
    EXPECT_EQ(sink.cycles(), (Cycles{2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(sink.values()[1].vertices, (std::array<std::uint32_t, 3>{3, 4, 5}));
    EXPECT_EQ(sink.values()[3].vertices, (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(stage.stats().bytes.value, 0U);
    EXPECT_EQ(stage.stats().draws.value, 2U);
}

// ---- vertex fetch

struct VertexRun {
    Cycles cycles;
    std::vector<MemoryRequest> requests;
    VertexFetchStats stats;
};

VertexRun fetch_vertices(const tests::GeometryScene& scene, const std::vector<std::uint32_t>& order,
                         const VertexFetchParams& params, const Needs& needs = {}, tests::SinkOptions sink_options = {},
                         sim::Mode mode = sim::Mode::normal, std::uint64_t shuffle = 1) {
    const GeometryPass pass = pass_of(scene);
    std::vector<VertexRequest> list;
    for (std::uint32_t i = 0; i < order.size(); ++i) list.push_back({i + 1, 0, order[i]});
    Rig rig(mode, 1, shuffle);
    VertexFetch stage(rig.context("fetch"), params, pass, needs);
    Memory memory(rig.context("memory"), memory_latency, answer);
    Source<VertexRequest> source(rig.context("source"), list);
    Sink<VertexTask> sink(rig.context("sink"), std::move(sink_options));
    sim::connect(source.out, stage.vertices_in, {.width = 2});
    sim::connect(stage.requests_out, memory.requests_in, {});
    sim::connect(memory.responses_out, stage.responses_in, {});
    sim::connect(stage.vertices_out, sink.in, {.width = 2});
    rig.simulation.run();
    for (std::uint32_t i = 0; i < sink.size(); ++i) EXPECT_EQ(sink.arrivals()[i].value.sequence, i + 1);
    EXPECT_EQ(sink.size(), order.size());
    return {sink.cycles(), memory.requests(), stage.stats()};
}

tests::GeometryScene vertex_scene(std::uint32_t count, std::uint32_t vertex_bytes) {
    return tests::make_scene({{.vertex_count = count, .indices = {0, 1, 2}, .vertex_bytes = vertex_bytes}});
}

TEST(VertexFetch, MissTakesTheMemoryLatencyAndAHitTheNextCycle) {
    const VertexRun run = fetch_vertices(vertex_scene(8, 12), {0, 1, 0}, {});
    // Request at 1, answer at 1 + 1 + 100 + 1; a second vertex in the line leaves with it, a third one cycle later.
    const Cycle first = 1 + 1 + memory_latency + 1 + 1;
    EXPECT_EQ(run.cycles, (Cycles{first, first, first + 1}));
    EXPECT_EQ(run.stats.cache.misses.value, 1U);
    EXPECT_EQ(run.stats.merged.value, 2U);
}

TEST(VertexFetch, SequentialVerticesCostTheirBytes) {
    const VertexRun run = fetch_vertices(vertex_scene(800, 12), counting(800), {});
    EXPECT_EQ(run.stats.bytes.value, 800U * 12);
    EXPECT_EQ(run.requests.size(), 800U * 12 / 32);
    EXPECT_EQ(run.stats.cache.misses.value, run.requests.size());
    // A vertex of 12 bytes straddles two lines of 32 at two of eight places.
    EXPECT_EQ(run.stats.cache.accesses(), 800U + 800 * 2 / 8);
    EXPECT_EQ(run.stats.vertices.value, 800U);
}

TEST(VertexFetch, AttributesThatNobodyReadsCostNothing) {
    const tests::GeometryScene scene = vertex_scene(320, 32);
    const auto bytes_with = [&](const Needs& needs) {
        VertexFetchParams params;
        params.cache = {.bytes = 4096, .line = 4, .ways = 4};
        params.lines_per_clk = 8;
        return fetch_vertices(scene, counting(320), params, needs).stats.bytes.value;
    };
    EXPECT_EQ(bytes_with({}), 320U * 12);
    EXPECT_EQ(bytes_with({.normals = true}), 320U * 24);
    EXPECT_EQ(bytes_with({.texcoords = true}), 320U * 20);
    EXPECT_EQ(bytes_with({.normals = true, .texcoords = true}), 320U * 32);
    EXPECT_EQ(bytes_with({.vertex_colours = true}), 320U * 12); // the mesh has none
    // A vertex shader reads what shading does not need.
    EXPECT_EQ(bytes_with({.attributes = mask_of(Semantic::normal)}), 320U * 24);
    EXPECT_EQ(bytes_with({.attributes = mask_of(Semantic::texcoord0)}), 320U * 20);
    EXPECT_EQ(bytes_with({.attributes = mask_of(Semantic::texcoord1)}), 320U * 12);
    EXPECT_EQ(bytes_with({.texcoords = true, .attributes = ~0U}), 320U * 32);
}

// One attribute of `bytes` bytes at any stride and offset.
tests::GeometryScene strided_scene(std::uint32_t count, std::uint32_t bytes, std::uint32_t stride,
                                   std::uint64_t offset) {
    tests::GeometryScene scene = vertex_scene(count, 12);
    Resources resources = *scene.frame.resources;
    resources.buffers[0].bytes.resize(offset + std::uint64_t{stride} * count + bytes);
    resources.geometries[0].attributes = {{.type = ComponentType::u8,
                                           .components = static_cast<std::uint8_t>(bytes),
                                           .offset = offset,
                                           .stride = stride}};
    resources.place();
    resources.validate("strides");
    scene.frame.resources = std::make_shared<const Resources>(std::move(resources));
    return scene;
}

TEST(VertexFetch, StridesOf1To2048BytesFetchTheLinesOfTheirAddresses) {
    constexpr std::uint32_t count = 20;
    for (std::uint32_t stride = 1; stride <= 2048; ++stride) {
        const std::uint32_t bytes = std::min(4U, stride);
        const std::uint64_t offset = stride % 37;
        const tests::GeometryScene scene = strided_scene(count, bytes, stride, offset);
        std::set<std::uint64_t> expected;
        for (std::uint64_t i = 0; i < count; ++i)
            for (std::uint64_t byte = 0; byte < bytes; ++byte) expected.insert((offset + i * stride + byte) / 32 * 32);
        VertexFetchParams params;
        params.cache.bytes = 1U << 20U;
        const VertexRun run = fetch_vertices(scene, counting(count), params);
        std::set<std::uint64_t> found;
        for (const MemoryRequest& request : run.requests) found.insert(request.address);
        ASSERT_EQ(found, expected) << stride;
        ASSERT_EQ(run.requests.size(), expected.size()) << stride;
    }
}

TEST(VertexFetch, LineSharedByAttributesOfOneVertexIsLookedUpOnce) {
    const VertexRun run =
        fetch_vertices(vertex_scene(100, 32), counting(100), {}, {.normals = true, .texcoords = true});
    EXPECT_EQ(run.stats.cache.accesses(), 100U);
    EXPECT_EQ(run.stats.cache.misses.value, 100U);
}

TEST(VertexFetch, CacheHoldsWhatFitsAndNoMore) {
    std::vector<std::uint32_t> twice = counting(512); // 512 vertices of 32 bytes: 16 KiB
    for (const std::uint32_t vertex : counting(512)) twice.push_back(vertex);
    VertexFetchParams params;
    EXPECT_EQ(fetch_vertices(vertex_scene(512, 32), twice, params).stats.cache.misses.value, 512U);
    params.cache.bytes = 8192; // a cyclic stream larger than an LRU cache gets no hit
    EXPECT_EQ(fetch_vertices(vertex_scene(512, 32), twice, params).stats.cache.misses.value, 1024U);
}

TEST(VertexFetch, HitsAndMissesAreAccessesThoughRetriedOnesWait) {
    VertexFetchParams params;
    params.lines_in_flight = 1;
    const VertexRun run = fetch_vertices(vertex_scene(64, 32), counting(64), params);
    EXPECT_EQ(run.stats.cache.accesses(), 64U);
    EXPECT_EQ(run.requests.size(), 64U);
    EXPECT_GE(run.cycles.back(), 64 * memory_latency);
    EXPECT_EQ(run.stats.lines_in_flight.value, 1U);
}

TEST(VertexFetch, VerticesInFlightAreBounded) {
    VertexFetchParams params;
    params.vertices_in_flight = 5;
    const VertexRun run = fetch_vertices(vertex_scene(300, 12), counting(300), params);
    EXPECT_EQ(run.stats.vertices_in_flight.value, 5U);
}

TEST(VertexFetch, HeldVerticesPassAtTheWidthOfTheLinks) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < 2000; ++i) order.push_back(i % 2);
    const VertexRun run = fetch_vertices(vertex_scene(2, 12), order, {});
    EXPECT_LE(run.cycles.back() - run.cycles.front(), 1001U);
}

TEST(VertexFetch, LinesPerCycleLimitTheRate) {
    std::vector<std::uint32_t> order(500, 0);
    VertexFetchParams params;
    params.cache = {.bytes = 4096, .line = 4, .ways = 4};
    params.lines_per_clk = 1; // three lines per vertex
    const VertexRun run = fetch_vertices(vertex_scene(3, 12), order, params);
    EXPECT_NEAR(static_cast<double>(run.cycles.back() - run.cycles.front()), 3.0 * 500 - memory_latency, 10);
}

TEST(VertexFetch, SlowReceiverLosesNothing) {
    const VertexRun run = fetch_vertices(vertex_scene(300, 24), counting(300), {}, {.normals = true}, {.every = 7});
    EXPECT_EQ(run.cycles.size(), 300U);
}

TEST(VertexFetch, SameInAllModes) {
    const tests::GeometryScene scene = vertex_scene(400, 24);
    std::vector<std::uint32_t> order;
    for (const std::uint32_t index : tests::random_mesh(300, 400, 5).indices) order.push_back(index);
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        VertexFetchParams params;
        params.cache.bytes = 2048;
        params.lines_in_flight = 9;
        return fetch_vertices(scene, order, params, {.normals = true}, {.every = 2}, mode, shuffle).cycles;
    });
}

} // namespace geometry_fetch_test
