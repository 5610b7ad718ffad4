// What a scene's meshes cost the geometry feed, counted without time.
#pragma once

#include "pipeline/geometry/vertex_reuse_models.hpp"
#include "pipeline/memory/cache.hpp"
#include "sim/described.hpp"
#include "traces/scene.hpp"

#include <cstdint>
#include <tuple>

namespace traces {

/// Sums over draws. Every draw is counted on its own, with empty caches, and once whatever the number of its instances;
/// all attributes of a vertex are fetched, each time that it is shaded. The ratios belong to the sums: measures are not
/// to be added.
struct MeshMeasure {
    std::uint64_t draws = 0;
    std::uint64_t triangles = 0;
    std::uint64_t degenerate = 0;
    std::uint64_t vertices = 0;
    std::uint64_t index_bytes = 0;
    std::uint64_t vertex_bytes = 0;
    std::uint64_t vertex_shader_runs = 0;
    double acmr = 0.0;
    double atvr = 0.0;
    std::uint64_t lines_fetched = 0;
    std::uint64_t bytes_fetched = 0;
    double overfetch = 0.0;

    static constexpr auto fields() {
        using M = MeshMeasure;
        return std::tuple{
            sim::field<&M::draws>("Draw calls").unit("draws"),
            sim::field<&M::triangles>("Triangles of three different vertices").unit("triangles"),
            sim::field<&M::degenerate>("Triangles that name a vertex twice; they stitch strips").unit("triangles"),
            sim::field<&M::vertices>("Vertices that some triangle names").unit("vertices"),
            sim::field<&M::index_bytes>("Bytes of all indices").unit("bytes"),
            sim::field<&M::vertex_bytes>("Bytes of all attributes of the named vertices, each once").unit("bytes"),
            sim::field<&M::vertex_shader_runs>("Vertices shaded: misses of the post-transform cache").unit("vertices"),
            sim::field<&M::acmr>("Vertices shaded per triangle of three different vertices; 0.5 at best").at_least(0.0),
            sim::field<&M::atvr>("Vertices shaded per named vertex; 1 at best").at_least(0.0),
            sim::field<&M::lines_fetched>("Lines fetched: misses of the pre-transform cache").unit("lines"),
            sim::field<&M::bytes_fetched>("Bytes of the fetched lines").unit("bytes"),
            sim::field<&M::overfetch>("Bytes fetched per byte of the named vertices").at_least(0.0)};
    }
};
static_assert(sim::fully_described<MeshMeasure>);

/// `reuse`: the post-transform cache; its vertices_per_clk has no part in this. `pre_transform`: the line cache in
/// front of memory; sim::InputError where it is no cache. The scene's buffers are placed.
MeshMeasure measure_meshes(const Scene& scene, const pipeline::VertexReuseParams& reuse,
                           const pipeline::CacheParams& pre_transform);

} // namespace traces
