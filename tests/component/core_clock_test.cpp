// Clocks, and messages from one to another.
#include "tests/support/sim_kit.hpp"

#include "sim/check.hpp"

#include <limits>
#include <utility>

namespace core_clock_test {

using sim::Cycle;
using sim::Time;
using tests::Sink;
using tests::Source;

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

} // namespace core_clock_test
