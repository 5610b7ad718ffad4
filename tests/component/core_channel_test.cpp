// The laws of a channel: latency, width, capacity, credits, throughput.
#include "tests/support/sim_kit.hpp"

#include "sim/check.hpp"

namespace core_channel_test {

using sim::Cycle;
using Cycles = std::vector<Cycle>;
using tests::never;
using tests::Rig;
using tests::Sink;
using tests::Source;

std::vector<int> numbers(int count) {
    std::vector<int> list;
    for (int i = 0; i < count; ++i) list.push_back(i);
    return list;
}

// Looks at its input at every edge and notes what it sees; takes nothing.
class Watcher final : public sim::Component {
  public:
    sim::In<int> in{*this, "in"};
    Cycles seen, unseen;

    Watcher(sim::Context context, Cycle until) : Component(std::move(context)), until_(until) {}

  private:
    sim::Activity tick() override {
        if (cycle() > until_) return sim::Activity::starved;
        (in.peek() != nullptr ? seen : unseen).push_back(cycle());
        if (cycle() < until_) return sim::Activity::busy;
        while (in.peek() != nullptr) in.pop();
        return sim::Activity::starved;
    }
    Cycle until_;
};

TEST(Channel, MessageIsNotReceivableOneCycleBeforeItsLatencyAndIsAtIt) {
    for (const Cycle latency : {1U, 2U, 7U, 64U, 1023U, 1024U, 1025U, 5000U}) {
        Rig rig;
        Source<int> source(rig.context("source"), {42}, {.start = 3});
        Watcher watcher(rig.context("watcher"), 3 + latency);
        sim::connect(source.out, watcher.in, {.latency = latency});
        rig.simulation.run();
        EXPECT_EQ(watcher.unseen.back(), 3 + latency - 1);
        EXPECT_EQ(watcher.seen, Cycles{3 + latency});
    }
}

TEST(Channel, SleepingReceiverIsWokenAtTheLatency) {
    for (const Cycle latency : {1U, 2U, 7U, 64U, 1023U, 1024U, 1025U, 5000U}) {
        Rig rig;
        Source<int> source(rig.context("source"), {42}, {.start = 3});
        Sink<int> sink(rig.context("sink"));
        sim::connect(source.out, sink.in, {.latency = latency});
        rig.simulation.run();
        EXPECT_EQ(sink.cycles(), Cycles{3 + latency});
    }
}

TEST(Channel, WidthLimitsWhatEntersPerEdge) {
    Rig rig;
    Source<int> source(rig.context("source"), numbers(7));
    Sink<int> sink(rig.context("sink"));
    sim::connect(source.out, sink.in, {.latency = 1, .width = 3, .capacity = 100});
    rig.simulation.run();
    EXPECT_EQ(source.cycles(), (Cycles{0, 0, 0, 1, 1, 1, 2}));
    EXPECT_EQ(sink.cycles(), (Cycles{1, 1, 1, 2, 2, 2, 3}));
    EXPECT_EQ(sink.values(), numbers(7));
}

TEST(Channel, WidthLimitsWhatLeavesPerEdge) {
    Rig rig;
    Source<int> source(rig.context("source"), numbers(6));
    Sink<int> sink(rig.context("sink"), {.start = 10});
    sim::connect(source.out, sink.in, {.latency = 1, .width = 2, .capacity = 100});
    rig.simulation.run();
    EXPECT_EQ(sink.cycles(), (Cycles{10, 10, 11, 11, 12, 12}));
}

TEST(Channel, CapacityCountsMessagesInFlight) {
    Rig rig;
    Source<int> source(rig.context("source"), numbers(5));
    Sink<int> sink(rig.context("sink"));
    sim::connect(source.out, sink.in, {.latency = 10, .width = 1, .capacity = 3});
    rig.simulation.run();
    // The room of the message received at 10 is back at 11.
    EXPECT_EQ(source.cycles(), (Cycles{0, 1, 2, 11, 12}));
    EXPECT_EQ(sink.cycles(), (Cycles{10, 11, 12, 21, 22}));
}

TEST(Channel, RoomReturnsAtTheNextEdgeWhicheverTicksFirst) {
    const auto cycles_sent = [](bool sink_first) {
        Rig rig;
        auto first = sink_first ? std::make_unique<Sink<int>>(rig.context("sink")) : nullptr;
        Source<int> source(rig.context("source"), numbers(4));
        if (!first) first = std::make_unique<Sink<int>>(rig.context("sink"));
        sim::connect(source.out, first->in, {.latency = 1, .width = 1, .capacity = 1});
        rig.simulation.run();
        return source.cycles();
    };
    EXPECT_EQ(cycles_sent(false), (Cycles{0, 2, 4, 6}));
    EXPECT_EQ(cycles_sent(true), (Cycles{0, 2, 4, 6}));
}

TEST(Channel, FullThroughputNeedsCapacityOfWidthTimesLatencyPlusOne) {
    for (const std::uint32_t width : {1U, 2U, 5U})
        for (const Cycle latency : {1U, 2U, 3U, 9U}) {
            const int count = 1000;
            const auto finish = [&](std::uint32_t capacity) {
                Rig rig;
                Source<int> source(rig.context("source"), numbers(count));
                Sink<int> sink(rig.context("sink"));
                sim::connect(source.out, sink.in, {.latency = latency, .width = width, .capacity = capacity});
                rig.simulation.run();
                return sink.cycles().back();
            };
            const auto enough = static_cast<std::uint32_t>(width * (latency + 1));
            const Cycle ideal = (count + width - 1) / width - 1 + latency;
            EXPECT_EQ(finish(enough), ideal);
            EXPECT_EQ(finish(0), ideal) << "the default capacity";
            EXPECT_GT(finish(enough - 1), ideal);
        }
}

// Sends without asking whether there is room.
class Careless final : public sim::Component {
  public:
    sim::Out<int> out{*this, "out"};
    Careless(sim::Context context, int count) : Component(std::move(context)), count_(count) {}

  private:
    sim::Activity tick() override {
        for (; count_ > 0; --count_) out.send(count_);
        return sim::Activity::idle;
    }
    int count_;
};

std::string error_of_sending(int count, sim::ChannelConfig config) {
    Rig rig;
    Careless careless(rig.context("careless"), count);
    Sink<int> sink(rig.context("sink"));
    sim::connect(careless.out, sink.in, config);
    try {
        rig.simulation.run();
    } catch (const sim::InternalError& error) {
        return error.what();
    }
    return {};
}

TEST(Channel, SendingMoreThanTheWidthIsRefused) {
    EXPECT_EQ(error_of_sending(2, {.width = 2, .capacity = 8}), "");
    EXPECT_NE(error_of_sending(3, {.width = 2, .capacity = 8}).find("careless.out -> sink.in"), std::string::npos);
}

TEST(Channel, SendingIntoAFullChannelIsRefused) {
    EXPECT_EQ(error_of_sending(2, {.width = 8, .capacity = 2}), "");
    const std::string error = error_of_sending(3, {.width = 8, .capacity = 2});
    EXPECT_NE(error.find("in careless at 0 ps"), std::string::npos) << error;
}

// Takes more than peek() offers.
class Greedy final : public sim::Component {
  public:
    sim::In<int> in{*this, "in"};
    using Component::Component;

  private:
    sim::Activity tick() override {
        if (in.peek() == nullptr) return sim::Activity::starved;
        for (int i = 0; i < 3; ++i) in.pop();
        return sim::Activity::busy;
    }
};

TEST(Channel, PoppingWhatPeekDoesNotOfferIsRefused) {
    Rig rig;
    Source<int> source(rig.context("source"), numbers(3));
    Greedy greedy(rig.context("greedy"));
    sim::connect(source.out, greedy.in, {.width = 2, .capacity = 8});
    EXPECT_THROW(rig.simulation.run(), sim::InternalError);
}

TEST(Channel, ImpossibleLinksAreRefused) {
    Rig rig;
    Source<int> source(rig.context("source"), {});
    Sink<int> sink(rig.context("sink"));
    EXPECT_THROW(sim::connect(source.out, sink.in, {.latency = 0}), sim::InternalError);
    EXPECT_THROW(sim::connect(source.out, sink.in, {.width = 0}), sim::InternalError);
    EXPECT_THROW(sim::connect(source.out, sink.in, {.latency = Cycle{1} << 40U}), sim::InternalError);
    EXPECT_TRUE(rig.simulation.channels().empty());
    EXPECT_TRUE(source.outputs().empty());
    sim::connect(source.out, sink.in, {});
    EXPECT_THROW(sim::connect(source.out, sink.in, {}), sim::InternalError);
}

TEST(Channel, UsingAnUnlinkedPortIsRefused) {
    Rig rig;
    Sink<int> sink(rig.context("sink"));
    EXPECT_FALSE(sink.in.connected());
    try {
        rig.simulation.run();
        FAIL();
    } catch (const sim::InternalError& error) {
        EXPECT_NE(std::string(error.what()).find("sink.in is not linked"), std::string::npos) << error.what();
    }
}

TEST(Channel, CountsWhatPassed) {
    Rig rig;
    Source<int> source(rig.context("source"), numbers(9));
    Sink<int> sink(rig.context("sink"));
    const auto& link = sim::connect(source.out, sink.in, {});
    EXPECT_EQ(link.name(), "source.out -> sink.in");
    rig.simulation.run();
    EXPECT_EQ(link.sent(), 9U);
    EXPECT_EQ(link.received(), 9U);
    EXPECT_TRUE(link.empty());
    EXPECT_TRUE(sink.in.drained());
}

} // namespace core_channel_test
