// The crossbar from the reorder buffer to the ROP groups: a queue and a link of bounded bandwidth for each group.
//
// Modelled: bytes of a fragment's outputs over a link per cycle; quads of one group keep their order, those of
// different groups pass each other, until the queue of one is full: then its next quad holds back all behind it. What
// the shader computed for a pixel of several samples is sent once, with a depth for each sample. Source: specification
// 004, sections 7, 7.3 (crossbar traffic: FS outputs only, versus 64 B for the shader designs).
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "pipeline/output/crossbar_params.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <vector>

namespace pipeline {

struct CrossbarStats {
    sim::Counter quads, bytes;

    static constexpr auto fields() {
        return std::tuple{sim::field<&CrossbarStats::quads>("Quads carried").unit("quads"),
                          sim::field<&CrossbarStats::bytes>("Bytes of fragment outputs carried").unit("bytes")};
    }
};
static_assert(sim::fully_described<CrossbarStats>);

class Crossbar final : public sim::Component {
  public:
    sim::In<QuadTask> quads_in{*this, "quads_in"};
    std::vector<sim::Out<QuadTask>> partitions_out; ///< one per ROP group

    Crossbar(sim::Context context, const CrossbarParams& params, const PassContext& pass, std::uint32_t partitions);

    const CrossbarStats& stats() const { return stats_; }
    /// Bytes of shader outputs that a living fragment of one sample sends in the present pass.
    std::uint32_t bytes_per_fragment() const;

  private:
    sim::Activity tick() override;
    struct Lane {
        FixedQueue<QuadTask> queue;
        sim::Cycle link_free = 0;
    };
    bool take_inputs();
    bool serve(std::size_t group);
    bool broadcast(const QuadTask& command);

    CrossbarParams params_;
    const PassContext* pass_;
    std::vector<std::string> port_names_;
    std::vector<Lane> lanes_;   ///< by group
    std::uint32_t waiting_ = 0; ///< messages in all lanes
    CrossbarStats stats_;
};

} // namespace pipeline
