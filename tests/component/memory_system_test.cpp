// Crossbar and partitions together: routing, latency, bandwidth, fairness, conservation.
#include "tests/support/memory_kit.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace memory_system_test {

using pipeline::MemoryClient;
using pipeline::MemoryParams;
using pipeline::MemoryRequest;
using pipeline::MemoryResponse;
using pipeline::MemorySystem;
using sim::Cycle;
using Bench = tests::MemoryBench;
using RopClient = tests::MemoryRopClient;
using tests::reads;
using tests::small_memory;

TEST(MemorySystem, UnloadedReadTakesExactlyWhatIsStated) {
    for (const std::uint32_t bytes : {4U, 32U, 64U, 256U}) {
        Bench bench(small_memory());
        bench.add(reads(1, 512, 0, bytes));
        bench.rig.simulation.run();
        // Port, wires, way to the channel, activation and CL, whole bursts, way back, wires, port.
        EXPECT_EQ(bench.memory.unloaded_latency(bytes), 1 + 5 + 40 + 20 + std::max(bytes, 32U) / 8 + 60 + 5 + 1);
        EXPECT_EQ(bench.sinks[0]->cycles(), std::vector<Cycle>{bench.memory.unloaded_latency(bytes)});
    }
}

TEST(MemorySystem, DefaultUnloadedReadOf64BytesTakes300CyclesAt650MHz) {
    sim::Simulation simulation;
    const sim::Clock& clock = simulation.add_clock("core", 650);
    MemorySystem memory(simulation, clock, {});
    tests::Source<MemoryRequest> source(simulation.context("source", clock), reads(1, 0, 0));
    tests::Sink<MemoryResponse> sink(simulation.context("sink", clock));
    memory.attach(source.out, sink.in);
    simulation.run();
    EXPECT_EQ(sink.cycles(), std::vector<Cycle>{300});
    EXPECT_EQ(memory.unloaded_latency(64), 300U);
}

TEST(MemorySystem, RopPartitionBypassesTheCrossbar) {
    Bench bench(small_memory());
    const RopClient& rop = bench.add_rop(reads(1, 512, 0));
    bench.rig.simulation.run();
    EXPECT_FALSE(bench.memory.has_hub());
    ASSERT_EQ(rop.arrivals.size(), 1U);
    EXPECT_EQ(rop.arrivals[0].cycle + rop.arrivals[0].response.delay, bench.memory.unloaded_rop_latency(64));
    EXPECT_EQ(bench.memory.unloaded_rop_latency(64), 1 + 40 + 20 + 8 + 60 + 1U);
    EXPECT_EQ(rop.arrivals[0].response.delay, 60U); // the array was read before the way back
    EXPECT_EQ(bench.memory.partition_stats(2).requests.value, 1U);
}

TEST(MemorySystem, RopPartitionsAndTheCrossbarShareAPartitionFairly) {
    MemoryParams params = small_memory();
    params.partitions = 1;
    params.bandwidth = 8;
    Bench bench(params);
    bench.add(reads(600, 0, 64));
    for (std::uint64_t rop = 1; rop <= 3; ++rop) bench.add_rop(reads(200, rop << 20U, 64));
    bench.rig.simulation.run();
    // Half of it to the crossbar, a sixth to each ROP partition: all end at the same time.
    std::vector<Cycle> ends{bench.sinks[0]->cycles().back()};
    for (const auto& rop : bench.rops) ends.push_back(rop->arrivals.back().cycle + rop->arrivals.back().response.delay);
    const auto [first, last] = std::minmax_element(ends.begin(), ends.end());
    EXPECT_LE(*last - *first, *last / 20);
}

TEST(MemorySystem, HalfOfTheDefaultRoundTripLiesBehindTheArray) {
    sim::Simulation simulation;
    const sim::Clock& clock = simulation.add_clock("core", 650);
    MemorySystem memory(simulation, clock, {});
    RopClient rop(simulation.context("rop", clock), memory, reads(1, 0, 0));
    memory.attach_rop(0, rop.out, rop.in);
    simulation.run();
    EXPECT_EQ(rop.arrivals[0].response.delay, 129U);
    EXPECT_EQ(rop.arrivals[0].cycle + 129 + 2 * 20, 300U); // the crossbar's wires, each way, are not on its way
}

TEST(MemorySystem, BurstLargerThanAnInterleaveBlockIsRefused) {
    sim::Simulation simulation;
    MemoryParams params;
    params.controller.dram.burst_bytes = 512;
    EXPECT_THROW(MemorySystem(simulation, simulation.add_clock("core", 650), params), sim::InputError);
}

TEST(MemorySystem, BlocksOfTheInterleaveGoRound) {
    Bench bench(small_memory());
    for (std::uint64_t address = 0; address < 4096; address += 64)
        EXPECT_EQ(bench.memory.partition_of(address), address / 256 % 4);
    bench.add(reads(64, 0, 64));
    bench.rig.simulation.run();
    for (std::uint32_t partition = 0; partition < 4; ++partition)
        EXPECT_EQ(bench.memory.partition_stats(partition).requests.value, 16U);
}

TEST(MemorySystem, EveryReadIsAnsweredOnceToItsClientWithItsTag) {
    Bench bench(small_memory());
    bench.add(reads(200, 0, 64));
    bench.add(reads(100, 1U << 16U, 256 * 4));
    bench.add(reads(150, 1U << 20U, 96, 32));
    const RopClient& rop = bench.add_rop(reads(50, 0, 64));
    bench.rig.simulation.run();
    const std::vector<std::size_t> counts{200, 100, 150};
    for (std::size_t client = 0; client < counts.size(); ++client) {
        std::vector<std::uint32_t> tags = bench.tags(client);
        std::sort(tags.begin(), tags.end());
        ASSERT_EQ(tags.size(), counts[client]);
        for (std::uint32_t i = 0; i < tags.size(); ++i) EXPECT_EQ(tags[i], 1000 + i);
    }
    EXPECT_EQ(rop.arrivals.size(), 50U);
    EXPECT_EQ(bench.memory.hub_stats().requests.value, 450U);
    EXPECT_EQ(bench.memory.hub_stats().responses.value, 450U);
    EXPECT_EQ(bench.memory.controller_stats().requests.value, 500U);
}

TEST(MemorySystem, BandwidthIsAHardLimit) {
    Bench bench(small_memory());
    bench.add(reads(4000, 0, 64));
    bench.add(reads(4000, 1U << 20U, 64));
    bench.rig.simulation.run();
    const double bytes = 8000.0 * 64;
    const double cycles = static_cast<double>(bench.rig.cycles());
    EXPECT_LE(bytes / cycles, 32.0);
    EXPECT_GE(bytes / cycles, 31.0);
}

TEST(MemorySystem, OnePartitionAloneGivesItsShare) {
    Bench bench(small_memory());
    bench.add(reads(1000, 0, 1024));
    bench.rig.simulation.run();
    const std::vector<Cycle> cycles = bench.sinks[0]->cycles();
    EXPECT_EQ(cycles.back() - cycles.front(), 999U * 8);
}

TEST(MemorySystem, ClientsOfOnePartitionTakeTurns) {
    Bench bench(small_memory());
    for (int client = 0; client < 5; ++client) bench.add(reads(100, 0, 0)); // all the same address
    bench.rig.simulation.run();
    std::vector<Cycle> half_way;
    for (const auto& sink : bench.sinks) half_way.push_back(sink->cycles()[49]);
    const auto [first, last] = std::minmax_element(half_way.begin(), half_way.end());
    EXPECT_LE(*last - *first, 5U * 8);
    EXPECT_GT(bench.memory.hub_stats().conflicts.value, 300U);
}

TEST(MemorySystem, OneRequestPerCycleLeavesAClient) {
    MemoryParams params = small_memory();
    params.bandwidth = 4000; // not the limit
    params.controller.dram.rp_ns = 0;
    Bench bench(params);
    bench.add(reads(400, 0, 256));
    bench.rig.simulation.run();
    const std::vector<Cycle> cycles = bench.sinks[0]->cycles();
    EXPECT_EQ(cycles.back() - cycles.front(), 399U);
}

TEST(MemorySystem, ClientThatTakesItsTimeStillGetsEverything) {
    Bench bench(small_memory());
    bench.add(reads(300, 0, 64), {.every = 17});
    bench.add(reads(300, 1U << 16U, 64));
    bench.rig.simulation.run();
    EXPECT_EQ(bench.sinks[0]->size(), 300U);
    EXPECT_EQ(bench.sinks[1]->size(), 300U);
}

TEST(MemorySystem, FewReadsInFlightAreEnoughToFinish) {
    MemoryParams params = small_memory();
    params.hub.reads_in_flight = 64;
    Bench bench(params);
    for (std::uint64_t client = 0; client < 4; ++client) bench.add(reads(200, client << 20U, 64));
    bench.rig.simulation.run();
    for (const auto& sink : bench.sinks) EXPECT_EQ(sink->size(), 200U);
    EXPECT_LE(bench.memory.hub_stats().reads_in_flight.value, 64U);
}

TEST(MemorySystem, BytesByDrawAddUpToBytesByClient) {
    Bench bench(small_memory());
    bench.add(reads(300, 0, 64));
    bench.rig.simulation.run();
    const auto vertex = static_cast<std::size_t>(MemoryClient::vertex);
    std::uint64_t sum = 0;
    for (std::uint32_t draw = 0; draw < 3; ++draw) sum += bench.memory.draw_bytes(draw)[vertex];
    EXPECT_EQ(sum, 300U * 64);
    EXPECT_EQ(bench.memory.controller_stats().bytes[vertex].value, 300U * 64);
    EXPECT_EQ(bench.memory.draw_bytes(7)[vertex], 0U);
}

TEST(MemorySystem, RequestAcrossAnInterleaveBlockIsOurBug) {
    Bench bench(small_memory());
    bench.add(reads(1, 224, 0, 64));
    EXPECT_THROW(bench.rig.simulation.run(), sim::InternalError);
}

TEST(MemorySystem, PartitionsMayHaveTheirOwnClock) {
    MemoryParams params = small_memory();
    params.clock_mhz = 800;
    Bench bench(params);
    bench.add(reads(2000, 0, 64));
    bench.rig.simulation.run();
    EXPECT_EQ(bench.sinks[0]->size(), 2000U);
    EXPECT_LE(2000.0 * 64 / static_cast<double>(bench.rig.simulation.now()) * 1000, 32.0); // GB/s
    EXPECT_GE(2000.0 * 64 / static_cast<double>(bench.rig.simulation.now()) * 1000, 30.0);
}

TEST(MemorySystem, ReportHoldsTheHubOnlyWhenItIsBuilt) {
    Bench without(small_memory());
    EXPECT_FALSE(without.memory.report().contains("memory_hub"));
    Bench with(small_memory());
    with.add(reads(10, 0, 64));
    with.rig.simulation.run();
    const nlohmann::ordered_json report = with.memory.report();
    EXPECT_EQ(report["memory_hub"]["counters"]["requests"], 10);
    EXPECT_EQ(report["memory_partition"]["counters"]["reads"], 10);
    std::uint64_t cycles = 0;
    for (const auto& [name, value] : report["memory_partition"]["activity"].items()) cycles += value.get<Cycle>();
    EXPECT_EQ(cycles, 4 * with.rig.cycles());
}

TEST(MemorySystem, SameInAllModes) {
    tests::expect_same_in_all_modes([](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        MemoryParams params = small_memory();
        params.controller.jitter_cycles = 7;
        Bench bench(params, mode, shuffle);
        bench.add(reads(200, 0, 64), {.every = 3});
        bench.add(reads(200, 1U << 16U, 32, 32));
        bench.add(reads(200, 1U << 20U, 1024));
        RopClient& rop = bench.add_rop(reads(80, 0, 64));
        bench.rig.simulation.run();
        std::vector<std::vector<Cycle>> all;
        for (const auto& sink : bench.sinks) all.push_back(sink->cycles());
        for (const RopClient::Arrival& arrival : rop.arrivals) all.push_back({arrival.cycle, arrival.response.delay});
        return all;
    });
}

} // namespace memory_system_test
