// The stages of the geometry front one at a time, between sources and sinks.
#include "pipeline/geometry/clip_cull.hpp"
#include "pipeline/geometry/command_processor.hpp"
#include "pipeline/geometry/primitive_assembly.hpp"
#include "pipeline/geometry/triangle_setup.hpp"
#include "pipeline/geometry/vertex_reuse.hpp"
#include "pipeline/geometry/vertex_shader.hpp"
#include "tests/support/geometry_scene.hpp"
#include "tests/support/index_fetch_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <numeric>

namespace geometry_stages_test {

using namespace pipeline;
using sim::Cycle;
using Cycles = std::vector<Cycle>;
using tests::Rig;
using tests::Sink;
using tests::Source;

tests::SceneDraw one_triangle(std::uint32_t instances = 1) {
    return {.vertex_count = 3, .indices = {0, 1, 2}, .instances = instances};
}

std::vector<VertexTask> vertices(std::uint32_t count) {
    std::vector<VertexTask> list(count);
    for (std::uint32_t i = 0; i < count; ++i) list[i].sequence = i + 1;
    return list;
}

// ---- command processor

Cycles draw_cycles(const std::vector<tests::SceneDraw>& draws, const CommandProcessorParams& params,
                   CommandProcessorStats* stats = nullptr, tests::SinkOptions sink_options = {}) {
    const tests::GeometryScene scene = tests::make_scene(draws);
    const GeometryPass pass = pass_of(scene);
    Rig rig;
    CommandProcessor processor(rig.context("processor"), params, pass);
    Sink<DrawCommand> sink(rig.context("sink"), std::move(sink_options));
    sim::connect(processor.draws_out, sink.in, {});
    processor.start();
    rig.simulation.run();
    for (std::uint32_t i = 0; i < sink.size(); ++i) EXPECT_EQ(sink.arrivals()[i].value.range, i);
    if (stats != nullptr) *stats = processor.stats();
    return sink.cycles();
}

TEST(CommandProcessor, DrawLeavesAfterItsGpuCost) {
    EXPECT_EQ(draw_cycles({one_triangle()}, {.draw_cpu_us = 0, .draw_gpu_cycles = 200}), Cycles{1 + 200 + 1});
}

TEST(CommandProcessor, OtherTargetsCostTheFirstDrawOfAPass) {
    const tests::GeometryScene scene = tests::make_scene({one_triangle(), one_triangle()});
    const GeometryPass pass = pass_of(scene);
    for (const bool switches : {false, true}) {
        Rig rig;
        CommandProcessor processor(rig.context("processor"),
                                   {.draw_cpu_us = 0, .draw_gpu_cycles = 200, .target_switch_cycles = 1000}, pass);
        Sink<DrawCommand> sink(rig.context("sink"), {});
        sim::connect(processor.draws_out, sink.in, {});
        processor.start(switches);
        rig.simulation.run();
        const sim::Cycle first = 1 + 200 + (switches ? 1000 : 0) + 1;
        EXPECT_EQ(sink.cycles(), (Cycles{first, first + 201}));
        EXPECT_EQ(processor.stats().target_switches, switches ? 1U : 0U);
    }
}

TEST(CommandProcessor, GpuBoundDrawsAreOneCostApart) {
    const std::vector<tests::SceneDraw> draws(5, one_triangle());
    const Cycles cycles = draw_cycles(draws, {.draw_cpu_us = 0, .draw_gpu_cycles = 200});
    for (std::size_t i = 1; i < cycles.size(); ++i) EXPECT_EQ(cycles[i] - cycles[i - 1], 201U);
}

TEST(CommandProcessor, DrawIsNotAvailableBeforeTheCpuHasSubmittedIt) {
    const std::vector<tests::SceneDraw> draws(4, one_triangle());
    CommandProcessorStats stats;
    // 2 us are 2000 cycles; the pass begins at cycle 1.
    EXPECT_EQ(draw_cycles(draws, {.draw_cpu_us = 2, .draw_gpu_cycles = 200}, &stats), (Cycles{202, 2202, 4202, 6202}));
    EXPECT_EQ(stats.draws.value, 4U);
    EXPECT_EQ(stats.cpu_wait_cycles.value, 3U * (2000 - 200));
}

TEST(CommandProcessor, InstancesAreOneCallOfWhichTheFirstPays) {
    CommandProcessorStats stats;
    const Cycles cycles =
        draw_cycles({one_triangle(3), one_triangle(2)}, {.draw_cpu_us = 2, .draw_gpu_cycles = 200}, &stats);
    EXPECT_EQ(cycles, (Cycles{202, 203, 204, 2202, 2203}));
    EXPECT_EQ(stats.draws.value, 2U);
    EXPECT_EQ(stats.instances.value, 5U);
}

TEST(CommandProcessor, WaitsForRoomWithoutLosingDraws) {
    const std::vector<tests::SceneDraw> draws(8, one_triangle());
    EXPECT_EQ(draw_cycles(draws, {.draw_cpu_us = 0, .draw_gpu_cycles = 3}, nullptr, {.every = 50}).size(), 8U);
}

TEST(CommandProcessor, NextPassStartsWhereTheLastOneEnded) {
    const tests::GeometryScene scene = tests::make_scene({one_triangle(), one_triangle()});
    const GeometryPass pass = pass_of(scene);
    Rig rig;
    CommandProcessor processor(rig.context("processor"), {.draw_cpu_us = 1, .draw_gpu_cycles = 10}, pass);
    Sink<DrawCommand> sink(rig.context("sink"));
    sim::connect(processor.draws_out, sink.in, {});
    for (int i = 0; i < 2; ++i) {
        processor.start();
        rig.simulation.run();
    }
    const Cycles cycles = sink.cycles();
    ASSERT_EQ(cycles.size(), 4U);
    EXPECT_EQ(cycles[1] - cycles[0], cycles[3] - cycles[2]);
    EXPECT_EQ(cycles[2], cycles[1] + 1 + 1 + 10 + 1); // the sink's last tick, the next edge, the cost, the link
}

// ---- vertex reuse

struct ReuseRun {
    std::vector<VertexRequest> vertices;
    std::vector<ReusedPrimitive> primitives;
    Cycles cycles;
    VertexReuseStats stats;
};

ReuseRun reuse(const tests::IndexedMesh& mesh, const VertexReuseParams& params, tests::SinkOptions sink_options = {}) {
    const tests::GeometryScene scene = tests::make_scene(mesh);
    const GeometryPass pass = pass_of(scene);
    std::vector<IndexedPrimitive> list;
    for (std::uint32_t i = 0; 3 * i < mesh.indices.size(); ++i)
        list.push_back({i, 0, {mesh.indices[3 * i], mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]}});
    Rig rig;
    VertexReuse stage(rig.context("reuse"), params, pass);
    Source<IndexedPrimitive> source(rig.context("source"), list);
    Sink<VertexRequest> vertex_sink(rig.context("vertices"), sink_options);
    Sink<ReusedPrimitive> primitive_sink(rig.context("primitives"));
    sim::connect(source.out, stage.primitives_in, {});
    sim::connect(stage.vertices_out, vertex_sink.in, {.width = params.vertices_per_clk});
    sim::connect(stage.primitives_out, primitive_sink.in, {});
    rig.simulation.run();
    return {vertex_sink.values(), primitive_sink.values(), primitive_sink.cycles(), stage.stats()};
}

TEST(VertexReuseStage, PrimitiveFollowsItsLastVertex) {
    // Three misses at two vertices per cycle: received at 1, the third vertex and the primitive leave at 2.
    EXPECT_EQ(reuse(tests::grid_mesh(1, 1), {.vertices_per_clk = 2}).cycles, (Cycles{3, 4}));
    EXPECT_EQ(reuse(tests::grid_mesh(1, 1), {.vertices_per_clk = 3}).cycles, (Cycles{2, 3}));
}

TEST(VertexReuseStage, ThroughputIsOnePrimitiveOrTheVertexWidth) {
    const ReuseRun held = reuse(tests::grid_mesh(4, 100), {.vertices_per_clk = 2});
    EXPECT_LE(held.cycles.back() - held.cycles.front(), 800U + 2);
    tests::IndexedMesh separate{"separate triangles", 900, {}};
    for (std::uint32_t i = 0; i < 900; ++i) separate.indices.push_back(i);
    const ReuseRun cold = reuse(separate, {.vertices_per_clk = 1});
    EXPECT_EQ(cold.cycles.back() - cold.cycles.front(), 3U * 299);
}

TEST(VertexReuseStage, EqualsItsModelAndCountsEveryCorner) {
    for (const ReuseModel kind : {ReuseModel::fifo, ReuseModel::batch, ReuseModel::mesa}) {
        const tests::IndexedMesh mesh = tests::random_mesh(500, 60, 7);
        const VertexReuseParams params{.model = kind, .entries = 16, .warp_vertices = 32, .group_triangles = 20};
        const ReuseRun run = reuse(mesh, params, {.every = 3});
        VertexReuseModel model(params);
        model.begin_draw(mesh.vertex_count, true);
        ASSERT_EQ(run.primitives.size(), 500U);
        for (std::size_t i = 0; i < 500; ++i) {
            const auto result = model.triangle({mesh.indices[3 * i], mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]});
            EXPECT_EQ(run.primitives[i].sequences, result.sequences);
        }
        ASSERT_EQ(run.vertices.size(), model.runs());
        for (std::uint32_t i = 0; i < run.vertices.size(); ++i) EXPECT_EQ(run.vertices[i].sequence, i + 1);
        EXPECT_EQ(run.stats.misses.value, model.runs());
        EXPECT_EQ(run.stats.hits + run.stats.misses, 3U * 500);
    }
}

// ---- vertex shader

struct ShaderRun {
    Cycles cycles;
    VertexShaderStats stats;
};

/// @param instructions of each vertex; 0: of none that counts them
ShaderRun shade(std::uint32_t count, const VertexShaderParams& params, tests::SinkOptions sink_options = {},
                std::uint32_t instructions = 0) {
    Rig rig;
    VertexShader shader(rig.context("shader"), params);
    std::vector<VertexTask> tasks = vertices(count);
    for (VertexTask& task : tasks) task.instructions = instructions;
    Source<VertexTask> source(rig.context("source"), tasks);
    Sink<VertexTask> sink(rig.context("sink"), std::move(sink_options));
    sim::connect(source.out, shader.vertices_in, {.width = params.vertices_per_clk()});
    sim::connect(shader.vertices_out, sink.in, {.width = params.vertices_per_clk()});
    rig.simulation.run();
    for (std::uint32_t i = 0; i < sink.size(); ++i) EXPECT_EQ(sink.arrivals()[i].value.sequence, i + 1);
    return {sink.cycles(), shader.stats()};
}

TEST(VertexShaderStage, VertexIsDoneAtItsTimeAndNotBefore) {
    for (const std::uint32_t time : {1U, 4U, 100U})
        EXPECT_EQ(shade(1, {.units = 8, .cycles_per_vertex = time}).cycles, Cycles{1 + time + 1});
}

TEST(VertexShaderStage, ThroughputIsUnitsOverTime) {
    struct Case {
        std::uint32_t units, time;
        Cycle cycles; ///< from the first to the last of 1200 vertices
    };
    for (const Case& test :
         {Case{8, 4, 1200 / 2 - 1}, Case{1, 4, 1199 * 4}, Case{4, 4, 1199}, Case{6, 1, 1200 / 6 - 1}}) {
        const ShaderRun run = shade(1200, {.units = test.units, .cycles_per_vertex = test.time});
        EXPECT_EQ(run.cycles.back() - run.cycles.front(), test.cycles) << test.units << " units";
        EXPECT_EQ(run.stats.unit_cycles.value, 1200U * test.time);
    }
}

TEST(VertexShaderStage, ProgramsTakeAQuarterOfAVertexForEachInstruction) {
    for (const std::uint32_t instructions : {1U, 3U, 4U, 5U, 40U, 400U})
        for (const std::uint32_t time : {4U, 8U})
            EXPECT_EQ(shade(1, {.units = 8, .cycles_per_vertex = time}, {}, instructions).cycles,
                      Cycles{1 + instructions * time / 4 + 1});
    // What is left of a cycle counts as one.
    EXPECT_EQ(shade(1, {.units = 8, .cycles_per_vertex = 1}, {}, 5).cycles, Cycles{1 + 2 + 1});
    for (const std::uint32_t instructions : {10U, 20U}) {
        const ShaderRun run = shade(1200, {.units = 1, .cycles_per_vertex = 4}, {}, instructions);
        EXPECT_EQ(run.cycles.back() - run.cycles.front(), 1199U * instructions);
        EXPECT_EQ(run.stats.unit_cycles.value, 1200U * instructions);
    }
}

TEST(VertexShaderStage, BlockedOutputHoldsTheUnits) {
    const ShaderRun run = shade(100, {.units = 2, .cycles_per_vertex = 2}, {.every = 10});
    ASSERT_EQ(run.cycles.size(), 100U);
    EXPECT_EQ(run.stats.vertices.value, 100U);
}

// ---- primitive assembly

Cycles assemble(const std::vector<ReusedPrimitive>& list, std::uint32_t vertex_count, Cycle gap,
                tests::SinkOptions sink_options = {}) {
    Rig rig;
    PrimitiveAssembly assembly(rig.context("assembly"), {});
    Source<ReusedPrimitive> primitives(rig.context("primitives"), list);
    Source<VertexTask> shaded(rig.context("shaded"), vertices(vertex_count), {.gap = gap});
    Sink<AssembledPrimitive> sink(rig.context("sink"), std::move(sink_options));
    sim::connect(primitives.out, assembly.primitives_in, {.capacity = 64});
    sim::connect(shaded.out, assembly.vertices_in, {});
    sim::connect(assembly.primitives_out, sink.in, {});
    rig.simulation.run();
    for (std::uint32_t i = 0; i < sink.size(); ++i) EXPECT_EQ(sink.arrivals()[i].value.primitive, i);
    EXPECT_EQ(assembly.stats().vertices.value, vertex_count);
    return sink.cycles();
}

std::vector<ReusedPrimitive> strip_primitives(std::uint32_t count) {
    std::vector<ReusedPrimitive> list;
    for (std::uint32_t i = 0; i < count; ++i) list.push_back({i, 0, {i + 1, i + 2, i + 3}});
    return list;
}

TEST(PrimitiveAssembly, WaitsForTheLastOfThreeVertices) {
    // Vertex i leaves its source at 10 * i and arrives a cycle later.
    EXPECT_EQ(assemble(strip_primitives(3), 5, 10), (Cycles{22, 32, 42}));
}

TEST(PrimitiveAssembly, OnePrimitivePerCycleWhenVerticesAreHere) {
    std::vector<ReusedPrimitive> list;
    for (std::uint32_t i = 0; i < 50; ++i) list.push_back({i, 0, {1, 2, 3}});
    const Cycles cycles = assemble(list, 3, 0);
    EXPECT_EQ(cycles.back() - cycles.front(), 49U);
}

TEST(PrimitiveAssembly, TakesVerticesWhileItsOutputIsBlocked) {
    EXPECT_EQ(assemble(strip_primitives(40), 42, 0, {.start = 1000}).size(), 40U);
}

// ---- clip and cull

struct ClipRun {
    std::vector<std::uint32_t> triangles;
    Cycles cycles;
    ClipCullStats stats;
    std::vector<ClipCullStats> by_draw;
};

ClipRun clip(const tests::GeometryScene& scene, const ClipCullParams& params, tests::SinkOptions sink_options = {}) {
    const GeometryPass pass = pass_of(scene);
    std::vector<AssembledPrimitive> list;
    for (std::uint32_t range = 0; range < scene.stream.draws.size(); ++range)
        for (std::uint32_t i = 0; i < scene.stream.draws[range].primitives; ++i)
            list.push_back({scene.stream.draws[range].first_primitive + i, range});
    Rig rig;
    ClipCull stage(rig.context("clip"), params, pass);
    Source<AssembledPrimitive> source(rig.context("source"), list);
    Sink<TriangleTask> sink(rig.context("sink"), std::move(sink_options));
    sim::connect(source.out, stage.primitives_in, {.capacity = 64});
    sim::connect(stage.triangles_out, sink.in, {});
    rig.simulation.run();
    ClipRun run{{}, sink.cycles(), stage.stats(), stage.draw_stats()};
    for (const TriangleTask& task : sink.values()) run.triangles.push_back(task.triangle);
    return run;
}

TEST(ClipCull, OnePrimitivePerCycle) {
    const ClipRun run = clip(tests::make_scene(tests::grid_mesh(5, 10)), {});
    EXPECT_EQ(run.cycles.front(), 2U);
    EXPECT_EQ(run.cycles.back() - run.cycles.front(), 99U);
}

TEST(ClipCull, CulledPrimitivesEndHereAndTakeTheirCycle) {
    tests::GeometryScene scene = tests::make_scene(tests::grid_mesh(5, 1));
    for (const std::uint32_t i : {0U, 1U, 5U}) tests::set_fate(scene, i, PrimitiveFate::culled_facing, 0, false);
    tests::set_fate(scene, 2, PrimitiveFate::culled_outside, 0, false);
    tests::set_fate(scene, 9, PrimitiveFate::culled_degenerate, 0, false);
    tests::rebuild(scene);
    const ClipRun run = clip(scene, {});
    EXPECT_EQ(run.cycles, (Cycles{5, 6, 8, 9, 10}));
    EXPECT_EQ(run.triangles, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(run.stats.drawn + run.stats.culled(), run.stats.primitives.value);
    EXPECT_EQ(run.stats.culled_facing.value, 3U);
    EXPECT_EQ(run.stats.culled_outside.value, 1U);
    EXPECT_EQ(run.stats.culled_degenerate.value, 1U);
}

TEST(ClipCull, ClippedPrimitivePaysForEachPart) {
    tests::GeometryScene scene = tests::make_scene(tests::grid_mesh(1, 1));
    tests::set_fate(scene, 0, PrimitiveFate::drawn, 3, true);
    tests::rebuild(scene);
    const ClipRun run = clip(scene, {.clip_cycles = 4});
    EXPECT_EQ(run.cycles, (Cycles{6, 11, 16, 17})); // each part a cycle and four extra
    EXPECT_EQ(run.triangles, (std::vector<std::uint32_t>{0, 1, 2, 3}));
    EXPECT_EQ(run.stats.clipped.value, 1U);
    EXPECT_EQ(run.stats.triangles.value, 4U);
    EXPECT_EQ(clip(scene, {.clip_cycles = 0}).cycles, (Cycles{2, 3, 4, 5}));
}

TEST(ClipCull, CountsByDraw) {
    tests::GeometryScene scene = tests::make_scene({one_triangle(3), one_triangle(2)});
    tests::set_fate(scene, 1, PrimitiveFate::culled_outside, 0, false);
    tests::rebuild(scene);
    const ClipRun run = clip(scene, {}, {.every = 7});
    ASSERT_EQ(run.by_draw.size(), 2U);
    EXPECT_EQ(run.by_draw[0].primitives.value, 3U);
    EXPECT_EQ(run.by_draw[0].culled_outside.value, 1U);
    EXPECT_EQ(run.by_draw[1].triangles.value, 2U);
    EXPECT_EQ(run.triangles.size(), 4U);
}

// ---- triangle setup

Cycles set_up(std::uint32_t count, std::uint32_t time, tests::SinkOptions sink_options = {}) {
    Rig rig;
    TriangleSetup setup(rig.context("setup"), {.cycles_per_triangle = time});
    std::vector<TriangleTask> list(count);
    for (std::uint32_t i = 0; i < count; ++i) list[i].triangle = i;
    Source<TriangleTask> source(rig.context("source"), list);
    Sink<TriangleTask> sink(rig.context("sink"), std::move(sink_options));
    sim::connect(source.out, setup.triangles_in, {});
    sim::connect(setup.triangles_out, sink.in, {});
    rig.simulation.run();
    for (std::uint32_t i = 0; i < sink.size(); ++i) EXPECT_EQ(sink.arrivals()[i].value.triangle, i);
    EXPECT_EQ(setup.stats().triangles.value, count);
    return sink.cycles();
}

TEST(TriangleSetup, OneTrianglePerSetupTime) {
    for (const std::uint32_t time : {1U, 2U, 4U}) {
        const Cycles cycles = set_up(100, time);
        EXPECT_EQ(cycles.front(), 1 + time + 1);
        EXPECT_EQ(cycles.back() - cycles.front(), 99U * time);
    }
}

TEST(TriangleSetup, BlockedOutputLosesNothing) { EXPECT_EQ(set_up(30, 2, {.every = 9}).size(), 30U); }

} // namespace geometry_stages_test
