// What physics says of crossbar and partitions together, whatever the clocks, the partitions and the sizes.
#include "tests/support/memory_kit.hpp"

namespace memory_system_physics_test {

using pipeline::MemoryClient;
using pipeline::MemoryParams;
using pipeline::MemoryRequest;
using pipeline::MemoryResponse;
using pipeline::MemorySystem;
using sim::Cycle;
using Bench = tests::MemoryBench;
using tests::reads;

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

} // namespace memory_system_physics_test
