// Crossbar and partitions together: routing, latency, bandwidth, fairness, conservation.
#include "pipeline/memory/memory_system.hpp"
#include "tests/support/sim_kit.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

namespace memory_system_test {

using pipeline::MemoryClient;
using pipeline::MemoryParams;
using pipeline::MemoryRequest;
using pipeline::MemoryResponse;
using pipeline::MemorySystem;
using sim::Cycle;
using tests::Rig;

// At 1 GHz: 8 bytes per cycle and partition.
MemoryParams small_memory() {
    MemoryParams params;
    params.partitions = 4;
    params.bandwidth = 32;
    params.hub.latency = 5;
    params.controller.request_latency = 40;
    params.controller.return_latency = 60;
    params.controller.dram = {.rcd_read_ns = 12,
                              .rcd_write_ns = 12,
                              .cl_ns = 8,
                              .wl_ns = 8,
                              .rp_ns = 12,
                              .ras_ns = 0,
                              .wr_ns = 0,
                              .rrd_ns = 0,
                              .faw_ns = 0,
                              .rtw_ns = 0,
                              .wtr_ns = 0,
                              .refi_ns = 0,
                              .row_bytes = 2048,
                              .banks = 8};
    return params;
}

std::vector<MemoryRequest> reads(std::uint32_t count, std::uint64_t address, std::uint64_t step,
                                 std::uint32_t bytes = 64) {
    std::vector<MemoryRequest> requests;
    for (std::uint32_t i = 0; i < count; ++i)
        requests.push_back({address + i * step, bytes, 1000 + i, i % 3, MemoryClient::vertex, false});
    return requests;
}

/// Sends requests, in order, to the memory partitions that hold their addresses, and notes every answer.
class RopClient final : public sim::Component {
  public:
    std::vector<sim::Out<MemoryRequest>> out;
    std::vector<sim::In<MemoryResponse>> in;
    struct Arrival {
        MemoryResponse response;
        Cycle cycle;
    };
    std::vector<Arrival> arrivals;

    RopClient(sim::Context context, const MemorySystem& memory, std::vector<MemoryRequest> requests)
        : Component(std::move(context)), memory_(memory), requests_(std::move(requests)) {
        for (const MemoryRequest& request : requests_) answers_ += !request.write || request.notify ? 1 : 0;
        for (std::uint32_t i = 0; i < memory.partitions(); ++i) {
            out.emplace_back(*this, "out");
            in.emplace_back(*this, "in");
        }
    }

  private:
    sim::Activity tick() override {
        bool progress = false;
        for (auto& port : in)
            for (; port.peek() != nullptr; progress = true) arrivals.push_back({port.receive(), cycle()});
        for (; sent_ < requests_.size(); ++sent_, progress = true) {
            auto& port = out[memory_.partition_of(requests_[sent_].address)];
            if (!port.ready()) break;
            port.send(requests_[sent_]);
        }
        if (progress) return sim::Activity::busy;
        if (sent_ < requests_.size()) return sim::Activity::blocked;
        return arrivals.size() < answers_ ? sim::Activity::memory : sim::Activity::starved;
    }

    const MemorySystem& memory_;
    std::vector<MemoryRequest> requests_;
    std::size_t sent_ = 0, answers_ = 0;
};

class Bench {
  public:
    explicit Bench(const MemoryParams& params, sim::Mode mode = sim::Mode::normal, std::uint64_t shuffle = 1)
        : rig(mode, 1, shuffle), memory(rig.simulation, rig.clock, params) {}

    void add(std::vector<MemoryRequest> requests, tests::SinkOptions sink = {}) {
        const std::string number = std::to_string(sources.size());
        sources.push_back(std::make_unique<tests::Source<MemoryRequest>>(rig.context("source" + number), requests));
        sinks.push_back(std::make_unique<tests::Sink<MemoryResponse>>(rig.context("sink" + number), sink));
        memory.attach(sources.back()->out, sinks.back()->in);
    }
    RopClient& add_rop(std::vector<MemoryRequest> requests) {
        const auto number = static_cast<std::uint32_t>(rops.size());
        rops.push_back(std::make_unique<RopClient>(rig.context("rop" + std::to_string(number)), memory, requests));
        memory.attach_rop(number, rops.back()->out, rops.back()->in);
        return *rops.back();
    }
    std::vector<std::uint32_t> tags(std::size_t client) const {
        std::vector<std::uint32_t> list;
        for (const MemoryResponse& response : sinks[client]->values()) list.push_back(response.tag);
        return list;
    }

    Rig rig;
    MemorySystem memory;
    std::vector<std::unique_ptr<tests::Source<MemoryRequest>>> sources;
    std::vector<std::unique_ptr<tests::Sink<MemoryResponse>>> sinks;
    std::vector<std::unique_ptr<RopClient>> rops;
};

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

// Cycles of a lone read, less those on the chip, in nanoseconds.
double dram_ns(double core_mhz) {
    sim::Simulation simulation;
    const sim::Clock& clock = simulation.add_clock("core", core_mhz);
    const MemoryParams params;
    MemorySystem memory(simulation, clock, params);
    tests::Source<MemoryRequest> source(simulation.context("source", clock), reads(1, 0, 0));
    tests::Sink<MemoryResponse> sink(simulation.context("sink", clock));
    memory.attach(source.out, sink.in);
    simulation.run();
    const Cycle chip =
        params.controller.request_latency + params.controller.return_latency + 2 * params.hub.latency + 2;
    return static_cast<double>((sink.cycles().front() - chip) * clock.period) / 1000;
}

TEST(MemorySystem, PHY_S1_TimeOfTheDramDoesNotChangeWithTheCoreClock) {
    const double device = 15 + 13.75 + 5; // tRCD, CL, two bursts
    for (const double mhz : {325.0, 650.0, 1300.0, 2600.0}) {
        EXPECT_GE(dram_ns(mhz), device) << mhz;
        EXPECT_LE(dram_ns(mhz), device + 1e3 / mhz) << mhz; // up to the next edge
    }
}

TEST(MemorySystem, PHY_S1_BandwidthDoesNotChangeWithTheCoreClock) {
    std::vector<double> ns;
    for (const double mhz : {650.0, 1300.0}) {
        sim::Simulation simulation;
        const sim::Clock& clock = simulation.add_clock("core", mhz);
        MemoryParams params;
        params.bandwidth = 12.8;
        MemorySystem memory(simulation, clock, params);
        tests::Source<MemoryRequest> source(simulation.context("source", clock), reads(20000, 0, 64));
        tests::Sink<MemoryResponse> sink(simulation.context("sink", clock));
        memory.attach(source.out, sink.in);
        simulation.run();
        ns.push_back(static_cast<double>(simulation.now()));
    }
    EXPECT_NEAR(ns[1] / ns[0], 1, 0.01);
}

// ROP partitions that exchange tiles, as many bytes read as written.
TEST(MemorySystem, PHY_P10a_RopPartitionsReachSeventyToNinetyTwoPercentOfThePeak) {
    for (const std::uint32_t bytes : {32U, 64U, 256U}) {
        const MemoryParams params;
        Bench bench(params);
        constexpr std::uint32_t total = 1U << 20U; // of each ROP partition, in either direction
        for (std::uint64_t rop = 0; rop < 4; ++rop) {
            std::vector<MemoryRequest> requests;
            for (std::uint32_t i = 0; i < 2 * total / bytes; ++i) {
                const bool write = i / (256 / bytes) % 2 == 1; // a block of 256 bytes each way in turn
                const std::uint64_t at = std::uint64_t{i / (512 / bytes)} * 256 + i % (256 / bytes) * bytes;
                requests.push_back({(rop << 26U) + (write ? 1U << 24U : 0U) + at, bytes, i, 0,
                                    write ? MemoryClient::tile_write : MemoryClient::tile_read, write});
            }
            bench.add_rop(std::move(requests));
        }
        bench.rig.simulation.run();
        const double ns = static_cast<double>(bench.rig.simulation.now()) / 1000;
        const double share = 8.0 * total / ns / params.bandwidth;
        EXPECT_GE(share, 0.70) << bytes;
        EXPECT_LE(share, 0.92) << bytes;
    }
}

// What lies in a row are its own bytes: a stream opens each row once, however many partitions it is spread over.
TEST(MemorySystem, PHY_C5_RowHitsOfAStreamDoNotDependOnThePartitions) {
    for (const std::uint32_t partitions : {1U, 4U, 16U, 64U}) {
        for (const bool from_rop : {false, true}) {
            MemoryParams params;
            params.partitions = partitions;
            params.bandwidth = 12.8 * partitions;
            params.controller.dram.refi_ns = 0; // a refresh closes rows
            Bench bench(params);
            const std::uint32_t rows = 3 * partitions;
            const std::uint32_t row_bytes = params.controller.dram.row_bytes;
            if (from_rop)
                bench.add_rop(reads(rows * row_bytes / 64, 0, 64));
            else
                bench.add(reads(rows * row_bytes / 64, 0, 64));
            bench.rig.simulation.run();
            const auto stats = bench.memory.controller_stats();
            EXPECT_EQ(stats.row_misses.value, rows) << partitions;
            EXPECT_EQ(stats.row_hits.value, rows * (row_bytes / 64 - 1)) << partitions;
        }
    }
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
