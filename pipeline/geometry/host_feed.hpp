// The way of vertices from the application into the GPU, when they do not lie in buffers of the GPU.
//
// Built only for frames of client arrays, immediate mode or display lists. Modelled: the primitives of a draw become
// known evenly over the time that handing it over takes (DrawTerms::feed_us), one draw after the other, while the GPU
// works on those that are there. Not modelled: how the driver cuts arrays into pieces.
// Source: specification 004, sections 2.1, 4.1, 5 (T3.1).
#pragma once

#include "pipeline/geometry/geometry_pass.hpp"
#include "pipeline/geometry/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

namespace pipeline {

struct HostFeedStats {
    sim::Counter primitives, wait_cycles;

    static constexpr auto fields() {
        using S = HostFeedStats;
        return std::tuple{
            sim::field<&S::primitives>("Primitives handed over").unit("primitives"),
            sim::field<&S::wait_cycles>("Time the next primitive had not been handed over yet").unit("cycles")};
    }
};
static_assert(sim::fully_described<HostFeedStats>);

class HostFeed final : public sim::Component {
  public:
    using Stats = HostFeedStats;

    sim::In<IndexedPrimitive> primitives_in{*this, "primitives_in"};
    sim::Out<IndexedPrimitive> primitives_out{*this, "primitives_out"};

    HostFeed(sim::Context context, const GeometryPass& pass) : Component(std::move(context)), pass_(&pass) {}

    const Stats& stats() const { return stats_; }

  private:
    sim::Activity tick() override;
    /// Edge at which a primitive of the present range is there.
    sim::Cycle known_at(std::uint32_t primitive) const;
    void begin_range(std::uint32_t range);

    const GeometryPass* pass_;
    Stats stats_;
    std::uint32_t pass_number_ = 0;
    std::uint32_t range_ = 0;
    sim::Cycle begin_ = 0, end_ = 0; ///< of handing the present range over
    sim::Cycle waited_ = 0;          ///< edge up to which waiting is counted
};

} // namespace pipeline
