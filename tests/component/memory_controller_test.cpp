// A memory partition between sources and sinks: latency, bandwidth, fairness, back-pressure, conservation.
#include "pipeline/memory/memory_controller.hpp"
#include "tests/support/sim_kit.hpp"

#include <numeric>

namespace memory_controller_test {

using pipeline::MemoryClient;
using pipeline::MemoryController;
using pipeline::MemoryControllerParams;
using pipeline::MemoryRequest;
using pipeline::MemoryResponse;
using sim::Cycle;
using tests::Rig;

// At 1 GHz: 8 bytes per cycle.
constexpr MemoryController::Share share{.partitions = 1, .interleave = 256, .bandwidth = 8.0};
// A closed row costs 20 cycles in front of the transfer, 8 of them CL or WL; the bus turns for nothing but CL.
constexpr MemoryControllerParams params{.queue = 16,
                                        .write_queue = 16,
                                        .return_latency = 100,
                                        .jitter_cycles = 0,
                                        .dram = {.rcd_read_ns = 12,
                                                 .rcd_write_ns = 12,
                                                 .cl_ns = 8,
                                                 .wl_ns = 8,
                                                 .rp_ns = 0,
                                                 .ras_ns = 0,
                                                 .wr_ns = 0,
                                                 .rrd_ns = 0,
                                                 .faw_ns = 0,
                                                 .rtw_ns = 0,
                                                 .wtr_ns = 0,
                                                 .refi_ns = 0,
                                                 .row_bytes = 2048,
                                                 .banks = 4}};

std::vector<MemoryRequest> stream(std::uint32_t count, bool write = false, std::uint64_t address = 0,
                                  std::uint32_t bytes = 64) {
    std::vector<MemoryRequest> requests;
    for (std::uint32_t i = 0; i < count; ++i)
        requests.push_back({address + std::uint64_t{i} * bytes, bytes, i, 0, MemoryClient::texture, write});
    return requests;
}

struct Bench {
    Rig rig;
    MemoryController controller;
    MemoryController::RopPort& rop_port;
    tests::Source<MemoryRequest> hub, rop;
    tests::Sink<MemoryResponse> hub_sink, rop_sink;

    Bench(const MemoryControllerParams& with, std::vector<MemoryRequest> from_hub, std::vector<MemoryRequest> from_rop,
          sim::Mode mode = sim::Mode::normal, std::uint64_t seed = 1, tests::SinkOptions sink = {})
        : rig(mode, seed, seed),
          controller(rig.context("controller"), with, share),
          rop_port(controller.add_rop()),
          hub(rig.context("hub"), std::move(from_hub)),
          rop(rig.context("rop"), std::move(from_rop)),
          hub_sink(rig.context("hub_sink"), sink),
          rop_sink(rig.context("rop_sink")) {
        sim::connect(hub.out, controller.hub_in, {.capacity = 4});
        sim::connect(rop.out, rop_port.requests_in, {.capacity = 4});
        sim::connect(controller.hub_out, hub_sink.in, {});
        sim::connect(rop_port.responses_out, rop_sink.in, {});
        rig.simulation.run();
    }
};

TEST(MemoryController, LoneReadIsAnsweredAtItsUnloadedLatencyAndNotBefore) {
    const Bench bench(params, stream(1), {});
    // Received at cycle 1; activation and CL 20, transfer 8, return 100; one cycle back.
    EXPECT_EQ(bench.controller.unloaded_latency(64), 128U);
    EXPECT_EQ(bench.hub_sink.cycles(), std::vector<Cycle>{1 + 128 + 1});
    EXPECT_EQ(bench.hub_sink.values().front().tag, 0U);
}

TEST(MemoryController, RopReadIsAnsweredWhenItsBurstHasCrossedTheBusWithTheTimeThatTheDataStillTake) {
    const Bench bench(params, {}, stream(1));
    EXPECT_EQ(bench.rop_sink.cycles(), std::vector<Cycle>{1 + 28 + 1});
    EXPECT_EQ(bench.rop_sink.values().front().delay, 100U);
    EXPECT_EQ(bench.hub_sink.size(), 0U);
}

TEST(MemoryController, DataOfOneRopPortComeBackInTheOrderOfTheirBursts) {
    MemoryControllerParams jittery = params;
    jittery.jitter_cycles = 50;
    const Bench bench(jittery, {}, stream(300));
    Cycle last = 0;
    for (const auto& arrival : bench.rop_sink.arrivals()) {
        EXPECT_GE(arrival.cycle + arrival.value.delay, last);
        last = arrival.cycle + arrival.value.delay;
    }
    EXPECT_EQ(bench.rop_sink.size(), 300U);
}

TEST(MemoryController, WriteThatAsksForItIsAnsweredWhenTheArrayHasTakenIt) {
    std::vector<MemoryRequest> requests = stream(3, true);
    requests[1].notify = true;
    const Bench bench(params, {}, requests);
    ASSERT_EQ(bench.rop_sink.size(), 1U);
    EXPECT_EQ(bench.rop_sink.values().front().tag, 1U);
    EXPECT_EQ(bench.rop_sink.values().front().delay, 0U);
    EXPECT_EQ(bench.rop_sink.cycles(), std::vector<Cycle>{1 + 20 + 2 * 8 + 1});
}

TEST(MemoryController, RequestsToOneAddressAreDoneInTheirOrder) {
    // Reads and writes of one line between traffic to other rows: what a read finds is what was written before it.
    std::vector<MemoryRequest> requests;
    for (std::uint32_t i = 0; i < 600; ++i) {
        const std::uint64_t address = i % 3 == 0 ? 64 : std::uint64_t{2048} * (1 + i % 7);
        requests.push_back({address, 64, i, 0, MemoryClient::kbuffer_read, i % 6 < 3, true});
    }
    const Bench bench(params, {}, requests);
    ASSERT_EQ(bench.rop_sink.size(), 600U);
    std::uint32_t last = 0;
    for (const MemoryResponse& response : bench.rop_sink.values()) {
        if (response.tag % 3 != 0) continue;
        EXPECT_GE(response.tag, last);
        last = response.tag;
    }
}

TEST(MemoryController, SustainedReadsMoveExactlyTheBandwidth) {
    const Bench bench(params, stream(1000), {});
    const std::vector<Cycle> cycles = bench.hub_sink.cycles();
    ASSERT_EQ(cycles.size(), 1000U);
    EXPECT_EQ(cycles.back() - cycles.front(), 999U * 64 / 8); // rows change in other banks, hidden
    EXPECT_EQ(bench.controller.stats().row_misses.value, 1000U * 64 / 2048 + 1);
}

TEST(MemoryController, SmallRequestsMoveWholeBursts) {
    const Bench bench(params, stream(512, false, 0, 16), stream(512, true, 16384, 16));
    EXPECT_GE(bench.rig.cycles(), 1024U * 32 / 8);
    EXPECT_EQ(bench.controller.stats().requests.value, 1024U);
    EXPECT_EQ(bench.controller.stats().bytes[static_cast<std::size_t>(MemoryClient::texture)].value, 1024U * 32);
}

TEST(MemoryController, TwoPortsShareTheBandwidthFairly) {
    const Bench bench(params, stream(200), stream(200, false, 1U << 20U));
    const auto half_way = [&](const tests::Sink<MemoryResponse>& sink) { return sink.cycles()[99]; };
    // The ROP hears of its reads when they cross the bus, the crossbar when the data are back.
    EXPECT_NEAR(static_cast<double>(half_way(bench.hub_sink)), static_cast<double>(half_way(bench.rop_sink) + 100), 64);
}

TEST(MemoryController, AnswersComeInOrder) {
    MemoryControllerParams jittery = params;
    jittery.jitter_cycles = 50;
    const Bench bench(jittery, stream(300), {});
    std::vector<std::uint32_t> tags;
    for (const MemoryResponse& response : bench.hub_sink.values()) tags.push_back(response.tag);
    std::vector<std::uint32_t> expected(300);
    std::iota(expected.begin(), expected.end(), 0U);
    EXPECT_EQ(tags, expected);
}

TEST(MemoryController, JitterFollowsTheSeedAndStaysWithinItsBound) {
    MemoryControllerParams jittery = params;
    jittery.jitter_cycles = 50;
    std::set<Cycle> seen;
    for (std::uint64_t seed = 1; seed <= 32; ++seed) {
        const Bench first(jittery, stream(1), {}, sim::Mode::normal, seed);
        const Bench second(jittery, stream(1), {}, sim::Mode::normal, seed);
        EXPECT_EQ(first.hub_sink.cycles(), second.hub_sink.cycles());
        const Cycle arrival = first.hub_sink.cycles().front();
        EXPECT_GE(arrival, 130U);
        EXPECT_LE(arrival, 180U);
        seen.insert(arrival);
    }
    EXPECT_GT(seen.size(), 10U);
}

TEST(MemoryController, WritesAreNotAnsweredAndKeepTheUnitAtWorkUntilTransferred) {
    const Bench bench(params, stream(10, true), {});
    EXPECT_EQ(bench.hub_sink.size(), 0U);
    EXPECT_EQ(bench.rig.cycles(), 1U + 20 + 10 * 8);
    EXPECT_EQ(bench.controller.stats().writes.value, 10U);
}

TEST(MemoryController, QueueOfOneServesOneTransferAtATime) {
    MemoryControllerParams narrow = params;
    narrow.queue = 1;
    const Bench bench(narrow, stream(20), {});
    EXPECT_EQ(bench.controller.stats().queued.value, 1U);
    EXPECT_EQ(bench.hub_sink.size(), 20U);
    EXPECT_EQ(bench.hub_sink.cycles().back(), 130U + 19 * 9); // each waits for the one before it, then for CL
}

TEST(MemoryController, SlowReceiverLosesNothing) {
    const Bench bench(params, stream(100), stream(50), sim::Mode::normal, 1, {.every = 20});
    EXPECT_EQ(bench.hub_sink.size(), 100U);
    EXPECT_EQ(bench.rop_sink.size(), 50U);
    EXPECT_EQ(bench.rop_sink.cycles().front(), 30U + 8); // not held up by the answers of the other port
}

TEST(MemoryController, BytesAreBookedByClientAndDraw) {
    std::vector<MemoryRequest> requests = stream(3);
    requests[1].client = MemoryClient::tile_write;
    requests[1].write = true;
    requests[2].draw = 5;
    const Bench bench(params, requests, {});
    const auto& stats = bench.controller.stats();
    EXPECT_EQ(stats.reads + stats.writes, stats.requests.value);
    EXPECT_EQ(stats.row_hits + stats.row_misses, stats.requests.value);
    EXPECT_EQ(stats.bytes[static_cast<std::size_t>(MemoryClient::texture)].value, 128U);
    EXPECT_EQ(stats.bytes[static_cast<std::size_t>(MemoryClient::tile_write)].value, 64U);
    const auto& draws = bench.controller.draw_bytes();
    ASSERT_EQ(draws.size(), 6U);
    EXPECT_EQ(draws[0][static_cast<std::size_t>(MemoryClient::texture)], 64U);
    EXPECT_EQ(draws[5][static_cast<std::size_t>(MemoryClient::texture)], 64U);
}

TEST(MemoryController, FullQueueOfWritesDoesNotHoldUpReadsOfTheOtherPort) {
    MemoryControllerParams gathering = params;
    gathering.dram.write_batch = 1000;
    gathering.dram.read_batch = 1000;
    const Bench bench(gathering, stream(200), stream(100, true, 1U << 20U));
    EXPECT_EQ(bench.controller.stats().writes.value, 100U);
    // Reads go first but for batches of a full queue of writes.
    EXPECT_LE(bench.hub_sink.cycles().back(), 130U + 300 * 8 + 20 * bench.controller.stats().turnarounds.value);
}

TEST(MemoryController, EventsOfTheChannelAreCounted) {
    MemoryControllerParams real = params;
    real.dram = {};
    const Bench bench(real, stream(2000), stream(2000, true, 1U << 20U));
    const auto& stats = bench.controller.stats();
    // 4000 * 64 B at 8 GB/s take 32 us, and the turns: a refresh each 3.9 us.
    EXPECT_NEAR(static_cast<double>(stats.refreshes.value), static_cast<double>(bench.rig.cycles()) / 3900, 1);
    EXPECT_GT(stats.turnarounds.value, 50U);
    EXPECT_LT(stats.turnarounds.value, 300U);
    EXPECT_EQ(stats.row_hits + stats.row_misses, stats.requests.value);
}

TEST(MemoryController, ActivitiesSumToTheElapsedTime) {
    const Bench bench(params, stream(100), stream(100, true));
    sim::Time sum = 0;
    for (const sim::Time time : bench.controller.activity_times()) sum += time;
    EXPECT_EQ(sum, bench.rig.simulation.now());
}

TEST(MemoryController, SameInAllModes) {
    MemoryControllerParams jittery = params;
    jittery.jitter_cycles = 9;
    tests::expect_same_in_all_modes([&](std::uint64_t seed, sim::Mode mode, std::uint64_t) {
        const Bench bench(jittery, stream(100, false, 0, 48), stream(60), mode, seed, {.every = 3});
        return std::pair{bench.hub_sink.cycles(), bench.rop_sink.cycles()};
    });
}

} // namespace memory_controller_test
