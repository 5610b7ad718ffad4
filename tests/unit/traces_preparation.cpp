// Preparations draw what they were given, keep their limits, and improve what they are for.
#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "tests/support/preparation_kit.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>
#include <rapidcheck/gtest.h>
#include <set>

namespace traces_preparation_test {

using namespace tests;
using pipeline::Semantic;
using pipeline::Topology;
using traces::MeshMeasure;
using traces::PreparedScene;
using traces::Scene;
using traces::VertexLayout;

const std::vector<std::string>& keeping_values() {
    static const std::vector<std::string> specs = {"batch?vertices=50",
                                                   "batch?triangles=7",
                                                   "batch?vertices=3",
                                                   "reorder",
                                                   "reorder?algorithm=cache",
                                                   "reorder?algorithm=strip&fetch=false",
                                                   "reorder?algorithm=pca&patch=40",
                                                   "reorder?algorithm=pca&patch=3",
                                                   "interleave",
                                                   "interleave?layout=separate&align=1",
                                                   "recommended?vertices=60",
                                                   "weld",
                                                   "shuffle?seed=4",
                                                   "strips",
                                                   "strips?reorder=false",
                                                   "strips?stitch=restart"};
    return specs;
}

Scene one_triangle() {
    traces::Mesh mesh;
    mesh.name = "triangle";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    return scene_of({mesh});
}

/// The last triangle of a mesh whose other ones are degenerate.
Scene mostly_degenerate() {
    traces::Mesh mesh = one_triangle().draws.empty() ? traces::Mesh{} : hill_mesh(1, 1, 3);
    mesh.indices = {0, 0, 0, 1, 1, 2, 3, 0, 3, 0, 1, 2};
    return scene_of({mesh});
}

/// Two indices of three make no triangle, beside a mesh that draws something.
Scene with_an_empty_draw() {
    Scene scene = scene_of({hill_mesh(2, 2, 5), hill_mesh(2, 2, 6)});
    scene.resources->geometries[1].index_count = 2;
    traces::finish_scene(scene);
    return scene;
}

std::vector<Scene> meshes_to_keep() {
    Scene shared = scene_of({hill_mesh(6, 5, 2), soup_mesh(40, 20, 5)});
    shared.draws.push_back(shared.draws.front());
    shared.draws.back().instances = {glm::mat4(2.0F), glm::mat4(1.0F)};
    traces::finish_scene(shared);
    std::vector<Scene> scenes{scene_of({hill_mesh(30, 20, 1)}, VertexLayout::interleaved),
                              scene_of({soup_mesh(300, 90, 2)}),
                              scene_of({degenerate_mesh(3)}, VertexLayout::interleaved),
                              one_triangle(),
                              mostly_degenerate(),
                              with_an_empty_draw(),
                              shared};
    return scenes;
}

std::uint64_t named_vertices(const Scene& scene, std::uint32_t geometry) {
    const pipeline::Geometry& one = scene.resources->geometries.at(geometry);
    const pipeline::IndexReader read(*scene.resources, one);
    std::set<std::uint32_t> vertices;
    for (std::uint32_t i = 0; i < one.index_count; ++i) vertices.insert(read(i));
    return vertices.size();
}

TEST(Preparation, G11_EveryOneKeepsTheTrianglesItWasGiven) {
    for (const Scene& scene : meshes_to_keep())
        for (const std::string& spec : keeping_values()) {
            SCOPED_TRACE(scene.resources->geometries[0].name + " " + spec);
            const bool lists = !spec.starts_with("strips");
            EXPECT_EQ(triangle_values(scene, lists), triangle_values(prepared(scene, spec).scene, lists));
        }
}

RC_GTEST_PROP(Preparation, G11_AnySoupKeepsItsTriangles, ()) {
    const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1'000'000);
    const auto vertices = *rc::gen::inRange<std::uint32_t>(3, 60);
    const auto triangles = *rc::gen::inRange<std::uint32_t>(1, 200);
    const std::string spec = *rc::gen::elementOf(keeping_values());
    const Scene scene = scene_of({soup_mesh(triangles, vertices, seed)});
    RC_ASSERT(triangle_values(scene, false) ==
              triangle_values(prepared(scene, spec).scene, false)); // has no degenerate
}

TEST(Preparation, G11_OfStripsAndFansAreMadeLists) {
    Scene scene = scene_of({hill_mesh(4, 3, 1), hill_mesh(3, 3, 2)});
    scene.resources->geometries[0].topology = Topology::triangle_strip;
    scene.resources->geometries[1].topology = Topology::triangle_fan;
    traces::finish_scene(scene);
    for (const std::string& spec : keeping_values()) {
        SCOPED_TRACE(spec);
        const PreparedScene result = prepared(scene, spec);
        EXPECT_EQ(triangle_values(scene, false), triangle_values(result.scene, false));
        const bool keeps = spec.starts_with("interleave");
        const Topology made = spec.starts_with("strips") ? Topology::triangle_strip : Topology::triangles;
        EXPECT_EQ(result.scene.resources->geometries[0].topology, keeps ? Topology::triangle_strip : made);
        EXPECT_EQ(result.scene.resources->geometries[1].topology, keeps ? Topology::triangle_fan : made);
    }
}

TEST(Preparation, G11_BatchesKeepTheirBudgetAndTheOrderOfTriangles) {
    const Scene scene = scene_of({hill_mesh(60, 50, 1)});
    const auto order = [](const Scene& of) {
        std::vector<std::vector<float>> positions;
        for (const pipeline::Draw& draw : of.draws) {
            const pipeline::Geometry& geometry = of.resources->geometries[draw.geometry];
            const pipeline::AttributeReader read(*of.resources, *geometry.find(Semantic::position));
            const pipeline::IndexReader index(*of.resources, geometry);
            for (std::uint32_t i = 0; i < geometry.index_count; ++i) {
                const glm::vec4 p = read(index(i));
                positions.push_back({p.x, p.y, p.z});
            }
        }
        return positions;
    };
    for (const std::uint32_t budget : {3U, 4U, 100U, 3000U, 65536U}) {
        const Scene batched = prepared(scene, fmt::format("batch?vertices={}", budget)).scene;
        for (std::uint32_t i = 0; i < batched.resources->geometries.size(); ++i) {
            const pipeline::Geometry& geometry = batched.resources->geometries[i];
            EXPECT_LE(geometry.vertex_count, budget);
            EXPECT_EQ(geometry.vertex_count, named_vertices(batched, i));
            EXPECT_EQ(geometry.index_type, pipeline::IndexType::u16);
        }
        EXPECT_EQ(order(batched), order(scene));
    }
    const Scene thirds = prepared(scene, "batch?triangles=2000").scene;
    ASSERT_EQ(thirds.draws.size(), 3U); // 6000 triangles
    for (const pipeline::Geometry& geometry : thirds.resources->geometries) EXPECT_EQ(geometry.triangle_count(), 2000U);
}

TEST(Preparation, G11_SixteenBitsReach65536VerticesAndNoMore) {
    traces::Mesh mesh;
    mesh.name = "row";
    for (std::uint32_t i = 0; i < 65'538; ++i) mesh.positions.emplace_back(i, i % 7, 0);
    for (std::uint32_t i = 0; i + 2 < mesh.positions.size(); ++i)
        mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 2});
    const Scene scene = scene_of({mesh});
    EXPECT_EQ(scene.resources->geometries[0].index_type, pipeline::IndexType::u32);
    const Scene batched = prepared(scene, "batch").scene;
    ASSERT_EQ(batched.draws.size(), 2U);
    EXPECT_EQ(batched.resources->geometries[0].vertex_count, 65'536U);
    EXPECT_EQ(batched.resources->geometries[0].index_type, pipeline::IndexType::u16);
    EXPECT_EQ(triangle_values(batched, true), triangle_values(scene, true));
    const Scene whole = prepared(scene, "batch?vertices=65538").scene;
    ASSERT_EQ(whole.draws.size(), 1U);
    EXPECT_EQ(whole.resources->geometries[0].index_type, pipeline::IndexType::u32);
}

TEST(Preparation, G11_ReorderingLowersTheMissesOfAShuffledMesh) {
    const PreparedScene shuffled = prepared(scene_of({hill_mesh(120, 90, 1)}, VertexLayout::interleaved), "shuffle");
    EXPECT_GT(shuffled.steps[0].after.acmr, 2.8);
    for (const char* algorithm : {"fifo", "cache", "strip", "pca"}) {
        SCOPED_TRACE(algorithm);
        const PreparedScene result = prepared(shuffled.scene, fmt::format("reorder?algorithm={}&patch=400", algorithm));
        const MeshMeasure &before = result.steps[0].before, &after = result.steps[0].after;
        EXPECT_LT(after.acmr, before.acmr);
        EXPECT_LT(after.acmr, 1.05);
        EXPECT_GE(after.acmr, 0.5);
        EXPECT_GE(after.atvr, 1.0);
        EXPECT_LT(after.overfetch, before.overfetch / 3.0);
        EXPECT_GE(after.overfetch, 1.0);
        EXPECT_EQ(after.vertices, before.vertices);
        EXPECT_EQ(after.triangles, before.triangles);
        EXPECT_EQ(after.vertex_bytes, before.vertex_bytes);
    }
}

TEST(Preparation, ReorderedVerticesStandInTheOrderOfTheirFirstUse) {
    const PreparedScene shuffled = prepared(scene_of({hill_mesh(40, 30, 1)}), "shuffle");
    const Scene scene = prepared(shuffled.scene, "reorder?algorithm=cache").scene;
    const pipeline::IndexReader read(*scene.resources, scene.resources->geometries[0]);
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < scene.resources->geometries[0].index_count; ++i) {
        ASSERT_LE(read(i), next);
        if (read(i) == next) ++next;
    }
}

TEST(Preparation, StripsTakeFewerIndicesThanLists) {
    const PreparedScene result = prepared_in_turn(scene_of({hill_mesh(60, 40, 1)}), {"shuffle", "strips"});
    const MeshMeasure &list = result.steps[1].before, &strip = result.steps[1].after;
    EXPECT_LT(strip.index_bytes, list.index_bytes * 6 / 10);
    EXPECT_EQ(strip.triangles, list.triangles);
    EXPECT_GT(strip.degenerate, 0U);
    EXPECT_EQ(result.scene.draws.size(), 1U);
}

TEST(Preparation, FormatsAndLayoutsChangeWithoutUndoingStrips) {
    const Scene list = scene_of({hill_mesh(12, 9, 1), soup_mesh(50, 20, 2)});
    for (const std::string stitch : {"strips", "strips?stitch=restart"}) {
        SCOPED_TRACE(stitch);
        const Scene strips = prepared(list, stitch).scene;
        const Scene after =
            prepared_in_turn(strips, {"interleave", "quantise?box=cube", "interleave?layout=separate"}).scene;
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(after.resources->geometries[i].topology, Topology::triangle_strip);
            EXPECT_EQ(after.resources->geometries[i].index_count, strips.resources->geometries[i].index_count);
            EXPECT_EQ(after.resources->geometries[i].primitive_restart, stitch != "strips");
        }
        EXPECT_EQ(triangle_values(prepared(strips, "interleave").scene, false), triangle_values(list, false));
        EXPECT_EQ(triangle_values(after, false).size(), triangle_values(list, false).size());
    }
}

TEST(Preparation, GeneratedScenesKeepTheirTriangles) {
    for (const char* generated :
         {"gen:stack?n=5", "gen:grass?blades=60", "gen:blob?triangles=400", "gen:grid-soup?boxes=20"}) {
        const Scene scene = traces::load_scene(generated);
        for (const traces::Preparation& one : traces::preparations()) {
            SCOPED_TRACE(std::string(generated) + " " + one.id);
            const PreparedScene result = prepared(scene, one.id);
            EXPECT_EQ(result.scene.screen_space, scene.screen_space);
            EXPECT_EQ(result.steps[0].after.triangles, result.steps[0].before.triangles);
            if (one.id == "quantise") continue; // moves them
            EXPECT_EQ(triangle_values(result.scene, false), triangle_values(scene, false));
        }
    }
}

TEST(Preparation, MeasuresOfAStripOfTwoTrianglesAreThoseCountedByHand) {
    traces::Mesh mesh;
    mesh.name = "square";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.indices = {0, 1, 2, 2, 1, 3, 3, 3, 0};
    Scene scene = scene_of({mesh});
    scene.draws[0].instances.resize(5, glm::mat4(1.0F)); // counted once
    scene.draws.push_back(scene.draws[0]);               // counted again
    const MeshMeasure one = traces::measure_meshes(scene, {.entries = 3}, {.bytes = 64, .line = 16, .ways = 4});
    EXPECT_EQ(one.draws, 2U);
    EXPECT_EQ(one.triangles, 4U);
    EXPECT_EQ(one.degenerate, 2U);
    EXPECT_EQ(one.vertices, 8U);
    EXPECT_EQ(one.index_bytes, 36U);
    EXPECT_EQ(one.vertex_bytes, 96U);
    EXPECT_EQ(one.vertex_shader_runs, 10U); // 0 1 2 3, and 0 again: 3 pushed it out
    EXPECT_EQ(one.acmr, 2.5);
    EXPECT_EQ(one.atvr, 1.25);
    EXPECT_EQ(one.lines_fetched, 6U); // 48 bytes, which stay
    EXPECT_EQ(one.bytes_fetched, 96U);
    EXPECT_EQ(one.overfetch, 1.0);
    EXPECT_THROW(traces::measure_meshes(scene, {}, {.bytes = 64, .line = 24, .ways = 1}), sim::InputError);
}

TEST(Preparation, InterleavingDecidesWhereAttributesLie) {
    const Scene scene = scene_of({hill_mesh(10, 10, 1)}, VertexLayout::separate);
    const Scene together = prepared(scene, "interleave").scene;
    for (const auto& attribute : together.resources->geometries[0].attributes) {
        EXPECT_EQ(attribute.buffer, 0U);
        EXPECT_EQ(attribute.stride, 28U); // 12 of the position, 12 of the normal, 4 of the colour
    }
    const Scene apart = prepared(together, "interleave?layout=separate").scene;
    std::map<Semantic, std::uint32_t> strides;
    std::set<std::uint32_t> buffers;
    for (const auto& attribute : apart.resources->geometries[0].attributes) {
        strides[attribute.semantic] = attribute.stride;
        buffers.insert(attribute.buffer);
    }
    EXPECT_EQ(strides, (std::map<Semantic, std::uint32_t>{
                           {Semantic::position, 12}, {Semantic::normal, 12}, {Semantic::colour, 4}}));
    EXPECT_EQ(buffers.size(), 3U);
}

TEST(Preparation, PreparedMeshesKeepTheLayoutTheyCameWith) {
    for (const VertexLayout layout : {VertexLayout::separate, VertexLayout::interleaved}) {
        const Scene scene = scene_of({hill_mesh(10, 10, 1)}, layout);
        const Scene after = prepared_in_turn(scene, {"shuffle", "reorder", "batch", "weld"}).scene;
        const auto& was = scene.resources->geometries[0].attributes;
        const auto& is = after.resources->geometries[0].attributes;
        ASSERT_EQ(is.size(), was.size());
        for (std::size_t i = 0; i < is.size(); ++i) {
            EXPECT_EQ(is[i].stride, was[i].stride);
            EXPECT_EQ(is[i].buffer == is[0].buffer, was[i].buffer == was[0].buffer);
        }
    }
}

TEST(Preparation, RecommendedLayoutHasShortIndicesFloatsAndByteColours) {
    const Scene scene = scene_of({hill_mesh(300, 300, 1)}, VertexLayout::separate);
    ASSERT_EQ(scene.resources->geometries[0].index_type, pipeline::IndexType::u32);
    const Scene after = prepared_in_turn(scene, {"quantise?box=cube&normals=s8", "recommended"}).scene;
    EXPECT_GE(after.draws.size(), 2U);
    for (const pipeline::Geometry& geometry : after.resources->geometries) {
        EXPECT_EQ(geometry.index_type, pipeline::IndexType::u16);
        EXPECT_LE(geometry.vertex_count, 65'536U);
        for (const auto& attribute : geometry.attributes) {
            EXPECT_EQ(attribute.stride, 28U);
            EXPECT_EQ(attribute.buffer, geometry.attributes[0].buffer);
            EXPECT_EQ(attribute.type == pipeline::ComponentType::u8, attribute.semantic == Semantic::colour);
            EXPECT_EQ(attribute.type == pipeline::ComponentType::f32, attribute.semantic != Semantic::colour);
        }
    }
}

TEST(Preparation, WeldingFindsTheSharedVerticesOfASoupOfCopies) {
    traces::Mesh mesh = hill_mesh(12, 9, 1), copies;
    copies.name = "copies";
    for (const std::uint32_t vertex : mesh.indices) {
        copies.positions.push_back(mesh.positions[vertex]);
        copies.colours.push_back(mesh.colours[vertex]);
    }
    const PreparedScene result = prepared(scene_of({copies}), "weld");
    EXPECT_EQ(result.steps[0].before.vertices, 12U * 9U * 6U);
    EXPECT_EQ(result.steps[0].after.vertices, 13U * 10U);
    EXPECT_EQ(result.scene.resources->geometries[0].vertex_count, 13U * 10U);
}

TEST(Preparation, DrawsThatShareAGeometryGoOnSharingIt) {
    const Scene shared = meshes_to_keep().back();
    for (const std::string& spec : keeping_values()) {
        const Scene after = prepared(shared, spec).scene;
        std::map<std::uint32_t, std::size_t> users;
        for (const pipeline::Draw& draw : after.draws) ++users[draw.geometry];
        EXPECT_EQ(users.size(), after.resources->geometries.size()) << spec;
        EXPECT_LT(users.size(), after.draws.size()) << spec;
        EXPECT_EQ(after.triangles_drawn >= shared.triangles_drawn, true) << spec;
    }
}

TEST(Preparation, SameSpecSameBytesAndAHashOfItsOwn) {
    const Scene scene = scene_of({hill_mesh(20, 20, 1)});
    const PreparedScene a = prepared_in_turn(scene, {"shuffle?seed=3", "reorder?algorithm=pca&patch=60"});
    const PreparedScene b = prepared_in_turn(scene, {"shuffle?seed=3", "reorder?algorithm=pca&patch=60"});
    ASSERT_EQ(a.scene.resources->buffers.size(), b.scene.resources->buffers.size());
    for (std::size_t i = 0; i < a.scene.resources->buffers.size(); ++i)
        EXPECT_EQ(a.scene.resources->buffers[i].bytes, b.scene.resources->buffers[i].bytes);
    EXPECT_EQ(a.scene.hash, b.scene.hash);
    EXPECT_NE(a.scene.hash, scene.hash);
    EXPECT_NE(a.scene.hash, prepared_in_turn(scene, {"shuffle?seed=4", "reorder?algorithm=pca&patch=60"}).scene.hash);
    EXPECT_EQ(a.scene.name, scene.name);
    EXPECT_EQ(a.steps[0].id, "shuffle?seed=3");
    EXPECT_EQ(a.steps[1].id, "reorder?algorithm=pca&cache=16&patch=60&fetch=true");
    EXPECT_EQ(a.steps[1].before.acmr, a.steps[0].after.acmr);
}

TEST(Preparation, WhatIsNotKnownIsAnErrorThatNamesWhatIsNear) {
    const Scene scene = one_triangle();
    EXPECT_NE(preparation_error(scene, "reordre").find("did you mean 'reorder'"), std::string::npos);
    EXPECT_NE(preparation_error(scene, "reorder?algorithm=fifi").find("did you mean 'fifo'"), std::string::npos);
    EXPECT_NE(preparation_error(scene, "batch?vertice=3").find("did you mean 'vertices'"), std::string::npos);
    EXPECT_NE(preparation_error(scene, "batch?vertices=2").find("batch"), std::string::npos);
    EXPECT_NE(preparation_error(scene, "batch?vertices").find("KEY=VALUE"), std::string::npos);
    EXPECT_NE(preparation_error(scene, "").find("expected one of"), std::string::npos);
}

TEST(Preparation, TableNamesSummariesAndParameters) {
    for (const traces::Preparation& one : traces::preparations()) {
        EXPECT_FALSE(one.summary.empty()) << one.id;
        for (const sim::FieldInfo& parameter : one.parameters) EXPECT_FALSE(parameter.text.empty()) << one.id;
        const PreparedScene result = prepared(scene_of({hill_mesh(5, 4, 1)}), one.id);
        EXPECT_TRUE(result.steps.at(0).id.starts_with(one.id));
    }
}

} // namespace traces_preparation_test
