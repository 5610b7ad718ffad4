// Primitive assembly: holds primitives until their one to three vertices are shaded.
//
// Modelled: primitives in order, a bounded number a cycle. Shaded vertices come in sequence order, so a primitive is
// complete once as many vertices have arrived as its last one has for a sequence number.
// Not modelled: reading the vertices out of the post-transform cache.
// Source: specification 004, section 2.1.
#pragma once

#include "pipeline/geometry/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

namespace pipeline {

struct PrimitiveAssemblyParams {
    std::uint32_t primitives_per_clk = 1;
    std::uint32_t primitives_in_flight = 512;

    static constexpr auto fields() {
        using P = PrimitiveAssemblyParams;
        return std::tuple{
            sim::field<&P::primitives_per_clk>("Primitives assembled").unit("primitives/cycle").range(1, 64),
            sim::field<&P::primitives_in_flight>("Primitives between the post-transform cache and here")
                .unit("primitives")
                .range(2, 65536)};
    }
};
static_assert(sim::fully_described<PrimitiveAssemblyParams>);

struct PrimitiveAssemblyStats {
    sim::Counter vertices, primitives;

    static constexpr auto fields() {
        using S = PrimitiveAssemblyStats;
        return std::tuple{sim::field<&S::vertices>("Shaded vertices received").unit("vertices"),
                          sim::field<&S::primitives>("Primitives assembled").unit("primitives")};
    }
};
static_assert(sim::fully_described<PrimitiveAssemblyStats>);

class PrimitiveAssembly final : public sim::Component {
  public:
    using Params = PrimitiveAssemblyParams;
    using Stats = PrimitiveAssemblyStats;

    sim::In<ReusedPrimitive> primitives_in{*this, "primitives_in"};
    sim::In<VertexTask> vertices_in{*this, "vertices_in"};
    sim::Out<AssembledPrimitive> primitives_out{*this, "primitives_out"};

    PrimitiveAssembly(sim::Context context, const Params& params);

    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }

  private:
    sim::Activity tick() override;

    Params params_;
    Stats stats_;
    std::uint32_t received_ = 0; ///< sequence number of the last vertex received
};

} // namespace pipeline
