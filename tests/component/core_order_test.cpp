// Nothing observable depends on the order of ticks within an instant, nor on who sleeps; and these tests would notice.
#include "tests/support/sim_network.hpp"

#include <numeric>

namespace core_order_test {

using tests::Network;
using tests::Observed;
using tests::Token;

Observed run_network(std::uint64_t seed, sim::Mode mode, std::uint64_t shuffle_seed) {
    return Network(seed, mode, shuffle_seed).run();
}

TEST(Order, RandomNetworksGiveTheSameInAllModes) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        tests::expect_same_in_all_modes(run_network, seed, 2);
        if (HasFailure()) return;
    }
}

TEST(Order, RandomNetworksGiveTheSameInAllModesLong) {
    for (std::uint64_t seed = 1000; seed <= 5000; ++seed) {
        tests::expect_same_in_all_modes(run_network, seed, 3);
        if (HasFailure()) return;
    }
}

TEST(Order, RandomNetworksDeliverAndEnd) {
    std::size_t arrivals = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const Observed observed = run_network(seed, sim::Mode::normal, 1);
        EXPECT_EQ(observed.error, "") << "seed " << seed;
        for (const auto& sink : observed.arrivals) arrivals += sink.size();
    }
    EXPECT_GT(arrivals, 10'000U); // the networks do something
}

TEST(Order, ActivitySumsEqualElapsedTime) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed)
        for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep}) {
            const Observed observed = run_network(seed, mode, 1);
            for (const sim::ActivityTimes& times : observed.activities)
                EXPECT_EQ(std::accumulate(times.begin(), times.end(), sim::Time{0}), observed.end);
        }
}

// Holds a message for some cycles, and forgets to ask for the tick at which it is due.
class Forgetful final : public sim::Component {
  public:
    sim::In<Token> in{*this, "in"};
    sim::Out<Token> out{*this, "out"};
    using Component::Component;

  private:
    sim::Activity tick() override {
        if (!holds_) {
            if (in.peek() == nullptr) return sim::Activity::starved;
            held_ = in.receive();
            due_ = cycle() + 5;
            holds_ = true;
            return sim::Activity::busy;
        }
        if (cycle() < due_ || !out.ready()) return sim::Activity::memory;
        out.send(held_);
        holds_ = false;
        return sim::Activity::busy;
    }
    bool holds_ = false;
    Token held_ = 0;
    sim::Cycle due_ = 0;
};

TEST(Order, NeverSleepCatchesALostWakeUp) {
    const auto run = [](sim::Mode mode) {
        Network network(7, mode, 1);
        auto& forgetful = network.add<Forgetful>("forgetful");
        network.link(*network.open_ends.front(), forgetful.in);
        network.open_ends.front() = &forgetful.out;
        return network.run();
    };
    EXPECT_NE(run(sim::Mode::never_sleep), run(sim::Mode::normal));
}

// Talks to each other without a channel.
struct Blackboard {
    Token written = 0;
};

class Writer final : public sim::Component {
  public:
    Writer(sim::Context context, Blackboard& board) : Component(std::move(context)), board_(board) {}

  private:
    sim::Activity tick() override {
        if (cycle() >= 200) return sim::Activity::idle;
        ++board_.written;
        return sim::Activity::busy;
    }
    Blackboard& board_;
};

class Reader final : public sim::Component {
  public:
    sim::Out<Token> out{*this, "out"};
    Reader(sim::Context context, const Blackboard& board) : Component(std::move(context)), board_(board) {}

  private:
    sim::Activity tick() override {
        if (cycle() >= 200) return sim::Activity::idle;
        if (out.ready()) out.send(board_.written);
        return sim::Activity::busy;
    }
    const Blackboard& board_;
};

TEST(Order, ShufflingCatchesAHiddenLink) {
    const auto run = [](sim::Mode mode) {
        tests::Rig rig(mode);
        Blackboard board;
        Writer writer(rig.context("writer"), board);
        Reader reader(rig.context("reader"), board);
        tests::Sink<Token> sink(rig.context("sink"));
        sim::connect(reader.out, sink.in, {});
        rig.simulation.run();
        return sink.values();
    };
    EXPECT_EQ(run(sim::Mode::never_sleep), run(sim::Mode::normal));
    EXPECT_NE(run(sim::Mode::shuffled), run(sim::Mode::normal));
}

TEST(Order, SleepingSavesTicks) {
    const auto ticks = [](sim::Mode mode) {
        tests::Rig rig(mode);
        tests::Source<int> source(rig.context("source"), {1, 2, 3}, {.gap = 1000});
        tests::Sink<int> sink(rig.context("sink"));
        sim::connect(source.out, sink.in, {});
        rig.simulation.run();
        return rig.simulation.ticks();
    };
    EXPECT_LE(ticks(sim::Mode::normal), 13U);
    EXPECT_GE(ticks(sim::Mode::never_sleep), 4000U);
}

} // namespace core_order_test
