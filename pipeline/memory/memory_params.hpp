// Parameters of the memory system; the units are in memory_system.hpp, memory_hub.hpp, memory_controller.hpp and
// dram_channel.hpp.
#pragma once

#include "sim/described.hpp"

#include <cstdint>
#include <tuple>

namespace pipeline {

struct DramParams {
    std::uint32_t latency = 226;
    std::uint32_t row_miss = 28;
    std::uint32_t row_bytes = 2048;
    std::uint32_t banks = 8;
    std::uint32_t overtakes = 16;

    static constexpr auto fields() {
        using P = DramParams;
        return std::tuple{
            sim::field<&P::latency>("Access latency, without the row penalty and the transfer")
                .unit("cycles")
                .range(1, 100000),
            sim::field<&P::row_miss>("Time to close a row and open another one").unit("cycles").range(0, 100000),
            sim::field<&P::row_bytes>("Bytes of a row").unit("bytes").range(64, 1U << 20U),
            sim::field<&P::banks>("Banks of a channel, one open row each").unit("banks").range(1, 1024),
            sim::field<&P::overtakes>(
                "Requests to the open row that may overtake an older one of the bank; 0: in order")
                .unit("requests")
                .at_most(65536)};
    }
};
static_assert(sim::fully_described<DramParams>);

struct MemoryControllerParams {
    std::uint32_t queue = 64;
    std::uint32_t jitter_cycles = 0;
    DramParams dram;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&MemoryControllerParams::queue>("Requests that wait for the data bus").range(1, 65536),
            sim::field<&MemoryControllerParams::jitter_cycles>("Random extra latency of a read: 0 to this many")
                .unit("cycles")
                .at_most(100000),
            sim::field<&MemoryControllerParams::dram>("DRAM channel")};
    }
};
static_assert(sim::fully_described<MemoryControllerParams>);

struct MemoryHubParams {
    std::uint32_t latency = 20;
    std::uint32_t requests_per_clk = 1;
    std::uint32_t reads_in_flight = 2048;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&MemoryHubParams::latency>("Latency of the wires to and from a partition, each way")
                .unit("cycles")
                .range(1, 10000),
            sim::field<&MemoryHubParams::requests_per_clk>("Requests that one client may send in a cycle").range(1, 64),
            sim::field<&MemoryHubParams::reads_in_flight>("Reads on their way, of all clients").range(64, 1U << 20U)};
    }
};
static_assert(sim::fully_described<MemoryHubParams>);

struct MemoryParams {
    std::uint32_t partitions = 4;
    double bandwidth = 51.2;
    std::uint32_t interleave = 256;
    double clock_mhz = 0;
    MemoryHubParams hub;
    MemoryControllerParams controller;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&MemoryParams::partitions>("Memory partitions, one DRAM channel each").range(1, 64),
            sim::field<&MemoryParams::bandwidth>("Peak bandwidth of all partitions together")
                .unit("GB/s")
                .range(1e-3, 1e5),
            sim::field<&MemoryParams::interleave>("Consecutive bytes in one partition; a power of two")
                .unit("bytes")
                .range(32, 1U << 20U),
            sim::field<&MemoryParams::clock_mhz>("Clock of the partitions; 0: that of the core")
                .unit("MHz")
                .range(0, 1e5),
            sim::field<&MemoryParams::hub>("Crossbar"),
            sim::field<&MemoryParams::controller>("Partition")};
    }
};
static_assert(sim::fully_described<MemoryParams>);

} // namespace pipeline
