// The rasterizer: walks the 8x8 tiles of a triangle and emits its 2x2 quads.
//
// Modelled: tiles visited per cycle, empty ones included; quads emitted per cycle, all from the tiles visited in it. A
// tile with more quads than leave in one cycle holds the next visit up. Coverage, depth and colour were computed before
// (functional/). In a multisampled pass all samples of a quad leave together, at the rate of one sample.
// Not modelled: hierarchical depth.
// Source: specification 004, sections 2.1, 7 (raster_quads_per_clk), 9.3.
#pragma once

#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "pipeline/geometry/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

namespace pipeline {

struct RasterizerParams {
    std::uint32_t quads_per_clk = 4;
    std::uint32_t tiles_per_clk = 1;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&RasterizerParams::quads_per_clk>("Quads emitted per cycle, of all tiles visited in it")
                .unit("quads")
                .range(1, 64),
            sim::field<&RasterizerParams::tiles_per_clk>("8x8 tiles visited per cycle").unit("tiles").range(1, 64)};
    }
};
static_assert(sim::fully_described<RasterizerParams>);

struct RasterizerStats {
    sim::Counter triangles, triangles_without_quads, tiles, quads, fragments;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&RasterizerStats::triangles>("Triangles walked").unit("triangles"),
            sim::field<&RasterizerStats::triangles_without_quads>("Triangles that cover no pixel centre, and no sample")
                .unit("triangles"),
            sim::field<&RasterizerStats::tiles>("8x8 tiles visited").unit("tiles"),
            sim::field<&RasterizerStats::quads>("Quads emitted").unit("quads"),
            sim::field<&RasterizerStats::fragments>("Covered pixels").unit("fragments")};
    }
};
static_assert(sim::fully_described<RasterizerStats>);

class Rasterizer final : public sim::Component {
  public:
    sim::In<TriangleTask> triangles_in{*this, "triangles_in"};
    sim::Out<QuadTask> quads_out{*this, "quads_out"};

    Rasterizer(sim::Context context, const RasterizerParams& params, const PassContext& pass)
        : Component(std::move(context)), params_(params), pass_(&pass) {}

    const RasterizerParams& params() const { return params_; }
    const RasterizerStats& stats() const { return stats_; }

  private:
    sim::Activity tick() override;
    void begin(const Triangle& triangle);
    QuadId emit(QuadId first);
    std::uint32_t tile_key(QuadId quad) const;

    RasterizerParams params_;
    const PassContext* pass_;
    RasterizerStats stats_;
    QuadId next_quad_ = 0;
    QuadId end_quad_ = 0;
    std::uint32_t empty_tiles_ = 0; ///< visited tiles of the present triangle that hold no quad, still to be paid
};

} // namespace pipeline
