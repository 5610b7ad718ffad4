// Clocks, the life of a run, its observer, and how it ends when it should not go on.
#include "tests/support/sim_kit.hpp"

#include "sim/check.hpp"

#include <atomic>
#include <map>
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

TEST(Clock, PeriodIsRoundedToAPicosecond) {
    EXPECT_EQ(sim::period_of_mhz(650), 1538U);
    EXPECT_EQ(sim::period_of_mhz(400), 2500U);
    EXPECT_EQ(sim::period_of_mhz(1e6), 1U);
}

TEST(Clock, CountsEdgesFromTimeZero) {
    const sim::Clock clock{"core", 1538, 0};
    EXPECT_EQ(clock.time_of(3), 4614U);
    EXPECT_EQ(clock.cycle_at(4613), 3U);
    EXPECT_EQ(clock.cycle_at(4614), 3U);
    EXPECT_EQ(clock.cycle_at(4615), 4U);
    EXPECT_EQ(clock.cycle_before(4613), 2U);
    EXPECT_EQ(clock.cycle_before(4614), 3U);
}

TEST(Clock, ImpossibleFrequenciesAreRefused) {
    sim::Simulation simulation;
    for (const double mhz : {0.0, -1.0, 1e-9, 2e6, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(simulation.add_clock("core", mhz), sim::InternalError);
}

using Crossing = std::pair<std::vector<Cycle>, std::vector<Time>>; ///< cycles sent, times received

Crossing cross(double from_mhz, double to_mhz, std::uint32_t capacity, sim::Mode mode, bool sink_first) {
    sim::Simulation simulation(1, mode);
    const sim::Clock& first = simulation.add_clock("first", sink_first ? to_mhz : from_mhz);
    const sim::Clock& second = simulation.add_clock("second", sink_first ? from_mhz : to_mhz);
    Source<int> source(simulation.context("source", sink_first ? second : first), {1, 2, 3, 4});
    Sink<int> sink(simulation.context("sink", sink_first ? first : second));
    sim::connect(source.out, sink.in, {.latency = 1, .width = 1, .capacity = capacity});
    simulation.run();
    Crossing crossing{source.cycles(), {}};
    for (const auto& arrival : sink.arrivals()) crossing.second.push_back(arrival.time);
    return crossing;
}

TEST(ClockCrossing, MessagesArriveAtTheReceiversFirstEdgeAtOrAfterTheLatency) {
    // 650 -> 400 MHz: sent at 0, 1538, 3076, 4614; on the wire until 1538, 3076, 4614, 6152.
    const Crossing down{{0, 1, 2, 3}, {2500, 5000, 7500, 10000}};
    // 400 -> 650 MHz: sent at 0, 2500, 5000, 7500; on the wire until 2500, 5000, 7500, 10000.
    const Crossing up{{0, 1, 2, 3}, {2 * 1538, 4 * 1538, 5 * 1538, 7 * 1538}};
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep})
        for (const bool sink_first : {false, true}) {
            EXPECT_EQ(cross(650, 400, 8, mode, sink_first), down);
            EXPECT_EQ(cross(400, 650, 8, mode, sink_first), up);
        }
}

TEST(ClockCrossing, RoomReturnsAtTheSendersFirstEdgeAfterTheReceive) {
    // 650 -> 400 MHz with room for one: received at 2500, so sent again at edge 2 = 3076, received at 5000, sent at
    // edge 4 = 6152, on the wire until 7690, received at 10000, sent at edge 7 = 10766.
    const Crossing down{{0, 2, 4, 7}, {2500, 5000, 10000, 12500}};
    // 1000 -> 500 MHz: the receive at 2000 and the sender's edge at 2000 coincide; the room is seen at 3000.
    const Crossing halved{{0, 3, 5, 7}, {2000, 4000, 6000, 8000}};
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep})
        for (const bool sink_first : {false, true}) {
            EXPECT_EQ(cross(650, 400, 1, mode, sink_first), down);
            EXPECT_EQ(cross(1000, 500, 1, mode, sink_first), halved);
        }
}

TEST(ClockCrossing, ASleepingClockIsWokenInTime) {
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep}) {
        sim::Simulation simulation(1, mode);
        const sim::Clock& core = simulation.add_clock("core", 650);
        const sim::Clock& memory = simulation.add_clock("memory", 400);
        Source<int> source(simulation.context("source", core), {1, 2}, {.start = 10'000, .gap = 7'000});
        tests::Responder<int, int> responder(simulation.context("memory", memory), 20, [](int i) { return -i; });
        Sink<int> sink(simulation.context("sink", core));
        sim::connect(source.out, responder.requests_in, {});
        sim::connect(responder.responses_out, sink.in, {});
        simulation.run();
        ASSERT_EQ(sink.values(), (std::vector<int>{-1, -2}));
        for (std::size_t i = 0; i < 2; ++i) {
            const Cycle taken = memory.cycle_at(core.time_of(source.cycles()[i] + 1));
            EXPECT_EQ(sink.arrivals()[i].cycle, core.cycle_at(memory.time_of(taken + 20 + 1)));
        }
    }
}

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

// Notes everything it is told.
class Notes final : public sim::Observer {
  public:
    struct Slice {
        Activity activity;
        Time begin, end;
        friend bool operator==(const Slice&, const Slice&) = default;
    };
    std::map<std::string, std::vector<Slice>> slices;
    std::vector<std::pair<Time, Time>> messages;

    void activity(const sim::Component& component, Activity activity, Time begin, Time end) override {
        slices[component.name()].push_back({activity, begin, end});
    }
    void message(const sim::ChannelBase&, Time sent, Time ready) override { messages.emplace_back(sent, ready); }
};

TEST(Observer, SeesActivitiesAndMessages) {
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep}) {
        Rig rig(mode);
        Notes notes;
        rig.simulation.set_observer(&notes);
        Source<int> source(rig.context("source"), {1, 2}, {.start = 2, .gap = 3});
        Sink<int> sink(rig.context("sink"));
        sim::connect(source.out, sink.in, {.latency = 2});
        rig.simulation.run();
        EXPECT_EQ(notes.messages, (std::vector<std::pair<Time, Time>>{{2000, 4000}, {5000, 7000}}));
        using Slices = std::vector<Notes::Slice>;
        EXPECT_EQ(notes.slices["source"], (Slices{{Activity::memory, 0, 2000},
                                                  {Activity::busy, 2000, 3000},
                                                  {Activity::memory, 3000, 5000},
                                                  {Activity::busy, 5000, 6000},
                                                  {Activity::idle, 6000, 8000}}));
        EXPECT_EQ(notes.slices["sink"], (Slices{{Activity::starved, 0, 4000},
                                                {Activity::busy, 4000, 5000},
                                                {Activity::starved, 5000, 7000},
                                                {Activity::busy, 7000, 8000}}));
    }
}

TEST(Observer, SlicesTileTheTimeOfEveryComponent) {
    Rig rig;
    Notes notes;
    rig.simulation.set_observer(&notes);
    Source<int> source(rig.context("source"), std::vector<int>(50), {.gap = 2});
    Sink<int> sink(rig.context("sink"), {.accepts = [](Cycle cycle) { return cycle % 7 < 3; }});
    sim::connect(source.out, sink.in, {.latency = 3, .capacity = 4});
    rig.simulation.run();
    for (const auto& [name, slices] : notes.slices) {
        Time end = 0;
        for (const auto& slice : slices) {
            EXPECT_EQ(slice.begin, end) << name;
            EXPECT_GT(slice.end, slice.begin) << name;
            end = slice.end;
        }
        EXPECT_EQ(end, rig.simulation.now()) << name;
    }
}

} // namespace core_simulation_test
