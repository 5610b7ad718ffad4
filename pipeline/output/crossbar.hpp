// The crossbar from the reorder buffer to the ROP partitions: one link per partition, in order, with bounded bandwidth.
//
// Modelled: bytes of a fragment's outputs over a link per cycle; head-of-line blocking behind a full partition. What
// the shader computed for a pixel of several samples is sent once, with a depth for each sample. Source: specification
// 004, sections 7, 7.3 (crossbar traffic: FS outputs only, versus 64 B for the shader designs).
#pragma once

#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "pipeline/output/crossbar_params.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <deque>
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
    std::deque<sim::Out<QuadTask>> partitions_out;

    Crossbar(sim::Context context, const CrossbarParams& params, const PassContext& pass, std::uint32_t partitions);

    const CrossbarStats& stats() const { return stats_; }
    /// Bytes of shader outputs that a living fragment of one sample sends in the present pass.
    std::uint32_t bytes_per_fragment() const;

  private:
    sim::Activity tick() override;
    bool broadcast(const QuadTask& command);

    CrossbarParams params_;
    const PassContext* pass_;
    std::vector<std::string> port_names_;
    std::vector<sim::Cycle> link_free_;
    CrossbarStats stats_;
};

} // namespace pipeline
