// Vertices and indices at the limits: through the functional front end, the timed machine and the reference.
#include "tests/support/functional_scene.hpp"
#include "tests/support/replay.hpp"
#include "traces/generators/screen.hpp"

#include <cstring>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <set>

namespace vertex_input_extremes_test {

using pipeline::Geometry;
using pipeline::IndexType;
using pipeline::RunResult;
using pipeline::Topology;
using support::counter;
using support::Replay;

/// Indices, in any of the widths, of one draw; ~0 restarts.
struct Indices {
    std::vector<std::uint32_t> values;
    IndexType type = IndexType::u32;
    Topology topology = Topology::triangles;
    bool restart = false;
};

std::vector<std::byte> bytes_of(const Indices& indices) {
    std::vector<std::byte> bytes;
    const std::uint32_t size = pipeline::bytes_of(indices.type);
    for (const std::uint32_t value : indices.values) {
        bytes.resize(bytes.size() + size);
        std::memcpy(bytes.data() + bytes.size() - size, &value, size); // the low bytes
    }
    return bytes;
}

/// A zigzag of 10 vertices over the viewport of 16x16, drawn once for each list of indices.
traces::Scene zigzag(const std::vector<Indices>& draws) {
    traces::Mesh mesh;
    mesh.name = "zigzag";
    for (int i = 0; i < 10; ++i) {
        mesh.positions.emplace_back(1.5F * static_cast<float>(i), i % 2 == 0 ? 1.0F : 14.0F,
                                    0.1F + 0.05F * static_cast<float>(i));
        mesh.colours.push_back(traces::colour_of(static_cast<std::uint64_t>(i)));
    }
    traces::Scene scene = traces::screen_scene(mesh);
    const Geometry vertices = scene.resources->geometries[0];
    scene.resources->geometries.clear();
    scene.draws.clear();
    for (const Indices& indices : draws) {
        const auto number = static_cast<std::uint32_t>(scene.draws.size());
        Geometry geometry = vertices;
        geometry.topology = indices.topology;
        geometry.index_type = indices.type;
        geometry.index_buffer = static_cast<std::uint32_t>(scene.resources->buffers.size());
        geometry.index_count = static_cast<std::uint32_t>(indices.values.size());
        geometry.primitive_restart = indices.restart;
        scene.resources->buffers.push_back({fmt::format("indices {}", number), bytes_of(indices), 0});
        scene.resources->geometries.push_back(geometry);
        scene.draws.push_back({fmt::format("draw {}", number), number, 0, {glm::mat4(1.0F)}});
    }
    scene.resources->find_runs();
    scene.name = "zigzag";
    traces::finish_scene(scene);
    return scene;
}

Replay replay_of(const std::vector<Indices>& draws) { return Replay(zigzag(draws), {16, 16, "geometry"}); }

/// Runs every design, which has no k-buffer to disagree about.
RunResult good_run(const Replay& replay) {
    for (const std::string& design : replay.designs()) EXPECT_EQ(replay.run(design).wrong_pixels, 0U) << design;
    return replay.run("existing");
}

/// Quads, depths and colours; not the numbers of primitives and draws.
void expect_same_fragments(const Replay& a, const Replay& b) {
    EXPECT_EQ(a.streams[0].fragments, b.streams[0].fragments);
    EXPECT_EQ(a.streams[0].depths, b.streams[0].depths);
    EXPECT_EQ(a.streams[0].colours, b.streams[0].colours);
    EXPECT_EQ(a.reference.depth, b.reference.depth);
    EXPECT_EQ(a.reference.colour, b.reference.colour);
}

const std::vector<std::uint32_t> strip_as_list{0, 1, 2, 1, 3, 2, 2, 3, 4, 6, 7, 8, 7, 9, 8};

TEST(VertexInputExtremes, OneTriangleWithIndicesOfEveryWidth) {
    const Replay wide = replay_of({{{0, 1, 2}}});
    EXPECT_GT(wide.streams[0].fragments, 0U);
    for (const IndexType type : {IndexType::u8, IndexType::u16, IndexType::u32}) {
        const Replay narrow = replay_of({{{0, 1, 2}, type}});
        expect_same_fragments(wide, narrow);
        const RunResult run = good_run(narrow);
        EXPECT_EQ(run.fragments, wide.streams[0].fragments);
        EXPECT_EQ(counter(run.stages, "vertex_shader/counters/vertices"), 3U);
        EXPECT_EQ(counter(run.stages, "index_fetch/counters/indices"), 3U);
    }
}

TEST(VertexInputExtremes, DegenerateTrianglesOnly) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 300; ++i) indices.insert(indices.end(), {i % 10, (i + 1) % 10, i % 10});
    const Replay replay = replay_of({{indices}});
    EXPECT_TRUE(replay.streams[0].quads.empty());
    const RunResult run = good_run(replay);
    EXPECT_EQ(run.fragments, 0U);
    EXPECT_EQ(counter(run.stages, "clip_cull/counters/primitives"), 300U);
    EXPECT_EQ(counter(run.stages, "clip_cull/counters/culled_degenerate"), 300U);
    EXPECT_EQ(counter(run.stages, "vertex_shader/counters/vertices"), 10U); // they are shaded all the same
}

TEST(VertexInputExtremes, EveryTriangleTheSameVertex) {
    const Replay replay = replay_of({{std::vector<std::uint32_t>(9000, 7)}});
    EXPECT_TRUE(replay.streams[0].quads.empty());
    const RunResult run = good_run(replay);
    EXPECT_EQ(counter(run.stages, "clip_cull/counters/culled_degenerate"), 3000U);
    EXPECT_EQ(counter(run.stages, "vertex_shader/counters/vertices"), 1U);
    EXPECT_EQ(counter(run.stages, "vertex_reuse/counters/hits"), 8999U);
}

TEST(VertexInputExtremes, StripsWithRestartDrawWhatAListDraws) {
    constexpr std::uint32_t end = ~0U;
    const Replay list = replay_of({{strip_as_list}});
    for (const IndexType type : {IndexType::u8, IndexType::u16, IndexType::u32}) {
        const Replay strips = replay_of(
            {{{end, 0, 1, 2, 3, 4, end, end, 5, 5, end, 6, 7, 8, 9, end}, type, Topology::triangle_strip, true}});
        expect_same_fragments(list, strips);
        const RunResult run = good_run(strips);
        EXPECT_EQ(run.fragments, list.streams[0].fragments);
        EXPECT_EQ(counter(run.stages, "index_fetch/counters/indices"), 16U);
        EXPECT_EQ(counter(run.stages, "vertex_reuse/counters/primitives"), 5U);
        EXPECT_EQ(counter(run.stages, "vertex_shader/counters/vertices"), 9U); // vertex 5 makes no triangle
    }
}

TEST(VertexInputExtremes, EmptyDrawsAmongFullOnesChangeNothing) {
    const Indices full{strip_as_list}, none{{}}, two{{3, 4}};
    const Indices restarts{std::vector<std::uint32_t>(100, ~0U), IndexType::u32, Topology::triangle_fan, true};
    const Replay alone = replay_of({full, full});
    const Replay among = replay_of({none, full, restarts, two, full, none});
    expect_same_fragments(alone, among);
    const RunResult run = good_run(among);
    EXPECT_EQ(run.fragments, alone.streams[0].fragments);
    EXPECT_EQ(counter(run.stages, "index_fetch/counters/primitives"), 10U);
    EXPECT_EQ(counter(run.stages, "index_fetch/counters/indices"), 2 * strip_as_list.size() + 100);
}

TEST(VertexInputExtremes, IndicesOf16BitsAtTheEndOfTheirRange) {
    for (const std::uint32_t vertices : {65535U, 65536U, 65537U})
        for (const bool restart : {false, true}) {
            pipeline::Resources resources;
            resources.buffers = {tests::buffer_of(std::vector<float>(3 * std::size_t{vertices})),
                                 tests::buffer_of(std::vector<std::uint16_t>{0, 1, 65535, 65534, 65533, 65532})};
            Geometry geometry;
            geometry.attributes = {{}};
            geometry.topology = Topology::triangle_strip;
            geometry.vertex_count = vertices;
            geometry.index_type = IndexType::u16;
            geometry.index_buffer = 1;
            geometry.index_count = 6;
            geometry.primitive_restart = restart;
            resources.geometries = {geometry};
            resources.find_runs();
            SCOPED_TRACE(fmt::format("{} vertices, restart {}", vertices, restart));
            if (vertices == 65535 && !restart) {
                EXPECT_THROW(resources.validate("limit"), sim::InputError);
                continue;
            }
            EXPECT_NO_THROW(resources.validate("limit"));
            EXPECT_EQ(resources.geometries[0].triangle_count(), restart ? 1U : 4U);
        }
}

TEST(VertexInputExtremes, UnalignedAttributesDrawWhatAlignedOnesDraw) {
    for (const std::string layout : {"interleaved", "separate"}) {
        const std::string spec = "gen:grass?blades=300&attributes=colour:3u8+normal:3f32+texcoord:1u8&layout=" + layout;
        const Replay aligned(spec, {64, 64, "opaque"}), unaligned(spec + "&align=1", {64, 64, "opaque"});
        const auto& attributes = unaligned.frame.resources->geometries[0].attributes;
        EXPECT_EQ(attributes[0].stride, layout == "separate" ? 12U : 28U);
        EXPECT_EQ(attributes[1].bytes(), 3U);
        expect_same_fragments(aligned, unaligned);
        EXPECT_EQ(good_run(unaligned).fragments, good_run(aligned).fragments);
    }
}

TEST(VertexInputExtremes, UnalignedAttributesFetchTheLinesOfTheirAddresses) {
    constexpr std::uint32_t line = 32;
    for (const char* align : {"1", "2", "4"}) {
        const Replay replay(std::string("gen:grass?blades=300&layout=interleaved&attributes=normal:3s8&align=") + align,
                            {64, 64, "geometry"});
        std::set<std::uint64_t> lines;
        const Geometry& geometry = replay.frame.resources->geometries[0];
        for (const pipeline::VertexAttribute& attribute : geometry.attributes)
            for (std::uint64_t i = 0; i < geometry.vertex_count; ++i) {
                const std::uint64_t first =
                    replay.frame.resources->buffers[attribute.buffer].address + attribute.offset + i * attribute.stride;
                for (std::uint64_t at = first; at < first + attribute.bytes(); ++at) lines.insert(at / line);
            }
        const RunResult run =
            replay.run("existing", {"geometry.vertex_fetch.cache.bytes=262144", "geometry.vertex_fetch.cache.line=32"});
        EXPECT_EQ(counter(run.stages, "vertex_fetch/counters/bytes"), line * lines.size()) << align;
    }
}

} // namespace vertex_input_extremes_test
