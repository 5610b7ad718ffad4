#include "pipeline/geometry/command_processor.hpp"

#include <algorithm>
#include <utility>

namespace pipeline {

namespace {
constexpr double picoseconds_per_us = 1e6;
}

CommandProcessor::CommandProcessor(sim::Context context, const Params& params, const GeometryPass& pass,
                                   double frame_us)
    : Component(std::move(context)), params_(params), frame_us_(frame_us), pass_(&pass) {}

void CommandProcessor::start(bool switches) {
    CHECK_MSG(activity() == sim::Activity::idle && !starting_, name());
    starting_ = true;
    switches_ = switches;
    start_ = clock().time_of(clock().cycle_at(now() + 1));
    simulation().wake(*this, start_);
}

bool CommandProcessor::begins_call() const {
    if (next_ == 0) return true;
    const DrawRange& range = pass_->range(next_);
    const DrawRange& before = pass_->range(next_ - 1);
    return range.is_part() || range.draw != before.draw || range.instance <= before.instance;
}

bool CommandProcessor::take() {
    sim::Cycle cost = 0;
    if (begins_call()) {
        if (!converted_) cpu_us_ += pass_->term(next_).cpu_us;
        converted_ = true;
        const auto cpu_time = static_cast<sim::Time>(cpu_us_ * picoseconds_per_us + 0.5);
        const sim::Cycle submitted = clock().cycle_at(start_ + cpu_time);
        if (submitted > cycle()) {
            wake_at(submitted);
            return false;
        }
        stats_.cpu_wait_cycles += submitted - std::min(submitted, free_);
        cost = params_.draw_gpu_cycles;
        if (std::exchange(switches_, false)) {
            cost += params_.target_switch_cycles;
            ++stats_.target_switches;
        }
        cpu_us_ += params_.draw_cpu_us;
        converted_ = false;
        ++stats_.draws;
    }
    set_up_at_ = cycle() + cost;
    taken_ = true;
    return true;
}

sim::Activity CommandProcessor::tick() {
    if (starting_) {
        if (now() < start_) return sim::Activity::idle;
        starting_ = false;
        free_ = cycle();
        next_ = 0;
        converted_ = false;
        cpu_us_ = pass_->number == 1 ? frame_us_ : 0;
    }
    if (next_ == pass_->ranges.size()) return sim::Activity::idle;
    if (!taken_ && !take()) return sim::Activity::starved;
    if (set_up_at_ > cycle()) {
        wake_at(set_up_at_);
        return sim::Activity::memory;
    }
    if (!draws_out.ready()) return sim::Activity::blocked;
    draws_out.send({next_});
    ++stats_.instances;
    ++next_;
    free_ = cycle();
    taken_ = false;
    return sim::Activity::busy;
}

} // namespace pipeline
