// Vertex shader runs of the post-transform cache models against meshoptimizer's vertex cache analyzer: equal, exactly.
#include "pipeline/geometry/vertex_reuse_models.hpp"
#include "tests/support/oracle_meshes.hpp"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

namespace {

using pipeline::ReuseModel;
using pipeline::VertexReuseModel;
using pipeline::VertexReuseParams;
using tests::IndexedMesh;

std::uint32_t runs_of(const IndexedMesh& mesh, const VertexReuseParams& params) {
    VertexReuseModel model(params);
    model.begin_draw(mesh.vertex_count, true);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        model.triangle({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
    return model.runs();
}

void expect_equal(const IndexedMesh& mesh, std::uint32_t entries, std::uint32_t warp, std::uint32_t group) {
    const meshopt_VertexCacheStatistics theirs =
        meshopt_analyzeVertexCache(mesh.indices.data(), mesh.indices.size(), mesh.vertex_count, entries, warp, group);
    const VertexReuseParams params{
        .model = ReuseModel::batch, .entries = entries, .warp_vertices = warp, .group_triangles = group};
    EXPECT_EQ(runs_of(mesh, params), theirs.vertices_transformed)
        << mesh.name << " " << entries << "/" << warp << "/" << group;
}

IndexedMesh optimized(const IndexedMesh& mesh) {
    IndexedMesh result = mesh;
    meshopt_optimizeVertexCache(result.indices.data(), mesh.indices.data(), mesh.indices.size(), mesh.vertex_count);
    result.name += " optimized";
    return result;
}

class MeshoptimizerVertexCache : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        meshes_ = tests::oracle_meshes();
        const std::size_t given = meshes_.size();
        for (std::size_t i = 0; i < given; ++i) meshes_.push_back(optimized(meshes_[i]));
    }
    static void TearDownTestSuite() { meshes_ = {}; }
    static std::vector<IndexedMesh> meshes_;
};
std::vector<IndexedMesh> MeshoptimizerVertexCache::meshes_;

TEST_F(MeshoptimizerVertexCache, FifoRunsAreEqual) {
    for (const IndexedMesh& mesh : meshes_)
        for (const std::uint32_t entries : {3U, 16U, 24U, 32U}) {
            expect_equal(mesh, entries, 0, 0);
            const auto theirs =
                meshopt_analyzeVertexCache(mesh.indices.data(), mesh.indices.size(), mesh.vertex_count, entries, 0, 0);
            EXPECT_EQ(runs_of(mesh, {.model = ReuseModel::fifo, .entries = entries}), theirs.vertices_transformed);
        }
}

TEST_F(MeshoptimizerVertexCache, WarpAndGroupRunsAreEqual) {
    for (const IndexedMesh& mesh : meshes_)
        for (const auto& [warp, group] : {std::pair{32U, 0U}, {64U, 0U}, {96U, 0U}, {0U, 128U}, {64U, 128U}}) {
            expect_equal(mesh, 16, warp, group);
            expect_equal(mesh, 32, warp, group);
        }
}

TEST_F(MeshoptimizerVertexCache, VendorPresetsAreEqual) {
    for (const IndexedMesh& mesh : meshes_) {
        expect_equal(mesh, 16, 0, 0);    // generic
        expect_equal(mesh, 32, 32, 32);  // NVIDIA
        expect_equal(mesh, 14, 64, 128); // AMD
        expect_equal(mesh, 128, 0, 0);   // Intel
    }
}

} // namespace
