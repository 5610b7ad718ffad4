// The unit of one ROP group that modifies pixels: timing of what it does, and what happens when a pixel comes back
// while it is still inside.
//
// Modelled: cycles per fragment from the program's operations and the cache port (or from what a fixed-function
// unit moves); one fragment per ROP at a time; pipeline latency; stall, forwarding, or neither; three ways to find out
// whom a quad has to wait for, exact, by hashed counters, by tile.
// Source: specification 004, sections 7.3 (steps 3-5, cost), 7.4; Bavoil 2007, section 4.3.1.
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/output/kbuffer_design.hpp"
#include "pipeline/output/surface_layout.hpp"
#include "sim/stats.hpp"
#include "sim/time.hpp"

#include <algorithm>

namespace pipeline {

class ProgrammableBlender {
  public:
    /// @param rops blenders of the group
    ProgrammableBlender(const BlenderSite& site, const ModifyProgram& program, std::uint32_t rops)
        : site_(site),
          rops_(rops),
          inside_(site.latency + 1),
          cost_(std::max({1U, (program.cost().operations + site.lanes - 1) / site.lanes,
                          (2 * program.bytes_per_pixel() + site.port_bytes - 1) / site.port_bytes})) {}

    const BlenderSite& site() const { return site_; }
    /// Cycles one ROP works on one fragment.
    std::uint32_t cycles_per_fragment() const { return cost_; }
    /// Cycles the group's blenders work on a quad of `fragments` fragments.
    std::uint32_t cycles_per_quad(std::uint32_t fragments) const { return (fragments + rops_ - 1) / rops_ * cost_; }
    /// The same for a quad whose fragments together take `work` cycles, or atomics, of one ROP.
    std::uint32_t cycles_of(std::uint32_t work, std::uint32_t fragments) const {
        if (site_.unit == BlendUnit::program) return cycles_per_quad(fragments);
        const std::uint32_t rate = rops_ * (site_.unit == BlendUnit::atomic_min ? site_.atomics_per_clk : 1);
        return std::max(1U, (work + rate - 1) / rate);
    }

    /// First cycle at which these pixels may enter; `now` when nothing holds them back.
    sim::Cycle may_enter(std::uint32_t block, std::uint8_t mask, sim::Cycle now) {
        while (!inside_.empty() && inside_.front().written <= now) inside_.pop();
        if (site_.interlock != BlendInterlock::stall) return now;
        sim::Cycle at = now;
        for (std::uint32_t i = 0; i < inside_.size(); ++i)
            if (collide(inside_[i], block, mask)) at = std::max(at, inside_[i].written);
        if (site_.test == InterlockTest::exact && site_.test_entries != 0 && inside_.size() >= site_.test_entries)
            at = std::max(at, inside_[inside_.size() - site_.test_entries].written);
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
    std::uint32_t counter_of(std::uint32_t block, std::uint32_t pixel) const {
        // Fibonacci hashing: neighbouring pixels spread over the counters.
        return static_cast<std::uint32_t>(((block * std::uint64_t{4} + pixel) * 0x9E3779B97F4A7C15U >> 32U) %
                                          site_.test_entries);
    }
    bool collide(const Inside& older, std::uint32_t block, std::uint8_t mask) const {
        if (site_.test == InterlockTest::tile)
            return SurfaceLayout::tile_of_block(older.block) == SurfaceLayout::tile_of_block(block);
        if (site_.test == InterlockTest::exact) return older.block == block && (older.mask & mask) != 0;
        for (std::uint32_t mine = 0; mine < 4; ++mine)
            for (std::uint32_t other = 0; other < 4; ++other)
                if ((mask >> mine & 1) != 0 && (older.mask >> other & 1) != 0 &&
                    counter_of(block, mine) == counter_of(older.block, other))
                    return true;
        return false;
    }

    BlenderSite site_;
    std::uint32_t rops_;
    FixedQueue<Inside> inside_;
    std::uint32_t cost_;
};

} // namespace pipeline
