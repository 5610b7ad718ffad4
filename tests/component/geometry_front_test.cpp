// The whole geometry front with its memory: the same counts as the models without time, conservation, what is built.
#include "pipeline/geometry/geometry_front.hpp"
#include "pipeline/memory/memory_system.hpp"
#include "sim/described_json.hpp"
#include "tests/support/geometry_scene.hpp"
#include "tests/support/sim_kit.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

namespace geometry_front_test {

using namespace pipeline;
using sim::Cycle;
using tests::GeometryScene;

class Front {
  public:
    explicit Front(const GeometryScene& scene_, const GeometryParams& params = {}, const Needs* needs = nullptr,
                   sim::Mode mode = sim::Mode::normal, std::uint64_t shuffle = 1, tests::SinkOptions sink_options = {})
        : scene(&scene_),
          rig(mode, 1, shuffle),
          memory(rig.simulation, rig.clock, {}),
          front(rig.simulation, rig.clock, params, scene_.frame, needs != nullptr ? *needs : scene_.frame.needs),
          sink(rig.context("sink"), std::move(sink_options)) {
        front.attach(memory);
        sim::connect(front.triangles_out(), sink.in, {.capacity = 16});
    }
    Front& pass() {
        front.start(scene->stream, scene->frame.draws);
        rig.simulation.run();
        return *this;
    }
    std::vector<std::uint32_t> triangles() const {
        std::vector<std::uint32_t> list;
        for (const TriangleTask& task : sink.values()) list.push_back(task.triangle);
        return list;
    }
    std::uint64_t bytes(MemoryClient client) const {
        return memory.controller_stats().bytes[static_cast<std::size_t>(client)];
    }

    const GeometryScene* scene;
    tests::Rig rig;
    MemorySystem memory;
    GeometryFront front;
    tests::Sink<TriangleTask> sink;
};

std::vector<std::uint32_t> first_numbers(std::size_t count) {
    std::vector<std::uint32_t> list(count);
    std::iota(list.begin(), list.end(), 0U);
    return list;
}

std::uint32_t model_runs(const tests::IndexedMesh& mesh, const VertexReuseParams& params) {
    VertexReuseModel model(params);
    model.begin_draw(mesh.vertex_count, true);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        model.triangle({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
    return model.runs();
}

/// Several draws, instanced and not, indexed and not, with culled and clipped primitives.
GeometryScene mixed_scene() {
    const tests::IndexedMesh random = tests::random_mesh(60, 50, 4);
    const tests::IndexedMesh grid = tests::grid_mesh(8, 8);
    GeometryScene scene = tests::make_scene({
        {.vertex_count = grid.vertex_count, .indices = grid.indices, .instances = 3, .vertex_bytes = 32},
        {.index_type = IndexType::none, .vertex_count = 90, .indices = first_numbers(90), .vertex_bytes = 24},
        {.vertex_count = random.vertex_count, .indices = random.indices, .vertex_bytes = 12},
        {.topology = Topology::triangle_strip,
         .index_type = IndexType::u16,
         .vertex_count = 40,
         .indices = first_numbers(40)},
    });
    for (std::uint32_t i = 0; i < scene.stream.primitives.size(); ++i) {
        if (i % 3 == 0) tests::set_fate(scene, i, PrimitiveFate::culled_facing, 0, false);
        if (i % 31 == 1) tests::set_fate(scene, i, PrimitiveFate::drawn, 3, true);
    }
    tests::rebuild(scene);
    return scene;
}

TEST(GeometryFront, PointsAndLinesCountTheirOwnCorners) {
    struct Kind {
        Topology topology;
        std::uint32_t primitives, corners;
    };
    for (const IndexType type : {IndexType::u16, IndexType::none})
        for (const Kind& kind : {Kind{Topology::points, 100, 1},
                                 {Topology::lines, 50, 2},
                                 {Topology::line_strip, 99, 2},
                                 {Topology::line_loop, 100, 2}}) {
            const GeometryScene scene = tests::make_scene(
                {{.topology = kind.topology, .index_type = type, .vertex_count = 100, .indices = first_numbers(100)}});
            Front run(scene, {});
            run.pass();
            const GeometryStats stats = run.front.stats();
            EXPECT_EQ(stats.vertex_reuse.misses.value, kind.topology == Topology::line_loop ? 101U : 100U);
            EXPECT_EQ(stats.vertex_reuse.hits.value + stats.vertex_reuse.misses.value, kind.primitives * kind.corners);
            EXPECT_EQ(stats.primitive_assembly.primitives.value, kind.primitives);
            EXPECT_EQ(stats.triangle_setup.triangles.value, kind.primitives);
        }
}

TEST(GeometryFront, TimedCountsEqualTheModelsWithoutTime) {
    const std::vector<tests::IndexedMesh> meshes{tests::grid_mesh(40, 40), tests::shuffled(tests::grid_mesh(40, 40), 1),
                                                 tests::sphere_mesh(30, 50), tests::random_mesh(2000, 700, 2),
                                                 tests::grass_mesh(500)};
    const std::vector<VertexReuseParams> models{
        {.entries = 3},
        {.entries = 24},
        {.model = ReuseModel::batch, .entries = 32, .warp_vertices = 32},
        {.model = ReuseModel::batch, .entries = 14, .warp_vertices = 64, .group_triangles = 128},
        {.model = ReuseModel::mesa},
        {.model = ReuseModel::lru, .entries = 3},
        {.model = ReuseModel::lru, .entries = 24}};
    for (const tests::IndexedMesh& mesh : meshes)
        for (const VertexReuseParams& model : models) {
            const GeometryScene scene = tests::make_scene(mesh);
            GeometryParams params;
            params.vertex_reuse = model;
            Front run(scene, params);
            run.pass();
            const GeometryStats stats = run.front.stats();
            const std::uint32_t runs = model_runs(mesh, model);
            EXPECT_EQ(stats.vertex_reuse.misses.value, runs) << mesh.name;
            EXPECT_EQ(stats.vertex_shader.vertices.value, runs);
            EXPECT_EQ(run.front.draw_stats(0).vertex_shader_runs.value, runs);
            EXPECT_EQ(run.triangles(), first_numbers(mesh.indices.size() / 3));
        }
}

TEST(GeometryFront, G1GrassHasTheCountsOfItsBlades) {
    const std::uint32_t blades = 1000;
    const GeometryScene scene = tests::make_scene(tests::grass_mesh(blades));
    Front run(scene);
    run.pass();
    const GeometryDrawStats draw = run.front.draw_stats(0);
    EXPECT_EQ(draw.primitives.value, 5 * blades);
    EXPECT_EQ(draw.vertices_referenced.value, 15 * blades);
    EXPECT_EQ(draw.vertex_shader_runs.value, 7 * blades);
    EXPECT_DOUBLE_EQ(draw.acmr(), 1.4);
}

TEST(GeometryFront, WhatEntersAStageLeavesIt) {
    const GeometryScene scene = mixed_scene();
    Front run(scene);
    run.pass();
    const GeometryStats stats = run.front.stats();
    EXPECT_EQ(stats.command_processor.draws.value, 4U);
    EXPECT_EQ(stats.command_processor.instances.value, 6U);
    EXPECT_EQ(stats.index_fetch.primitives.value, scene.stream.primitives.size());
    EXPECT_EQ(stats.vertex_reuse.primitives.value, stats.index_fetch.primitives.value);
    EXPECT_EQ(stats.vertex_reuse.hits + stats.vertex_reuse.misses, 3 * stats.vertex_reuse.primitives);
    EXPECT_EQ(stats.vertex_fetch.vertices.value, stats.vertex_reuse.misses.value);
    EXPECT_EQ(stats.vertex_shader.vertices.value, stats.vertex_reuse.misses.value);
    EXPECT_EQ(stats.primitive_assembly.vertices.value, stats.vertex_reuse.misses.value);
    EXPECT_EQ(stats.primitive_assembly.primitives.value, stats.index_fetch.primitives.value);
    EXPECT_EQ(stats.clip_cull.drawn + stats.clip_cull.culled(), stats.clip_cull.primitives.value);
    EXPECT_EQ(stats.triangle_setup.triangles.value, scene.stream.triangles.size());
    EXPECT_EQ(run.triangles(), first_numbers(scene.stream.triangles.size()));
    EXPECT_EQ(stats.vertex_fetch.bytes.value, stats.vertex_fetch.cache.misses * 32);
    EXPECT_EQ(run.bytes(MemoryClient::vertex), stats.vertex_fetch.bytes.value);
    EXPECT_EQ(run.bytes(MemoryClient::index), stats.index_fetch.bytes.value);
}

TEST(GeometryFront, CountersOfDrawsAddUpToThoseOfStages) {
    const GeometryScene scene = mixed_scene();
    Front run(scene);
    run.pass();
    GeometryDrawStats sum;
    for (std::uint32_t draw = 0; draw < 4; ++draw) {
        const GeometryDrawStats one = run.front.draw_stats(draw);
        EXPECT_EQ(one.vertex_bytes.value, run.memory.draw_bytes(draw)[static_cast<std::size_t>(MemoryClient::vertex)]);
        EXPECT_EQ(one.index_bytes.value, run.memory.draw_bytes(draw)[static_cast<std::size_t>(MemoryClient::index)]);
        sim::add(sum, one);
    }
    const GeometryStats stats = run.front.stats();
    EXPECT_EQ(sum.primitives.value, stats.clip_cull.primitives.value);
    EXPECT_EQ(sum.vertex_shader_runs.value, stats.vertex_shader.vertices.value);
    EXPECT_EQ(sum.culled.value, stats.clip_cull.culled());
    EXPECT_EQ(sum.clipped.value, stats.clip_cull.clipped.value);
    EXPECT_EQ(sum.triangles.value, stats.triangle_setup.triangles.value);
    EXPECT_EQ(run.front.draw_stats(1).index_bytes.value, 0U);
    EXPECT_EQ(run.front.draw_stats(9).primitives.value, 0U);
}

TEST(GeometryFront, SetupBoundFrameTakesSetupTimePerTriangle) {
    const GeometryScene scene = tests::make_scene(tests::grid_mesh(100, 100));
    Front run(scene);
    run.pass();
    const std::vector<Cycle> cycles = run.sink.cycles();
    EXPECT_EQ(cycles.back() - cycles.front(), 2U * 19'999);
}

TEST(GeometryFront, VertexBoundFrameTakesShaderTimePerVertex) {
    const tests::IndexedMesh mesh = tests::random_mesh(3000, 100'000, 5);
    const GeometryScene scene = tests::make_scene(mesh);
    GeometryParams params;
    params.vertex_shader = {.units = 2, .cycles_per_vertex = 16};
    Front run(scene, params);
    run.pass();
    const double cycles = static_cast<double>(run.sink.cycles().back());
    EXPECT_NEAR(cycles / static_cast<double>(run.front.stats().vertex_shader.vertices.value), 8.0, 0.5);
}

TEST(GeometryFront, G10BusOf4GigabytesPerSecondGivesAtMost125MillionVerticesPerSecond) {
    // Arrays of the application, 32 bytes per vertex, drawn without indices: the memory behind the front is the bus.
    const std::uint32_t count = 30'000;
    const GeometryScene scene = tests::make_scene(
        {{.index_type = IndexType::none, .vertex_count = count, .indices = first_numbers(count), .vertex_bytes = 32}});
    Needs needs = scene.frame.needs;
    needs.normals = true;
    needs.texcoords = true;
    sim::Simulation simulation;
    const sim::Clock& clock = simulation.add_clock("core", 430);
    MemoryParams bus;
    bus.partitions = 1;
    bus.bandwidth = 4;
    MemorySystem memory(simulation, clock, bus);
    GeometryFront front(simulation, clock, {}, scene.frame, needs);
    tests::Sink<TriangleTask> sink(simulation.context("sink", clock));
    front.attach(memory);
    sim::connect(front.triangles_out(), sink.in, {});
    front.start(scene.stream, scene.frame.draws);
    simulation.run();
    const double rate = count / (static_cast<double>(simulation.now()) * 1e-12);
    EXPECT_LE(rate, 125e6);
    EXPECT_GE(rate, 0.97 * 125e6);
}

TEST(GeometryFront, IndexFetchIsBuiltOnlyWhenIndicesAreRead) {
    const GeometryScene scene =
        tests::make_scene({{.index_type = IndexType::none, .vertex_count = 300, .indices = first_numbers(300)}});
    EXPECT_FALSE(scene.frame.needs.index_buffer);
    Front without(scene);
    without.pass();
    EXPECT_FALSE(without.front.has_index_fetch());
    EXPECT_TRUE(without.front.report().contains("primitive_counter"));
    EXPECT_FALSE(without.front.report().contains("index_fetch"));
    EXPECT_EQ(without.bytes(MemoryClient::index), 0U);

    Needs all = scene.frame.needs;
    all.index_buffer = true;
    Front with(scene, {}, &all);
    with.pass();
    EXPECT_TRUE(with.front.has_index_fetch());
    EXPECT_EQ(with.triangles(), without.triangles());
    EXPECT_EQ(sim::to_json(with.front.stats().vertex_fetch), sim::to_json(without.front.stats().vertex_fetch));
    EXPECT_EQ(sim::to_json(with.front.stats().clip_cull), sim::to_json(without.front.stats().clip_cull));
}

TEST(GeometryFront, PassesAreCountedByDifferences) {
    const GeometryScene scene = mixed_scene();
    Front run(scene);
    run.pass();
    const GeometryStats first = run.front.stats();
    const Cycle first_cycles = run.rig.cycles();
    run.pass();
    const GeometryStats second = sim::difference(run.front.stats(), first);
    EXPECT_EQ(sim::to_json(second.vertex_reuse), sim::to_json(first.vertex_reuse));
    EXPECT_EQ(sim::to_json(second.clip_cull), sim::to_json(first.clip_cull));
    EXPECT_EQ(run.sink.size(), 2 * scene.stream.triangles.size());
    // The pre-transform cache is warm, so the second pass may be a little shorter, never much longer.
    EXPECT_LE(run.rig.cycles() - first_cycles, first_cycles + 2);
    EXPECT_LE(second.vertex_fetch.bytes.value, first.vertex_fetch.bytes.value);
}

TEST(GeometryFront, SomeRangesCanBeDrawnAlone) {
    const GeometryScene scene = mixed_scene();
    Front run(scene);
    const std::span<const DrawRange> ranges(scene.stream.draws);
    run.front.start(scene.stream, scene.frame.draws, ranges.subspan(3, 2));
    run.rig.simulation.run();
    const std::uint32_t first = scene.stream.draws[3].first_primitive;
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < scene.stream.triangles.size(); ++i)
        if (scene.stream.triangles[i].primitive >= first &&
            scene.stream.triangles[i].primitive < scene.stream.draws[5].first_primitive)
            expected.push_back(i);
    EXPECT_EQ(run.triangles(), expected);
}

TEST(GeometryFront, EmptyPassEndsAtOnce) {
    GeometryScene scene = tests::make_scene(tests::grid_mesh(2, 2));
    scene.stream.draws.own().clear();
    Front run(scene);
    run.pass();
    EXPECT_EQ(run.sink.size(), 0U);
}

TEST(GeometryFront, ActivitiesOfEveryStageSumToTheElapsedTime) {
    const GeometryScene scene = mixed_scene();
    Front run(scene);
    run.pass();
    const nlohmann::ordered_json stages = run.front.report();
    for (const auto& [stage, report] : stages.items()) {
        Cycle sum = 0;
        for (const auto& [activity, cycles] : report["activity"].items()) sum += cycles.get<Cycle>();
        EXPECT_EQ(sum, run.rig.cycles()) << stage;
    }
}

TEST(GeometryFront, SlowReceiverLosesNothing) {
    const GeometryScene scene = mixed_scene();
    Front run(scene, {}, nullptr, sim::Mode::normal, 1, {.every = 11});
    run.pass();
    EXPECT_EQ(run.triangles(), first_numbers(scene.stream.triangles.size()));
}

TEST(GeometryFront, SmallestParametersStillFinish) {
    const GeometryScene scene = mixed_scene();
    GeometryParams params;
    params.index_fetch = {.line = 16, .lines_in_flight = 2, .bytes_per_clk = 0.5};
    params.vertex_reuse = {.entries = 3, .vertices_per_clk = 1};
    params.vertex_fetch = {.cache = {.bytes = 4, .line = 4, .ways = 1},
                           .lines_per_clk = 1,
                           .lines_in_flight = 1,
                           .vertices_in_flight = 1,
                           .hit_latency = 1};
    params.vertex_shader = {.units = 1, .cycles_per_vertex = 1};
    params.primitive_assembly = {.primitives_in_flight = 2};
    Front run(scene, params);
    run.pass();
    EXPECT_EQ(run.triangles(), first_numbers(scene.stream.triangles.size()));
}

TEST(GeometryFront, LinesWiderThanTheInterleaveAreAnInputError) {
    const GeometryScene scene = mixed_scene();
    GeometryParams params;
    params.index_fetch.line = 512;
    try {
        Front run(scene, params);
        FAIL();
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(), "geometry.index_fetch.line: expected at most memory.interleave = 256, got 512");
    }
}

TEST(GeometryFront, SameInAllModes) {
    const GeometryScene scene = mixed_scene();
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        Front run(scene, {}, nullptr, mode, shuffle);
        run.pass();
        run.pass();
        return std::pair{run.sink.cycles(), run.front.report().dump() + run.memory.report().dump()};
    });
}

} // namespace geometry_front_test
