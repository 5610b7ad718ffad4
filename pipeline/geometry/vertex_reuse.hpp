// The post-transform cache: finds which vertices of a primitive have been shaded already and has the others shaded.
//
// Modelled: one primitive a cycle; vertices to be shaded leave in order, a bounded number a cycle; the primitive
// follows once its last vertex has left. What is held: vertex_reuse_models.hpp. Every instance begins with an empty
// cache. Not modelled: the storage of the shaded attributes; entries do not depend on the size of a vertex. Source:
// specification 004, sections 2.1, 9.2.
#pragma once

#include "pipeline/geometry/geometry_pass.hpp"
#include "pipeline/geometry/messages.hpp"
#include "pipeline/geometry/vertex_reuse_models.hpp"
#include "sim/channel.hpp"

namespace pipeline {

struct VertexReuseStats {
    sim::Counter primitives, hits, misses;

    static constexpr auto fields() {
        using S = VertexReuseStats;
        return std::tuple{
            sim::field<&S::primitives>("Primitives looked up").unit("primitives"),
            sim::field<&S::hits>("Corners whose vertex had been shaded; hits + misses = 3 for each triangle, 2 for "
                                 "each line, 1 for each point")
                .unit("vertices"),
            sim::field<&S::misses>("Vertices sent to be shaded").unit("vertices")};
    }
};
static_assert(sim::fully_described<VertexReuseStats>);

class VertexReuse final : public sim::Component {
  public:
    using Params = VertexReuseParams;
    using Stats = VertexReuseStats;

    sim::In<IndexedPrimitive> primitives_in{*this, "primitives_in"};
    sim::Out<VertexRequest> vertices_out{*this, "vertices_out"};
    sim::Out<ReusedPrimitive> primitives_out{*this, "primitives_out"};

    /// @param forwards_index_bytes the vertex fetch unit has to know of the indices that pass its port
    VertexReuse(sim::Context context, const Params& params, const GeometryPass& pass,
                bool forwards_index_bytes = false);

    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }
    /// Stats by draw; draws not seen may be missing at the end.
    const std::vector<Stats>& draw_stats() const { return draw_stats_; }

  private:
    sim::Activity tick() override;
    void look_up(const IndexedPrimitive& primitive);
    void begin_range(std::uint32_t range);
    bool send_vertices();
    bool send_index_bytes();

    Params params_;
    const GeometryPass* pass_;
    bool forwards_index_bytes_;
    std::uint32_t index_bytes_ = 0; ///< read and not yet forwarded
    VertexReuseModel model_;
    Stats stats_;
    std::vector<Stats> draw_stats_;
    std::uint32_t pass_number_ = 0; ///< with range_: what the cache was last emptied for
    std::uint32_t range_ = 0;
    std::uint32_t corners_ = 3; ///< of the primitives of range_
    std::uint32_t draw_ = 0;
    bool holding_ = false;    ///< present_ has been looked up and has not left
    std::uint8_t unsent_ = 0; ///< corners of present_ whose vertex still has to be sent
    IndexedPrimitive present_;
    ReuseResult result_;
};

} // namespace pipeline
