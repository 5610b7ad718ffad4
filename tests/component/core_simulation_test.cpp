// The life of a run, and how it ends when it should not go on.
#include "tests/support/sim_kit.hpp"

#include "sim/check.hpp"

#include <atomic>
#include <numeric>

namespace core_simulation_test {

using sim::Activity;
using sim::Cycle;
using sim::Time;
using tests::never;
using tests::Rig;
using tests::Sink;
using tests::Source;

Time sum(const sim::ActivityTimes& times) { return std::accumulate(times.begin(), times.end(), Time{0}); }

template <class Run>
std::string error_of(Run&& run) {
    try {
        run();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "no error";
}

void expect_contains(const std::string& text, std::string_view part) {
    EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in:\n" << text;
}

// Busy for some cycles, then idle; started anew from outside.
class Worker final : public sim::Component {
  public:
    Worker(sim::Context context, Cycle cycles) : Component(std::move(context)), left_(cycles) {}
    void start(Cycle cycles) {
        left_ = cycles;
        wake_in(1);
    }
    std::function<void(Cycle)> at_each_tick = [](Cycle) {};
    std::vector<Time> ticks;

  private:
    Activity tick() override {
        at_each_tick(cycle());
        if (left_ == 0) return Activity::idle;
        ticks.push_back(now());
        --left_;
        return Activity::busy;
    }
    Cycle left_;
};

TEST(Run, FirstTickIsAtTimeZeroWithoutAsking) {
    Rig rig;
    Worker worker(rig.context("worker"), 2);
    rig.simulation.run();
    EXPECT_EQ(worker.ticks, (std::vector<Time>{0, 1000}));
    EXPECT_EQ(rig.simulation.now(), 2000U);
}

TEST(Run, NothingToDoIsNoTime) {
    sim::Simulation simulation;
    simulation.run();
    simulation.add_clock("core", 650);
    simulation.run();
    EXPECT_EQ(simulation.now(), 0U);
    EXPECT_EQ(simulation.ticks(), 0U);
}

TEST(Run, CanBeContinuedWithNewWork) {
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep}) {
        sim::Simulation simulation(1, mode);
        Worker core(simulation.context("core", simulation.add_clock("core", 1000)), 10'000);
        Worker memory(simulation.context("memory", simulation.add_clock("memory", 300)), 1);
        simulation.run();
        EXPECT_EQ(simulation.now(), 10'000'000U);
        memory.ticks.clear();
        memory.start(1); // its clock had nothing to do for thousands of edges
        simulation.run();
        EXPECT_EQ(memory.ticks, (std::vector<Time>{memory.clock().time_of(3001)}));
        core.ticks.clear();
        simulation.wake(memory, simulation.now() + 1);
        core.start(1);
        simulation.run();
        EXPECT_EQ(core.ticks.size(), 1U);
        for (const sim::Component* component : simulation.components())
            EXPECT_EQ(sum(component->activity_times()), simulation.now());
    }
}

TEST(Run, ComponentsBuiltBetweenRunsStartAfterNow) {
    Rig rig;
    Worker first(rig.context("first"), 5);
    rig.simulation.run();
    Worker second(rig.context("second"), 1);
    rig.simulation.run();
    EXPECT_EQ(second.ticks, (std::vector<Time>{6000}));
    EXPECT_EQ(sum(second.activity_times()), rig.simulation.now());
}

TEST(Run, WakingInThePastIsRefused) {
    Rig rig;
    Worker worker(rig.context("worker"), 5);
    rig.simulation.run();
    EXPECT_THROW(rig.simulation.wake(worker, rig.simulation.now()), sim::InternalError);
    EXPECT_THROW(rig.simulation.wake(worker, 0), sim::InternalError);
    EXPECT_THROW(rig.simulation.wake_at_cycle(worker, 3), sim::InternalError);
    EXPECT_NO_THROW(rig.simulation.wake(worker, rig.simulation.now() + 1));
}

// Asks for a tick at the present edge.
class Impatient final : public sim::Component {
  public:
    using Component::Component;

  private:
    Activity tick() override {
        wake_in(0);
        return Activity::memory;
    }
};

TEST(Run, WakingAtThePresentEdgeIsRefused) {
    Rig rig;
    Impatient impatient(rig.context("impatient"));
    EXPECT_THROW(rig.simulation.run(), sim::InternalError);
}

// Asks for ticks far away, again and again.
class Planner final : public sim::Component {
  public:
    std::vector<Cycle> ticks;
    Planner(sim::Context context, std::vector<Cycle> plan) : Component(std::move(context)), plan_(std::move(plan)) {}

  private:
    Activity tick() override {
        ticks.push_back(cycle());
        for (const Cycle at : plan_)
            if (at > cycle()) wake_at(at);
        return Activity::idle;
    }
    std::vector<Cycle> plan_;
};

TEST(Run, EveryFarWakeUpIsHonoured) {
    const std::vector<Cycle> plan{0, 1, 1022, 1023, 1024, 1025, 2047, 2048, 5000, 6000, 1'000'000};
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled}) {
        Rig rig(mode);
        Planner planner(rig.context("planner"), plan);
        rig.simulation.run();
        EXPECT_EQ(planner.ticks, plan);
    }
}

TEST(Run, WakingBeyondTheEndOfTimeIsRefused) {
    Rig rig;
    Worker worker(rig.context("worker"), 1);
    EXPECT_THROW(rig.simulation.wake_at_cycle(worker, ~Cycle{0} - 1), sim::InternalError);
    EXPECT_THROW(rig.simulation.wake_at_cycle(worker, ~Cycle{0} / 500), sim::InternalError);
}

TEST(Run, NamesAreUniqueAndClocksBelongToTheSimulation) {
    Rig rig, other;
    Worker worker(rig.context("worker"), 0);
    EXPECT_THROW(Worker(rig.context("worker"), 0), sim::InternalError);
    EXPECT_THROW(Worker(rig.simulation.context("alien", other.clock), 0), sim::InternalError);
    EXPECT_EQ(rig.simulation.components().size(), 1U);
}

TEST(Run, ManyComponentsOfOneClock) {
    Rig rig;
    std::vector<std::unique_ptr<Worker>> workers;
    for (Cycle i = 0; i < 300; ++i) workers.push_back(std::make_unique<Worker>(rig.context(std::to_string(i)), i));
    rig.simulation.run();
    for (Cycle i = 0; i < 300; ++i) EXPECT_EQ(workers[i]->ticks.size(), i);
    EXPECT_EQ(rig.cycles(), 299U);
}

TEST(Run, CheckNamesComponentAndTimeDuringTheRunOnly) {
    Rig rig;
    Worker worker(rig.context("pipe3.rop"), 9);
    worker.at_each_tick = [](Cycle cycle) { CHECK_MSG(cycle < 4, "too late"); };
    const std::string error = error_of([&] { rig.simulation.run(); });
    expect_contains(error, "cycle < 4 (too late), in pipe3.rop at 4000 ps");
    EXPECT_FALSE(rig.simulation.running());
    EXPECT_EQ(error_of([] { CHECK(1 > 2); }).find("pipe3"), std::string::npos);
}

TEST(Run, StopsWhenAskedAndCanGoOn) {
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep}) {
        Rig rig(mode);
        std::atomic<bool> stop = false;
        Worker worker(rig.context("worker"), 10'000);
        worker.at_each_tick = [&](Cycle cycle) {
            if (cycle == 2000) stop = true;
        };
        EXPECT_THROW(rig.simulation.run(&stop), sim::Interrupted);
        EXPECT_FALSE(rig.simulation.running());
        EXPECT_LT(rig.cycles(), 4000U);
        stop = false;
        rig.simulation.run(&stop);
        EXPECT_EQ(worker.ticks.size(), 10'000U);
        EXPECT_EQ(rig.cycles(), 10'000U);
    }
}

TEST(Run, EndlessWorkWithoutMessagesIsALivelock) {
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep}) {
        Rig rig(mode);
        rig.simulation.set_patience(5000);
        Worker endless(rig.context("endless"), never);
        Worker finite(rig.context("finite"), 10);
        const std::string error = error_of([&] { rig.simulation.run(); });
        expect_contains(error, "livelock");
        expect_contains(error, "busy: endless\n");
    }
}

TEST(Run, WaitsAndSlowMessagesAreNoLivelock) {
    Rig rig;
    rig.simulation.set_patience(5000);
    Source<int> source(rig.context("source"), {1, 2, 3, 4}, {.gap = 4000});
    Sink<int> sink(rig.context("sink"));
    Worker other(rig.context("other"), 14'000);
    sim::connect(source.out, sink.in, {.latency = 3000});
    EXPECT_NO_THROW(rig.simulation.run());
    EXPECT_EQ(sink.size(), 4U);
}

// Forwards messages in a ring; starts with two of its own.
class RingNode final : public sim::Component {
  public:
    sim::In<int> in{*this, "in"};
    sim::Out<int> out{*this, "out"};
    using Component::Component;

  private:
    Activity tick() override {
        if (held_ == 0) {
            if (in.peek() == nullptr) return Activity::starved;
            in.pop();
            held_ = 1;
            return Activity::busy;
        }
        if (!out.ready()) return Activity::blocked;
        out.send(held_);
        --held_;
        return Activity::busy;
    }
    int held_ = 2;
};

TEST(Deadlock, ReportNamesTheCycleOfWaits) {
    Rig rig;
    RingNode a(rig.context("a")), b(rig.context("b")), c(rig.context("c"));
    Sink<int> bystander(rig.context("bystander"));
    Source<int> other(rig.context("other"), {1});
    sim::connect(other.out, bystander.in, {});
    sim::connect(a.out, b.in, {.capacity = 1});
    sim::connect(b.out, c.in, {.capacity = 1});
    sim::connect(c.out, a.in, {.capacity = 1});
    const std::string error = error_of([&] { rig.simulation.run(); });
    expect_contains(error, "deadlock at ");
    expect_contains(error, "cycle of waits:\n"
                           "  a (blocked) waits for room towards b: a.out -> b.in holds 1/1\n"
                           "  b (blocked) waits for room towards c: b.out -> c.in holds 1/1\n"
                           "  c (blocked) waits for room towards a: c.out -> a.in holds 1/1\n");
    EXPECT_EQ(error.find("bystander"), std::string::npos) << error;
}

// Sends a request, and its next one only after the answer.
class Asker final : public sim::Component {
  public:
    sim::In<int> answers_in{*this, "answers_in"};
    sim::Out<int> requests_out{*this, "requests_out"};
    using Component::Component;

  private:
    Activity tick() override {
        if (asked_) return Activity::memory;
        requests_out.send(1);
        asked_ = true;
        return Activity::busy;
    }
    bool asked_ = false;
};

// Takes requests and never answers.
class Mute final : public sim::Component {
  public:
    sim::In<int> requests_in{*this, "requests_in"};
    sim::Out<int> answers_out{*this, "answers_out"};
    using Component::Component;

  private:
    Activity tick() override {
        if (requests_in.peek() == nullptr) return Activity::starved;
        requests_in.pop();
        return Activity::busy;
    }
};

TEST(Deadlock, AnAnswerThatNeverComesIsACycleOfWaits) {
    Rig rig;
    Asker asker(rig.context("asker"));
    Mute mute(rig.context("mute"));
    sim::connect(asker.requests_out, mute.requests_in, {});
    sim::connect(mute.answers_out, asker.answers_in, {});
    expect_contains(
        error_of([&] { rig.simulation.run(); }),
        "cycle of waits:\n"
        "  asker (memory) waits for a message from mute: mute.answers_out -> asker.answers_in is empty\n"
        "  mute (starved) waits for a message from asker: asker.requests_out -> mute.requests_in is empty\n");
}

TEST(Deadlock, WithoutACycleTheReportNamesTheWaits) {
    Rig rig;
    Source<int> source(rig.context("source"), {1, 2, 3});
    Sink<int> sink(rig.context("sink"), {.start = never});
    sim::connect(source.out, sink.in, {.capacity = 2});
    const std::string error = error_of([&] { rig.simulation.run(); });
    EXPECT_EQ(error.find("cycle of waits"), std::string::npos);
    expect_contains(error, "source (blocked) waits for room towards sink: source.out -> sink.in holds 2/2");
    expect_contains(error, "sink (blocked) waits for nothing that a link carries");
}

TEST(Deadlock, MessagesLeftInALinkAreOne) {
    Rig rig;
    Source<int> source(rig.context("source"), {1});
    Sink<int> sink(rig.context("sink"), {.start = never});
    sim::connect(source.out, sink.in, {.capacity = 2});
    EXPECT_THROW(rig.simulation.run(), sim::DeadlockError);
}

} // namespace core_simulation_test
