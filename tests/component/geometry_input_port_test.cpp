// The input port and what computer and driver make of a draw: costs as numbers, and as time of the vertex path.
// Source: specification 004, sections 4.1, 4.6, 5.
#include "pipeline/geometry/input_port.hpp"
#include "pipeline/vertex_path.hpp"
#include "tests/support/geometry_scene.hpp"

#include <gtest/gtest.h>

namespace geometry_input_port_test {

using pipeline::DrawTerms;
using pipeline::GpuParams;
using pipeline::HostParams;
using pipeline::InputCostParts;
using pipeline::RangeCliff;
using pipeline::Slot;
using pipeline::Submission;

/// A frame of one pass that draws the mesh.
tests::GeometryScene drawn(const tests::IndexedMesh& mesh) {
    tests::GeometryScene scene = tests::make_scene(mesh);
    pipeline::Pass pass;
    pass.name = "geometry";
    for (std::uint32_t i = 0; i < scene.frame.draws.size(); ++i) pass.draws.push_back(i);
    scene.frame.passes = {pass};
    return scene;
}

tests::GeometryScene grass(std::uint32_t blades) { return drawn(tests::grass_mesh(blades)); }

/// Only the port limits: everything else has room to spare.
GpuParams wide_gpu() {
    GpuParams gpu;
    gpu.geometry.vertex_shader.units = 64;
    gpu.geometry.triangle_setup.cycles_per_triangle = 1;
    gpu.geometry.index_fetch.bytes_per_clk = 1000;
    return gpu;
}

double cycles(const GpuParams& gpu, const pipeline::Frame& frame) {
    return static_cast<double>(pipeline::run_vertex_path(gpu, frame).cycles);
}

TEST(InputPort, AttributesApartCostTheirSlotAndTheirStream) {
    pipeline::InputPortParams port;
    port.vertex_cycles = 2;
    port.stream_cycles = 0.5;
    port.colour_bytes_per_clk = 8;
    port.attribute_bytes_per_clk = 4;
    port.interleaved_bytes_per_clk = 16;
    port.line_bytes_per_clk = 64;
    const pipeline::InputLayout layout{
        {{Slot::normal, 12, false}, {Slot::colour, 4, false}, {Slot::texcoord, 8, true}}};
    const InputCostParts parts = pipeline::input_cost_parts(port, {}, {}, layout, 32, 500);
    EXPECT_DOUBLE_EQ(parts.base, 2);
    EXPECT_DOUBLE_EQ(parts.attributes, (0.5 + 12 / 4.0) + (0.5 + 4 / 8.0) + 8 / 16.0);
    EXPECT_DOUBLE_EQ(parts.line, 0.5);
    EXPECT_DOUBLE_EQ(parts.bus_line, 0);
}

TEST(InputPort, BytesOutsideVideoMemoryCrossTheBus) {
    HostParams host;
    host.bus_gbps = 4;
    host.outside_gbps = 2; // the smaller one counts
    DrawTerms terms;
    terms.host_share = 0.25;
    terms.copied_bytes = 1e6;
    const InputCostParts parts = pipeline::input_cost_parts({}, host, terms, {}, 32, 500);
    EXPECT_DOUBLE_EQ(parts.bus_line, 0.25 * 32 / 2e9 * 500e6);
    EXPECT_DOUBLE_EQ(parts.bus_index_byte, 0.25 / 2e9 * 500e6);
    EXPECT_DOUBLE_EQ(parts.bus_draw, 1e6 / 2e9 * 500e6);
    EXPECT_DOUBLE_EQ(parts.draw, 0); // a copy is no property of draws
}

TEST(InputPort, PortBoundFrameTakesPortTimePerVertex) {
    const tests::GeometryScene scene = grass(2000);
    GpuParams gpu = wide_gpu();
    const double free = cycles(gpu, scene.frame);
    gpu.geometry.vertex_fetch.port.vertex_cycles = 3.25;
    const double bound = cycles(gpu, scene.frame);
    EXPECT_NEAR(bound / (2000 * 7 * 3.25), 1.0, 0.02);
    EXPECT_LT(free, bound / 2);
    gpu.geometry.vertex_fetch.port.index_bytes_per_clk = 10; // indices come in turn: 60 bytes a blade
    EXPECT_NEAR(cycles(gpu, scene.frame) - bound, 2000 * 60 / 10.0, 2000);
    gpu.geometry.vertex_fetch.port.draw_cycles = 5000;
    EXPECT_NEAR(cycles(gpu, scene.frame) - bound, 2000 * 60 / 10.0 + 5000, 2000);
}

TEST(InputPort, IndicesWithoutMissesPassThePortToo) {
    tests::IndexedMesh mesh{"one vertex", 1, std::vector<std::uint32_t>(3 * 4000, 0)};
    const tests::GeometryScene scene = drawn(mesh);
    GpuParams gpu = wide_gpu();
    gpu.geometry.vertex_fetch.port.index_bytes_per_clk = 2;
    EXPECT_NEAR(cycles(gpu, scene.frame) / (4000 * 12 / 2.0), 1.0, 0.05);
}

TEST(Host, RangeLimitIsMetAtTheLimitAndExceededByOneMore) {
    HostParams host;
    host.range_cliff = RangeCliff::index_range;
    host.overflow_slowdown = 4;
    host.range_limit_vertices = 7 * 100;
    for (const std::uint32_t blades : {100U, 101U}) {
        const auto terms = pipeline::draw_terms(host, grass(blades).frame);
        EXPECT_EQ(terms[0].span, 7 * blades);
        EXPECT_EQ(terms[0].over_limit, blades == 101);
        EXPECT_DOUBLE_EQ(terms[0].slowdown, blades == 101 ? 4 : 1);
    }
}

TEST(Host, CacheCapacityCountsBytesAndHostMemoryMovesThem) {
    HostParams host;
    host.overflow_slowdown = 4;
    host.range_limit_mb = 7 * 100 * 12 / 1e6;
    for (const RangeCliff cliff : {RangeCliff::cache_capacity, RangeCliff::host_memory}) {
        host.range_cliff = cliff;
        EXPECT_FALSE(pipeline::draw_terms(host, grass(100).frame)[0].over_limit);
        const DrawTerms over = pipeline::draw_terms(host, grass(101).frame)[0];
        EXPECT_TRUE(over.over_limit);
        EXPECT_DOUBLE_EQ(over.slowdown, cliff == RangeCliff::cache_capacity ? 4 : 1);
        EXPECT_DOUBLE_EQ(over.host_share, cliff == RangeCliff::host_memory ? 1 : 0);
    }
}

TEST(Host, SpanSlowdownGrowsWithTheLogarithmAndSaturates) {
    HostParams host;
    host.span_slowdown = 0.5;
    host.span_saturation = 70;
    host.range_limit_vertices = 7000;
    const auto slowdown = [&host](std::uint32_t blades) {
        return pipeline::draw_terms(host, grass(blades).frame)[0].slowdown;
    };
    EXPECT_DOUBLE_EQ(slowdown(10), 1.0);
    EXPECT_NEAR(slowdown(100), 1.25, 1e-9); // half of the way on the logarithm
    EXPECT_NEAR(slowdown(1000), 1.5, 1e-9);
    EXPECT_NEAR(slowdown(2000), 1.5, 1e-9);
}

TEST(Host, ConversionDelaysTheDraw) {
    const tests::GeometryScene scene = grass(1000);
    GpuParams gpu = wide_gpu();
    const double native = cycles(gpu, scene.frame);
    gpu.host.convert.position.f32_ns = 100;                                                    // 7000 vertices: 700 us
    EXPECT_NEAR((cycles(gpu, scene.frame) - native) / (700 * gpu.clock.core_mhz), 1.0, 0.001); // periods are whole ps
    gpu.host.frame_us = 50;
    EXPECT_NEAR((cycles(gpu, scene.frame) - native) / (750 * gpu.clock.core_mhz), 1.0, 0.001);
}

TEST(Host, VerticesOfTheApplicationComeAtTheirRate) {
    tests::GeometryScene scene = grass(20000);
    scene.frame.submission = Submission::client_arrays;
    GpuParams gpu = wide_gpu();
    gpu.host.client_gbps = 0.5;
    const double bytes = 20000.0 * (7 * 12 + 15 * 4);
    EXPECT_NEAR(cycles(gpu, scene.frame) / (bytes / 0.5e9 * gpu.clock.core_mhz * 1e6), 1.0, 0.01);
    gpu.host.client_gbps = 100; // then the bus is the limit
    EXPECT_NEAR(cycles(gpu, scene.frame) / (bytes / 4e9 * gpu.clock.core_mhz * 1e6), 1.0, 0.05);
    scene.frame.submission = Submission::immediate;
    gpu.host.immediate_ns = 50;
    EXPECT_NEAR(cycles(gpu, scene.frame) / (20000 * 15 * 50e-9 * gpu.clock.core_mhz * 1e6), 1.0, 0.01);
    scene.frame.submission = Submission::display_list;
    gpu.host.list_ns = 20;
    EXPECT_NEAR(cycles(gpu, scene.frame) / (20000 * 15 * 20e-9 * gpu.clock.core_mhz * 1e6), 1.0, 0.01);
}

TEST(Host, BuffersThatFitTogetherAreNotCopied) {
    const tests::GeometryScene scene = grass(10000); // 0.84 MB of vertices, 0.6 MB of indices
    HostParams host;
    for (const double room : {0.0, 1.44, 100.0}) { // 0: enough
        host.vram_mb = room;
        EXPECT_DOUBLE_EQ(pipeline::draw_terms(host, scene.frame)[0].copied_bytes, 0) << room;
    }
    host.vram_mb = 1.43;
    EXPECT_DOUBLE_EQ(pipeline::draw_terms(host, scene.frame)[0].copied_bytes, 1.44e6);
    EXPECT_DOUBLE_EQ(pipeline::draw_terms(host, scene.frame)[0].host_share, 0);
}

TEST(Host, ABufferIsCopiedOncePerPassBeforeTheFirstDrawThatReadsIt) {
    tests::GeometryScene scene = grass(10000);
    scene.frame.draws.push_back(scene.frame.draws[0]);
    scene.frame.draws.push_back(scene.frame.draws[0]);
    scene.frame.passes[0].draws = {1, 0};
    scene.frame.passes.push_back(scene.frame.passes[0]);
    scene.frame.passes[1].draws = {2};
    HostParams host;
    host.vram_mb = 1;
    const std::vector<DrawTerms> terms = pipeline::draw_terms(host, scene.frame);
    EXPECT_DOUBLE_EQ(terms[0].copied_bytes, 0);
    EXPECT_DOUBLE_EQ(terms[1].copied_bytes, 1.44e6);
    EXPECT_DOUBLE_EQ(terms[2].copied_bytes, 1.44e6);
    scene.frame.submission = Submission::client_arrays; // nothing is kept
    EXPECT_DOUBLE_EQ(pipeline::draw_terms(host, scene.frame)[1].copied_bytes, 0);
}

TEST(Host, CopiesTakeTheTimeOfTheBusBesideThatOfTheDraws) {
    const tests::GeometryScene scene = grass(10000);
    GpuParams gpu = wide_gpu();
    gpu.geometry.vertex_fetch.port.vertex_cycles = 2;
    const double fitting = cycles(gpu, scene.frame);
    gpu.host.vram_mb = 1;
    const double copied = cycles(gpu, scene.frame);
    EXPECT_NEAR((copied - fitting) / (1.44e6 / 4e9 * gpu.clock.core_mhz * 1e6), 1.0, 0.01);
    EXPECT_NEAR(static_cast<double>(pipeline::estimate_vertex_path(gpu, scene.frame).cycles) / copied, 1.0, 0.02);
}

TEST(Host, InstancesOfADrawShareItsCopies) {
    tests::GeometryScene scene = grass(1000);
    scene.frame.draws[0].instances.resize(4, scene.frame.draws[0].instances[0]);
    GpuParams gpu = wide_gpu();
    gpu.geometry.vertex_fetch.port.vertex_cycles = 2;
    const double fitting = cycles(gpu, scene.frame);
    gpu.host.vram_mb = 0.1; // of 0.144
    gpu.host.outside_gbps = 0.5;
    EXPECT_NEAR((cycles(gpu, scene.frame) - fitting) / (0.144e6 / 0.5e9 * gpu.clock.core_mhz * 1e6), 1.0, 0.02);
}

TEST(VertexPath, SameInAllModesAndForEverySeedWithoutJitter) {
    const tests::GeometryScene scene = grass(300);
    GpuParams gpu = wide_gpu();
    gpu.geometry.vertex_fetch.port.vertex_cycles = 1.7;
    gpu.host.convert.position.f32_ns = 1;
    const auto run = [&](sim::Mode mode, std::uint64_t seed) {
        pipeline::VertexPathOptions options;
        options.mode = mode;
        options.seed = seed;
        return pipeline::run_vertex_path(gpu, scene.frame, options).cycles;
    };
    const std::uint64_t normal = run(sim::Mode::normal, 1);
    EXPECT_EQ(run(sim::Mode::shuffled, 1), normal);
    EXPECT_EQ(run(sim::Mode::never_sleep, 1), normal);
    gpu.memory.controller.jitter_cycles = 0;
    EXPECT_EQ(run(sim::Mode::normal, 2), run(sim::Mode::normal, 3));
}

TEST(VertexPath, EmptyFrameAndOneTriangle) {
    GpuParams gpu;
    gpu.geometry.vertex_fetch.port.vertex_cycles = 1;
    const tests::GeometryScene one = drawn(tests::IndexedMesh{"one", 3, {0, 1, 2}});
    const auto result = pipeline::run_vertex_path(gpu, one.frame);
    EXPECT_EQ(result.counts.primitives.value, 1U);
    EXPECT_EQ(result.counts.vertex_shader_runs.value, 3U);
    EXPECT_GT(result.cycles, 300U); // two reads of memory, one behind the other
    EXPECT_GT(pipeline::estimate_vertex_path(gpu, one.frame).cycles, 300U);
    EXPECT_EQ(pipeline::estimate_vertex_path(gpu, one.frame).counts.vertex_shader_runs.value, 3U);
}

TEST(VertexPath, EstimateOfASampleIsThatOfTheWhole) {
    const tests::GeometryScene scene = grass(40'000);
    pipeline::VertexPathOptions sampled;
    sampled.estimate_primitives = 40'000;
    const auto part = pipeline::estimate_vertex_path({}, scene.frame, sampled);
    const auto whole = pipeline::estimate_vertex_path({}, scene.frame);
    EXPECT_LT(part.share_sampled, 0.3);
    EXPECT_EQ(whole.share_sampled, 1.0);
    EXPECT_NEAR(static_cast<double>(part.cycles) / static_cast<double>(whole.cycles), 1.0, 0.01);
    EXPECT_EQ(whole.counts.vertex_shader_runs.value, 280'000U);
}

} // namespace geometry_input_port_test
