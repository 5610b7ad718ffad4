// The command processor: takes draw commands as the processor (CPU) submits them and sets the pipeline up for each.
//
// Modelled: a draw call arrives no earlier than the calls before it and its own conversions (host.hpp) have cost on the
// CPU; its state costs GPU cycles, while earlier draws are still being drawn, and so do other render targets, which
// wait for all earlier work. The instances of one draw are one call, of which only the first pays. Not modelled: the
// bus that commands arrive over; dependencies between draws. Source: specification 004, sections 2.1, 5 (draw_cpu_us,
// draw_gpu_cycles), 9.1.
#pragma once

#include "pipeline/geometry/geometry_pass.hpp"
#include "pipeline/geometry/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

namespace pipeline {

struct CommandProcessorParams {
    double draw_cpu_us = 2.0;
    std::uint32_t draw_gpu_cycles = 200;
    std::uint32_t target_switch_cycles = 0;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&CommandProcessorParams::draw_cpu_us>("CPU time between two draw calls")
                .unit("us")
                .range(0, 1e6),
            sim::field<&CommandProcessorParams::draw_gpu_cycles>("Time to set the pipeline up for a draw call")
                .unit("cycles")
                .at_most(10000000),
            sim::field<&CommandProcessorParams::target_switch_cycles>(
                "Time to set other render targets up, beside that to finish all work on those before")
                .unit("cycles")
                .at_most(10000000)};
    }
};
static_assert(sim::fully_described<CommandProcessorParams>);

struct CommandProcessorStats {
    sim::Counter draws, instances, target_switches, cpu_wait_cycles;

    static constexpr auto fields() {
        using S = CommandProcessorStats;
        return std::tuple{
            sim::field<&S::draws>("Draw calls").unit("draws"),
            sim::field<&S::instances>("Instances drawn").unit("draws"),
            sim::field<&S::target_switches>("Times that other render targets were set").unit("times"),
            sim::field<&S::cpu_wait_cycles>("Time the next draw call had not been submitted yet").unit("cycles")};
    }
};
static_assert(sim::fully_described<CommandProcessorStats>);

class CommandProcessor final : public sim::Component {
  public:
    using Params = CommandProcessorParams;
    using Stats = CommandProcessorStats;

    sim::Out<DrawCommand> draws_out{*this, "draws_out"};

    /// @param frame_us CPU time before the first draw of the first pass
    CommandProcessor(sim::Context context, const Params& params, const GeometryPass& pass, double frame_us = 0);

    /// Begins with the first range of the pass at the next clock edge. Called between runs.
    /// @param switches the pass writes to other targets than the one before
    void start(bool switches = false);

    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }

  private:
    sim::Activity tick() override;
    bool begins_call() const; ///< range next_ is the first instance of its draw call
    bool take();              ///< false: not submitted yet

    Params params_;
    double frame_us_;
    const GeometryPass* pass_;
    Stats stats_;
    bool starting_ = false;
    bool switches_ = false;  ///< before the first range, other targets are set
    sim::Time start_ = 0;    ///< first edge of the pass
    std::uint32_t next_ = 0; ///< range to be sent next
    double cpu_us_ = 0;      ///< CPU time of the pass up to the submission of range next_
    bool converted_ = false; ///< ... with the conversion of its vertices
    bool taken_ = false;     ///< range next_ is being set up
    sim::Cycle free_ = 0;    ///< edge at which the range before it left
    sim::Cycle set_up_at_ = 0;
};

} // namespace pipeline
