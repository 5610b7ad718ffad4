// The programmable blender of one ROP partition: timing of the modify program, and what happens when a pixel comes back
// while it is still inside.
//
// Modelled: cycles per fragment from the program's operations and the tile cache port; one fragment per ROP at a time;
// pipeline latency; stall, forwarding, or neither.
// Source: specification 004, section 7.3 (steps 3-5, cost); Bavoil 2007, section 4.3.1.
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/output/kbuffer_design.hpp"
#include "sim/stats.hpp"
#include "sim/time.hpp"

#include <algorithm>

namespace pipeline {

class ProgrammableBlender {
  public:
    /// @param rops blenders of the partition
    ProgrammableBlender(const BlenderSite& site, const ModifyProgram& program, std::uint32_t rops)
        : site_(site),
          rops_(rops),
          inside_(site.latency + 1),
          cost_(std::max({1U, (program.cost().operations + site.lanes - 1) / site.lanes,
                          (2 * program.bytes_per_pixel() + site.port_bytes - 1) / site.port_bytes})) {}

    const BlenderSite& site() const { return site_; }
    /// Cycles one ROP works on one fragment.
    std::uint32_t cycles_per_fragment() const { return cost_; }
    /// Cycles the partition's blenders work on a quad of `fragments` fragments.
    std::uint32_t cycles_per_quad(std::uint32_t fragments) const { return (fragments + rops_ - 1) / rops_ * cost_; }

    /// First cycle at which these pixels may enter; `now` when nothing holds them back.
    sim::Cycle may_enter(std::uint32_t block, std::uint8_t mask, sim::Cycle now) {
        while (!inside_.empty() && inside_.front().written <= now) inside_.pop();
        if (site_.interlock != BlendInterlock::stall) return now;
        sim::Cycle at = now;
        for (std::uint32_t i = 0; i < inside_.size(); ++i)
            if (inside_[i].block == block && (inside_[i].mask & mask) != 0) at = std::max(at, inside_[i].written);
        return at;
    }
    /// The quad enters at `now`; returns the cycle at which its result is written.
    sim::Cycle enter(std::uint32_t block, std::uint8_t mask, sim::Cycle now, std::uint32_t cycles) {
        const sim::Cycle written = now + std::max(site_.latency, cycles);
        inside_.push({block, mask, written});
        return written;
    }

  private:
    struct Inside {
        std::uint32_t block = 0;
        std::uint8_t mask = 0;
        sim::Cycle written = 0;
    };
    BlenderSite site_;
    std::uint32_t rops_;
    FixedQueue<Inside> inside_;
    std::uint32_t cost_;
};

} // namespace pipeline
