// The front half of the GPU, from the draw call to the triangle that is ready to be rasterized.
//
//   command processor -> index fetch -> vertex reuse ----------------------> primitive assembly -> clip and cull ->
//   setup
//                        (or counter)      `-> vertex fetch -> vertex shader -'
//
// The index fetch unit is built only for frames that read an index buffer; the feed from the host stands before vertex
// reuse only when vertices do not come from buffers of the GPU.
#pragma once

#include "pipeline/geometry/clip_cull.hpp"
#include "pipeline/geometry/command_processor.hpp"
#include "pipeline/geometry/host_feed.hpp"
#include "pipeline/geometry/index_fetch.hpp"
#include "pipeline/geometry/primitive_assembly.hpp"
#include "pipeline/geometry/triangle_setup.hpp"
#include "pipeline/geometry/vertex_fetch.hpp"
#include "pipeline/geometry/vertex_reuse.hpp"
#include "pipeline/geometry/vertex_shader.hpp"

#include <memory>
#include <nlohmann/json_fwd.hpp>

namespace pipeline {

class MemorySystem;

struct GeometryParams {
    CommandProcessorParams command_processor;
    IndexFetchParams index_fetch;
    VertexReuseParams vertex_reuse;
    VertexFetchParams vertex_fetch;
    VertexShaderParams vertex_shader;
    PrimitiveAssemblyParams primitive_assembly;
    ClipCullParams clip_cull;
    TriangleSetupParams triangle_setup;

    static constexpr auto fields() {
        using P = GeometryParams;
        return std::tuple{sim::field<&P::command_processor>("Command processor"),
                          sim::field<&P::index_fetch>("Index fetch unit"),
                          sim::field<&P::vertex_reuse>("Post-transform cache"),
                          sim::field<&P::vertex_fetch>("Vertex fetch unit and pre-transform cache"),
                          sim::field<&P::vertex_shader>("Vertex shader units"),
                          sim::field<&P::primitive_assembly>("Primitive assembly"),
                          sim::field<&P::clip_cull>("Clipping and culling"),
                          sim::field<&P::triangle_setup>("Triangle setup")};
    }
};
static_assert(sim::fully_described<GeometryParams>);

/// Counters of all stages; two copies can be subtracted (sim::difference) to get those of a pass.
struct GeometryStats {
    CommandProcessorStats command_processor;
    IndexFetchStats index_fetch; ///< of the primitive counter when that is built instead
    HostFeedStats host_feed;
    VertexReuseStats vertex_reuse;
    VertexFetchStats vertex_fetch;
    VertexShaderStats vertex_shader;
    PrimitiveAssemblyStats primitive_assembly;
    ClipCullStats clip_cull;
    TriangleSetupStats triangle_setup;

    static constexpr auto fields() {
        using S = GeometryStats;
        return std::tuple{sim::field<&S::command_processor>("Command processor"),
                          sim::field<&S::index_fetch>("Index fetch unit or primitive counter"),
                          sim::field<&S::host_feed>("Vertices from the application"),
                          sim::field<&S::vertex_reuse>("Post-transform cache"),
                          sim::field<&S::vertex_fetch>("Vertex fetch unit and pre-transform cache"),
                          sim::field<&S::vertex_shader>("Vertex shader units"),
                          sim::field<&S::primitive_assembly>("Primitive assembly"),
                          sim::field<&S::clip_cull>("Clipping and culling"),
                          sim::field<&S::triangle_setup>("Triangle setup")};
    }
};
static_assert(sim::fully_described<GeometryStats>);

/// What one draw, all instances and passes together, cost the front.
struct GeometryDrawStats {
    sim::Counter primitives, vertices_referenced, vertex_shader_runs, culled, degenerate, clipped, triangles,
        index_bytes, vertex_bytes;

    /// Shader runs per primitive that is not degenerate; 0 without any. As of meshes (traces::MeshMeasure): stitches
    /// between strips are no triangles.
    double acmr() const {
        const std::uint64_t whole = primitives.value - degenerate.value;
        return whole == 0 ? 0.0 : static_cast<double>(vertex_shader_runs.value) / static_cast<double>(whole);
    }

    static constexpr auto fields() {
        using S = GeometryDrawStats;
        return std::tuple{
            sim::field<&S::primitives>("Primitives").unit("primitives"),
            sim::field<&S::vertices_referenced>("Corners of primitives").unit("vertices"),
            sim::field<&S::vertex_shader_runs>("Vertices shaded; over primitives that are not degenerate: the ACMR")
                .unit("vertices"),
            sim::field<&S::culled>("Primitives that were culled").unit("primitives"),
            sim::field<&S::degenerate>("Of these, primitives without area").unit("primitives"),
            sim::field<&S::clipped>("Primitives that were clipped").unit("primitives"),
            sim::field<&S::triangles>("Triangles to be rasterized").unit("triangles"),
            sim::field<&S::index_bytes>("Bytes of index buffer requested").unit("bytes"),
            sim::field<&S::vertex_bytes>("Bytes of vertices requested").unit("bytes")};
    }
};
static_assert(sim::fully_described<GeometryDrawStats>);

class GeometryFront {
  public:
    /// Builds what `needs` asks for; components are named "geometry.command_processor" and so on. `frame` must outlive
    /// this.
    GeometryFront(sim::Simulation& simulation, const sim::Clock& clock, const GeometryParams& params,
                  const Frame& frame, const Needs& needs, const HostParams& host = {});

    /// Links the memory ports to the crossbar.
    void attach(MemorySystem& memory);
    /// To be linked to the rasterizer.
    sim::Out<TriangleTask>& triangles_out() { return triangle_setup_.triangles_out; }

    /// What the vertex shaders of the passes from now on read; `needs` of the constructor before.
    void read(const Needs& needs) { vertex_fetch_.read(needs); }
    /// Between passes.
    void drop_cached() { vertex_fetch_.drop_cached(); }
    /// Begins a pass at the next clock edge; then call Simulation::run(). `draws` is the list that DrawRange::draw
    /// counts (and to which memory traffic is booked); `ranges`, some of stream.draws in order, or all of them, is what
    /// to draw. Everything must stay unchanged until the run ends.
    /// With `switches` the pass has other render targets than the one before.
    void start(const FragmentStream& stream, std::span<const Draw> draws, bool switches = false);
    void start(const FragmentStream& stream, std::span<const Draw> draws, std::span<const DrawRange> ranges,
               bool switches = false);

    bool has_index_fetch() const { return index_fetch_ != nullptr; }
    const std::vector<DrawTerms>& terms() const { return terms_; } ///< by draw of the frame
    GeometryStats stats() const;
    GeometryDrawStats draw_stats(std::uint32_t draw) const;
    /// Stage name -> params, counters, activity in cycles; only stages that are built.
    nlohmann::ordered_json report() const;

  private:
    void link_index_path();
    sim::In<IndexedPrimitive>& behind_index_path();
    void link_vertex_path(const GeometryParams& params);

    const Frame* frame_;
    HostParams host_;
    std::vector<DrawTerms> terms_;       ///< of frame_->draws
    std::vector<DrawTerms> range_terms_; ///< of the ranges of the pass, where those do not do
    GeometryPass pass_;
    CommandProcessor command_processor_;
    std::unique_ptr<IndexFetch> index_fetch_;
    std::unique_ptr<PrimitiveCounter> primitive_counter_;
    std::unique_ptr<HostFeed> host_feed_;
    VertexReuse vertex_reuse_;
    VertexFetch vertex_fetch_;
    VertexShader vertex_shader_;
    PrimitiveAssembly primitive_assembly_;
    ClipCull clip_cull_;
    TriangleSetup triangle_setup_;
};

} // namespace pipeline
