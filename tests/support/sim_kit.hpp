// Neighbours for a component under test: a source, a sink and a responder, and the rig that holds them.
//
//     tests::Rig rig;
//     tests::Source<int> source(rig.context("source"), {1, 2, 3});
//     tests::Sink<int>   sink(rig.context("sink"));
//     sim::connect(source.out, sink.in, {.latency = 2});
//     rig.simulation.run();
//     EXPECT_EQ(sink.cycles(), (std::vector<sim::Cycle>{2, 3, 4}));
#pragma once

#include "sim/channel.hpp"
#include "sim/simulation.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tests {

inline constexpr sim::Cycle never = ~sim::Cycle{0};
inline constexpr std::uint32_t no_limit = std::numeric_limits<std::uint32_t>::max();

/// A simulation with one clock of 1 GHz: cycle n is at n * 1000 ps.
struct Rig {
    sim::Simulation simulation;
    const sim::Clock& clock;

    explicit Rig(sim::Mode mode = sim::Mode::normal, std::uint64_t seed = 1, std::uint64_t shuffle_seed = 1)
        : simulation(seed, mode, shuffle_seed), clock(simulation.add_clock("core", 1000)) {}

    sim::Context context(std::string name) { return simulation.context(std::move(name), clock); }
    /// Number of the last edge at which anything happened.
    sim::Cycle cycles() const { return clock.cycle_before(simulation.now()); }
};

struct SourceOptions {
    sim::Cycle start = 0;               ///< the first message is sent at this cycle
    sim::Cycle gap = 0;                 ///< message i is not sent before start + i * gap
    std::uint32_t per_cycle = no_limit; ///< the width of the channel limits too
};

/// Sends a list of messages in order, as early as it may.
template <class T>
class Source final : public sim::Component {
  public:
    sim::Out<T> out{*this, "out"};

    Source(sim::Context context, std::vector<T> messages, SourceOptions options = {})
        : Component(std::move(context)), messages_(std::move(messages)), options_(options) {}

    /// Cycles at which the messages were sent.
    const std::vector<sim::Cycle>& cycles() const { return cycles_; }
    bool done() const { return cycles_.size() == messages_.size(); }

  private:
    sim::Activity tick() override {
        bool sent = false;
        for (std::uint32_t left = options_.per_cycle; left > 0 && !done(); --left) {
            const sim::Cycle due = options_.start + cycles_.size() * options_.gap;
            if (cycle() < due) {
                wake_at(due);
                return sent ? sim::Activity::busy : sim::Activity::memory;
            }
            if (!out.ready()) return sent ? sim::Activity::busy : sim::Activity::blocked;
            out.send(messages_[cycles_.size()]);
            cycles_.push_back(cycle());
            sent = true;
        }
        return sent ? sim::Activity::busy : sim::Activity::idle;
    }

    std::vector<T> messages_;
    SourceOptions options_;
    std::vector<sim::Cycle> cycles_;
};

struct SinkOptions {
    sim::Cycle start = 0;                         ///< takes nothing before this cycle; `never` takes nothing
    sim::Cycle every = 1;                         ///< takes at cycles divisible by this only
    std::uint32_t per_cycle = no_limit;           ///< the width of the channel limits too
    std::function<bool(sim::Cycle)> accepts = {}; ///< takes at cycles for which this is true only
};

/// Takes messages and notes when.
template <class T>
class Sink final : public sim::Component {
  public:
    struct Arrival {
        T value;
        sim::Cycle cycle; ///< of the sink's clock
        sim::Time time;   ///< picoseconds
    };
    sim::In<T> in{*this, "in"};

    explicit Sink(sim::Context context, SinkOptions options = {})
        : Component(std::move(context)), options_(std::move(options)) {}

    const std::vector<Arrival>& arrivals() const { return arrivals_; }
    std::size_t size() const { return arrivals_.size(); }

    std::vector<T> values() const {
        std::vector<T> values;
        for (const Arrival& arrival : arrivals_) values.push_back(arrival.value);
        return values;
    }
    std::vector<sim::Cycle> cycles() const {
        std::vector<sim::Cycle> cycles;
        for (const Arrival& arrival : arrivals_) cycles.push_back(arrival.cycle);
        return cycles;
    }

  private:
    bool open() const {
        return cycle() >= options_.start && cycle() % options_.every == 0 &&
               (!options_.accepts || options_.accepts(cycle()));
    }

    sim::Activity tick() override {
        if (in.peek() == nullptr) return sim::Activity::starved;
        if (options_.start == never) return sim::Activity::blocked;
        if (!open()) {
            wake_in(1);
            return sim::Activity::memory;
        }
        std::uint32_t left = options_.per_cycle;
        while (left-- > 0 && in.peek() != nullptr) arrivals_.push_back({in.receive(), cycle(), now()});
        return sim::Activity::busy;
    }

    SinkOptions options_;
    std::vector<Arrival> arrivals_;
};

/// Answers each request after a fixed number of cycles inside, in order: a memory or a cache that always answers in
/// time.
template <class Request, class Response>
class Responder final : public sim::Component {
  public:
    using Answer = std::function<Response(const Request&)>;
    sim::In<Request> requests_in{*this, "requests_in"};
    sim::Out<Response> responses_out{*this, "responses_out"};

    Responder(sim::Context context, sim::Cycle latency, Answer answer)
        : Component(std::move(context)), latency_(latency), answer_(std::move(answer)) {}

    const std::vector<Request>& requests() const { return requests_; }

  private:
    sim::Activity tick() override {
        bool moved = false;
        for (; requests_in.peek() != nullptr; moved = true) {
            requests_.push_back(requests_in.receive());
            pending_.push_back({cycle() + latency_, answer_(requests_.back())});
        }
        for (; !pending_.empty() && pending_.front().first <= cycle(); moved = true) {
            if (!responses_out.ready()) return moved ? sim::Activity::busy : sim::Activity::blocked;
            responses_out.send(pending_.front().second);
            pending_.pop_front();
        }
        if (moved) return sim::Activity::busy;
        if (pending_.empty()) return sim::Activity::starved;
        wake_at(pending_.front().first);
        return sim::Activity::memory;
    }

    sim::Cycle latency_;
    Answer answer_;
    std::deque<std::pair<sim::Cycle, Response>> pending_;
    std::vector<Request> requests_;
};

/// `run(seed, mode, shuffle_seed)` builds a system, runs it and returns what came out of it: that must not depend on
/// the order of ticks, nor on who sleeps.
template <class Run>
void expect_same_in_all_modes(Run&& run, std::uint64_t seed = 1, std::uint64_t shuffles = 3) {
    const auto normal = run(seed, sim::Mode::normal, std::uint64_t{1});
    EXPECT_EQ(run(seed, sim::Mode::never_sleep, std::uint64_t{1}), normal) << "never_sleep, seed " << seed;
    for (std::uint64_t shuffle = 1; shuffle <= shuffles; ++shuffle)
        EXPECT_EQ(run(seed, sim::Mode::shuffled, shuffle), normal)
            << "shuffled, seed " << seed << ", order " << shuffle;
}

} // namespace tests
