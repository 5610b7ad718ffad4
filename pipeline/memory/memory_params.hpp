// Parameters of the memory system; the units are in memory_system.hpp, memory_hub.hpp, memory_controller.hpp and
// dram_channel.hpp.
#pragma once

#include "sim/described.hpp"

#include <cstdint>
#include <tuple>

namespace pipeline {

/// One DRAM channel. Times are those of the devices in nanoseconds, whatever the clock of the chip in front of them;
/// the defaults are those of 512 Mbit GDDR3 at 800 MHz (models/gpus/neutral.toml has the source of each).
struct DramParams {
    double rcd_read_ns = 15;
    double rcd_write_ns = 6.25;
    double cl_ns = 13.75;
    double wl_ns = 7.5;
    double rp_ns = 16.25;
    double ras_ns = 26.25;
    double wr_ns = 11.25;
    double rrd_ns = 10;
    double faw_ns = 40;
    double rtw_ns = 2.5;
    double wtr_ns = 7.5;
    double refi_ns = 3900;
    double rfc_ns = 52;
    std::uint32_t burst_bytes = 32;
    std::uint32_t row_bytes = 4096;
    std::uint32_t banks = 8;
    std::uint32_t overtakes = 16;
    std::uint32_t write_batch = 32;
    std::uint32_t read_batch = 256;

    static constexpr auto fields() {
        using P = DramParams;
        return std::tuple{
            sim::field<&P::rcd_read_ns>("tRCD: from the activation of a row to a read command")
                .unit("ns")
                .range(0, 1e5),
            sim::field<&P::rcd_write_ns>("tRCD: from the activation of a row to a write command")
                .unit("ns")
                .range(0, 1e5),
            sim::field<&P::cl_ns>("CL: from a read command to its first data").unit("ns").range(0, 1e5),
            sim::field<&P::wl_ns>("WL: from a write command to its first data").unit("ns").range(0, 1e5),
            sim::field<&P::rp_ns>(
                "tRP: precharge, from the close of a row to the activation of another one of the bank")
                .unit("ns")
                .range(0, 1e5),
            sim::field<&P::ras_ns>("tRAS: from the activation of a row to its close").unit("ns").range(0, 1e5),
            sim::field<&P::wr_ns>("tWR: from the last data of a write to the close of its row")
                .unit("ns")
                .range(0, 1e5),
            sim::field<&P::rrd_ns>("tRRD: between activations of a channel").unit("ns").range(0, 1e5),
            sim::field<&P::faw_ns>("tFAW: window that holds at most four activations of a channel")
                .unit("ns")
                .range(0, 1e5),
            sim::field<&P::rtw_ns>("Turn of the data bus: from the last data of a read to the first of a write")
                .unit("ns")
                .range(0, 1e5),
            sim::field<&P::wtr_ns>(
                "tWTR: from the last data of a write to a read command; the bus is idle for tWTR + CL")
                .unit("ns")
                .range(0, 1e5),
            sim::field<&P::refi_ns>("tREFI: from one refresh to the next; 0: none").unit("ns").range(0, 1e9),
            sim::field<&P::rfc_ns>("tRFC: duration of a refresh of all banks").unit("ns").range(0, 1e6),
            sim::field<&P::burst_bytes>("Bytes of a burst, the smallest transfer; a power of two")
                .unit("bytes")
                .range(1, 4096),
            sim::field<&P::row_bytes>("Bytes of a row, all devices of the channel together")
                .unit("bytes")
                .range(64, 1U << 20U),
            sim::field<&P::banks>("Banks of a channel, one open row each").unit("banks").range(1, 1024),
            sim::field<&P::overtakes>(
                "Requests to the open row that may overtake an older one of the bank; 0: in order")
                .unit("requests")
                .at_most(65536),
            sim::field<&P::write_batch>("Bursts of writes that are gathered and moved at a time; as many reads follow, "
                                        "if they wait, before the next")
                .unit("bursts")
                .range(1, 65536),
            sim::field<&P::read_batch>("Bursts of reads that may go first while a write waits")
                .unit("bursts")
                .range(1, 1U << 20U)};
    }
};
static_assert(sim::fully_described<DramParams>);

struct MemoryControllerParams {
    std::uint32_t queue = 64;
    std::uint32_t write_queue = 64;
    std::uint32_t request_latency = 107;
    std::uint32_t return_latency = 129;
    std::uint32_t jitter_cycles = 0;
    DramParams dram;

    static constexpr auto fields() {
        using P = MemoryControllerParams;
        return std::tuple{
            sim::field<&P::queue>("Reads that wait for the data bus").unit("requests").range(1, 65536),
            sim::field<&P::write_queue>("Writes that wait for the data bus").unit("requests").range(1, 65536),
            sim::field<&P::request_latency>("On the chip: from the port of a partition to the queue of its channel")
                .unit("core cycles")
                .at_most(100000),
            sim::field<&P::return_latency>("On the chip: from the pins of a channel to the port of its partition")
                .unit("core cycles")
                .at_most(100000),
            sim::field<&P::jitter_cycles>("Random extra time of the way back of a read: 0 to this many")
                .unit("core cycles")
                .at_most(100000),
            sim::field<&P::dram>("DRAM channel")};
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
