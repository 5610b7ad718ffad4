// A fragment scheduler between a source of quads and one mock of everything behind it.
#pragma once

#include "models/kbuffers/library.hpp"
#include "pipeline/fragment/fragment_scheduler.hpp"
#include "sim/config.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace tests {

/// The hardware in front of the pipes that the scoreboard design builds. `settings`: "side_buffer=4".
inline pipeline::SchedulingPlan scoreboard_plan(const QuadPass& pass, const std::vector<std::string>& settings = {}) {
    sim::Config config;
    for (const std::string& setting : settings) config.set("scoreboard." + setting);
    pipeline::View view;
    view.width = pass.stream.width;
    view.height = pass.stream.height;
    return std::move(models::make_design("scoreboard", config)->plan(pass.program(), view).scheduling);
}

/// A pass whose fragments modify the k-buffer.
struct KBufferPass : QuadPass {
    KBufferPass() { context.end = pipeline::FragmentEnd::kbuffer_blend; }
};

struct BackEndOptions {
    pipeline::FragmentSchedulerParams scheduler = {};
    std::uint32_t pipes = 1;
    std::optional<std::uint32_t> closed_pipe = {}; ///< takes nothing
    bool commits = true;                           ///< living quads are committed, as in passes that touch the k-buffer
    sim::Cycle commit_after = 10;                  ///< from the arrival of a living quad in its pipe
    sim::Cycle acknowledge_after = 10;             ///< from the arrival of a write-back command at the order's end
    std::uint32_t reorder_places = 1024;
    sim::Cycle order_from = 0;  ///< the order's end takes nothing before
    sim::Cycle order_every = 1; ///< and then one message every so many cycles; 1 = all that come
    sim::Mode mode = sim::Mode::normal;
    std::uint64_t shuffle = 1;
};

/// Pipes, reorder buffer and one ROP partition: notes what arrives where and when, and answers a fixed time later.
class MockBackEnd final : public sim::Component {
  public:
    struct Arrival {
        std::uint32_t pipe;
        pipeline::QuadTask task;
        sim::Cycle cycle;
    };
    std::vector<sim::In<pipeline::QuadTask>> pipes_in;
    sim::In<pipeline::QuadTask> order_in{*this, "order_in"};
    sim::Out<pipeline::Commit> commits_out{*this, "commits_out"}; ///< may stay unlinked

    std::vector<Arrival> arrivals;          ///< quads, in the order of their arrival
    std::vector<pipeline::QuadTask> order;  ///< quads and commands
    std::vector<std::size_t> invalidations; ///< by pipe

    MockBackEnd(sim::Context context, const BackEndOptions& options)
        : Component(std::move(context)), invalidations(options.pipes), options_(options) {
        for (std::uint32_t pipe = 0; pipe < options.pipes; ++pipe) pipes_in.emplace_back(*this, "pipe_in");
    }

  private:
    void take_pipe(std::uint32_t pipe, const pipeline::QuadTask& task) {
        if (task.kind == pipeline::QuadKind::invalidate) {
            ++invalidations[pipe];
            return;
        }
        arrivals.push_back({pipe, task, cycle()});
        if (options_.commits && commits_out.connected() && task.mask != 0)
            due_.emplace(cycle() + options_.commit_after,
                         pipeline::Commit{task.slot, task.quad, task.pixels(), pipeline::QuadKind::quad});
    }

    bool take_order() {
        if (cycle() < options_.order_from || cycle() % options_.order_every != 0 || order_in.peek() == nullptr)
            return false;
        do {
            order.push_back(order_in.receive());
            if (order.back().kind == pipeline::QuadKind::writeback)
                due_.emplace(cycle() + options_.acknowledge_after,
                             pipeline::Commit{pipeline::no_slot, 0, 0, pipeline::QuadKind::writeback});
        } while (options_.order_every == 1 && order_in.peek() != nullptr);
        return true;
    }

    sim::Activity tick() override {
        bool moved = take_order();
        for (std::uint32_t pipe = 0; pipe < pipes_in.size(); ++pipe)
            for (; pipe != options_.closed_pipe && pipes_in[pipe].peek() != nullptr; moved = true)
                take_pipe(pipe, pipes_in[pipe].receive());
        for (; !due_.empty() && due_.begin()->first <= cycle(); moved = true) {
            commits_out.send(due_.begin()->second);
            due_.erase(due_.begin());
        }
        if (moved) return sim::Activity::busy;
        const bool waiting = order_in.peek() != nullptr;
        if (waiting) wake_in(1);
        if (!due_.empty()) wake_at(due_.begin()->first);
        return waiting || !due_.empty() ? sim::Activity::memory : sim::Activity::starved;
    }

    BackEndOptions options_;
    std::multimap<sim::Cycle, pipeline::Commit> due_;
};

class SchedulerBench {
  public:
    Rig rig;
    pipeline::SchedulingPlan no_plan;
    pipeline::FragmentScheduler scheduler;
    Source<pipeline::QuadTask> source;
    MockBackEnd back_end;

    explicit SchedulerBench(const QuadPass& pass, const BackEndOptions& options = {},
                            pipeline::SchedulingPlan* plan = nullptr, const pipeline::FlushRule& flush = {},
                            pipeline::QuadPayloads* payloads = nullptr)
        : rig(options.mode, 1, options.shuffle),
          scheduler(rig.context("scheduler"), options.scheduler, options.pipes, 1, pass.context,
                    plan != nullptr ? *plan : no_plan, flush, payloads),
          source(rig.context("source"), pass.quad_tasks()),
          back_end(rig.context("back_end"), options) {
        scheduler.begin_pass();
        sim::connect(source.out, scheduler.quads_in, {1, 64, 512});
        sim::connect(scheduler.order_out, back_end.order_in, {1, 64, options.reorder_places});
        for (std::uint32_t pipe = 0; pipe < options.pipes; ++pipe)
            sim::connect(scheduler.pipes_out[pipe], back_end.pipes_in[pipe], {1, 1, 4});
        for (auto& port : scheduler.commits_in) sim::connect(back_end.commits_out, port, {1, 64, 256});
    }

    void run() { rig.simulation.run(); }

    /// Quads that came into a pipe, in order, and the cycles at which they did.
    std::vector<pipeline::QuadId> quads_of_pipe(std::uint32_t pipe) const {
        std::vector<pipeline::QuadId> quads;
        for (const auto& arrival : back_end.arrivals)
            if (arrival.pipe == pipe) quads.push_back(arrival.task.quad);
        return quads;
    }
    std::vector<sim::Cycle> cycles_of_pipe(std::uint32_t pipe) const {
        std::vector<sim::Cycle> cycles;
        for (const auto& arrival : back_end.arrivals)
            if (arrival.pipe == pipe) cycles.push_back(arrival.cycle);
        return cycles;
    }
    /// When, and as what, a quad came into its pipe.
    const MockBackEnd::Arrival& arrival(pipeline::QuadId quad) const {
        for (const auto& arrival : back_end.arrivals)
            if (arrival.task.quad == quad) return arrival;
        throw std::out_of_range("the quad never arrived");
    }
    sim::Cycle arrival_of(pipeline::QuadId quad) const { return arrival(quad).cycle; }
};

} // namespace tests
