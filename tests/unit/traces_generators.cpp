#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "traces/generators.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <meshoptimizer.h>

namespace traces_generators_test {

using pipeline::Semantic;
using traces::Scene;

std::vector<unsigned> indices_of(const Scene& scene, std::size_t geometry = 0) {
    const auto& one = scene.resources->geometries.at(geometry);
    const pipeline::IndexReader read(*scene.resources, one);
    std::vector<unsigned> list(one.index_count);
    for (std::uint32_t i = 0; i < one.index_count; ++i) list[i] = read(i);
    return list;
}

float acmr(const Scene& scene, unsigned cache) {
    const auto indices = indices_of(scene);
    return meshopt_analyzeVertexCache(indices.data(), indices.size(), scene.resources->geometries[0].vertex_count,
                                      cache, 0, 0)
        .acmr;
}

std::string error_of(const std::string& spec) {
    try {
        traces::load_scene(spec);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(Generators, EveryOneOfTheTableMakesTheSceneOfItsDefaults) {
    for (const traces::Generator& generator : traces::generators()) {
        if (generator.id == "random-quads" || generator.id == "grass" || generator.id == "blob")
            continue; // large; below
        const Scene scene = traces::load_scene("gen:" + generator.id);
        EXPECT_GT(scene.triangles_drawn, 0U) << generator.id;
        EXPECT_EQ(scene.triangles, scene.triangles_drawn) << generator.id;
        EXPECT_EQ(scene.name, "gen:" + generator.id);
    }
}

TEST(Generators, SameSeedSameBytes) {
    for (const std::string spec :
         {"gen:grass?blades=500", "gen:blob?triangles=2000", "gen:random-quads?n=500&area=4096", "gen:discs?n=50",
          "gen:grid-soup?boxes=50", "gen:stack?n=9&order=random"}) {
        EXPECT_EQ(traces::load_scene(spec).hash, traces::load_scene(spec).hash) << spec;
        EXPECT_NE(traces::load_scene(spec).hash, traces::load_scene(spec + "&seed=2").hash) << spec;
    }
}

TEST(Generators, G1_GrassHasSevenVerticesFiveTrianglesFifteenIndicesPerBlade) {
    const Scene scene = traces::load_scene("gen:grass?blades=1000");
    const auto& geometry = scene.resources->geometries.at(0);
    EXPECT_EQ(geometry.vertex_count, 7000U);
    EXPECT_EQ(geometry.index_count, 15000U);
    EXPECT_EQ(scene.triangles, 5000U);
    EXPECT_EQ(geometry.index_type, pipeline::IndexType::u16);
    EXPECT_EQ(geometry.find(Semantic::position)->stride, 12U);
}

TEST(Generators, G1_GrassMissesSevenVerticesPerBladeInAnyFifoOfThree) {
    const Scene scene = traces::load_scene("gen:grass?blades=1000");
    for (const unsigned cache : {3U, 16U, 24U}) EXPECT_FLOAT_EQ(acmr(scene, cache), 1.4F);
}

TEST(Generators, GrassOfTheBenchmarkHasItsCounts) {
    const Scene scene = traces::load_scene("gen:grass?blades=300000");
    EXPECT_EQ(scene.triangles, 1500000U);
    EXPECT_EQ(scene.vertices, 2100000U);
    EXPECT_EQ(scene.resources->geometries[0].index_type, pipeline::IndexType::u32);
}

TEST(Generators, GrassInBatchesDrawsTheSameBlades) {
    const Scene whole = traces::load_scene("gen:grass?blades=1000");
    const Scene parts = traces::load_scene("gen:grass?blades=1000&blades_per_draw=300");
    ASSERT_EQ(parts.draws.size(), 4U);
    EXPECT_EQ(parts.triangles_drawn, whole.triangles_drawn);
    EXPECT_EQ(parts.resources->geometries[3].vertex_count, 700U);
    const auto last = indices_of(parts, 3);
    EXPECT_EQ(*std::max_element(last.begin(), last.end()), 699U);
    EXPECT_EQ(parts.resources->buffers.size(), whole.resources->buffers.size());
    EXPECT_EQ(parts.lo, whole.lo);
    EXPECT_EQ(parts.hi, whole.hi);
}

TEST(Generators, GrassCanBeInterleaved) {
    const Scene scene = traces::load_scene("gen:grass?blades=10&layout=interleaved");
    const auto& geometry = scene.resources->geometries.at(0);
    EXPECT_EQ(geometry.find(Semantic::position)->buffer, geometry.find(Semantic::normal)->buffer);
    EXPECT_EQ(geometry.find(Semantic::position)->stride, 24U);
    EXPECT_EQ(geometry.find(Semantic::normal)->offset, 12U);
}

TEST(Generators, BlobHasItsTrianglesAndIsClosed) {
    for (const std::uint32_t triangles : {100U, 1000U, 20000U}) {
        const Scene scene = traces::load_scene("gen:blob?triangles=" + std::to_string(triangles));
        EXPECT_EQ(scene.triangles, triangles);
        EXPECT_EQ(scene.vertices, triangles / 2 + 2); // Euler, for a surface like a sphere
        const auto indices = indices_of(scene);
        std::map<std::pair<unsigned, unsigned>, int> edges;
        for (std::size_t i = 0; i < indices.size(); i += 3)
            for (std::size_t e = 0; e < 3; ++e) ++edges[{indices[i + e], indices[i + (e + 1) % 3]}];
        for (const auto& [edge, count] : edges) {
            EXPECT_EQ(count, 1); // each direction once: all triangles wind alike
            EXPECT_TRUE(edges.contains({edge.second, edge.first}));
        }
    }
}

TEST(Generators, BlobFacesOutwardWithNormals) {
    const Scene scene = traces::load_scene("gen:blob?triangles=2000&bumps=0");
    const auto& geometry = scene.resources->geometries.at(0);
    const pipeline::AttributeReader position(*scene.resources, *geometry.find(Semantic::position));
    const pipeline::AttributeReader normal(*scene.resources, *geometry.find(Semantic::normal));
    for (std::uint32_t i = 0; i < geometry.vertex_count; ++i)
        EXPECT_GT(glm::dot(glm::vec3(position(i)), glm::vec3(normal(i))), 0.95F);
}

TEST(Generators, BlobInPatchesReusesVerticesAsAScanDoes) {
    const Scene patches = traces::load_scene("gen:blob?triangles=100000");
    EXPECT_LT(acmr(patches, 24), 0.8F);
    EXPECT_GT(acmr(traces::load_scene("gen:blob?triangles=100000&order=random"), 24), 2.9F);
}

TEST(Generators, BlobOfTheDragonHasItsTriangles) { EXPECT_EQ(traces::load_scene("gen:blob").triangles, 871000U); }

TEST(Generators, ErrorsNameWhatWasExpected) {
    EXPECT_EQ(error_of("gen:gras"),
              "gen:gras: expected one of grass, blob, grid-soup, stack, quads, random-quads, discs, "
              "tetrahedra, particles, csg, slabs, planes, showroom; "
              "did you mean 'grass'?");
    EXPECT_EQ(error_of("gen:grass?bladez=5"), "gen:grass: unknown key 'bladez'; did you mean 'blades'?");
    EXPECT_EQ(error_of("gen:grass?bla\ndes=5"), "gen:grass: unknown key 'bla des'; did you mean 'blades'?");
    EXPECT_EQ(error_of("gen:grass?blades=0"), "gen:grass: blades: expected whole number 1 to 20000000, got 0");
    EXPECT_EQ(error_of("gen:grass?blades=many"),
              "gen:grass: blades: expected whole number 1 to 20000000, got \"many\"");
    EXPECT_EQ(error_of("gen:grass?blades"), "gen:grass: expected KEY=VALUE, got 'blades'");
    EXPECT_EQ(error_of("gen:stack?n=1&n=2"), "gen:stack: 'n' is set twice");
    EXPECT_EQ(error_of("gen:stack?order=up"),
              "gen:stack: order: expected one of front-to-back | back-to-front | random, got \"up\"");
    EXPECT_EQ(error_of("gen:random-quads?area=6"), "gen:random-quads: area: expected a multiple of 4, got 6");
    EXPECT_EQ(error_of("gen:discs?n=1&overlap=8"),
              "gen:discs: n: expected enough discs for an overlap of 8 with discs that fit into 512x512 px (radius "
              "819.7), got 1");
}

} // namespace traces_generators_test
