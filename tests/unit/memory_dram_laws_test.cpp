// What a loaded DRAM channel reaches, against the closed forms of its timing.
#include "pipeline/memory/dram_channel.hpp"

#include <gtest/gtest.h>

namespace {

using pipeline::DramChannel;
using pipeline::DramParams;
using Fine = DramChannel::Fine;

constexpr sim::Time cycle = 1538; // 650 MHz
constexpr double bandwidth = 12.8;
constexpr double burst_ns = 32 / bandwidth;
constexpr std::uint32_t depth = 64; ///< requests of either direction that wait, always

struct Load {
    std::uint64_t next = 0; ///< address of its next request
    std::uint32_t bytes = 64;
    bool random = false; ///< rows at random instead of one after the other
    std::uint64_t seed = 88172645463325252U;

    std::uint64_t address() {
        if (!random) return std::exchange(next, next + bytes);
        seed ^= seed << 13U;
        seed ^= seed >> 7U;
        seed ^= seed << 17U;
        return next + seed % (1U << 20U) * 4096;
    }
};

struct Reached {
    double share = 0; ///< of the peak bandwidth
    double ns = 0;
    double hits = 0; ///< of the rows
    std::uint64_t requests = 0;
    pipeline::DramEvents events;
};

/// Keeps both queues full for `ns`; a load of no bytes stays away.
Reached saturate(const DramParams& params, Load reads, Load writes, double ns) {
    DramChannel channel(params, bandwidth, cycle, depth);
    std::vector<std::uint32_t> bytes(1U << 16U);
    std::uint32_t id = 0;
    Reached reached;
    std::uint64_t moved = 0, hits = 0;
    Fine first = 0;
    for (sim::Time now = 0; static_cast<double>(now) < ns * 1e3; now += cycle) {
        for (const bool write : {false, true}) {
            Load& load = write ? writes : reads;
            for (; load.bytes != 0 && channel.waiting(write) < depth; ++id) {
                bytes[id % bytes.size()] = load.bytes;
                channel.enqueue(load.address(), load.bytes, write, id % static_cast<std::uint32_t>(bytes.size()), now);
            }
        }
        while (const auto transfer = channel.transfer(now)) {
            if (reached.requests++ == 0)
                first = transfer->end;
            else
                moved += bytes[transfer->id];
            hits += transfer->row_hit ? 1U : 0U;
            reached.ns = static_cast<double>(transfer->end - first) / 1e6;
        }
    }
    reached.share = static_cast<double>(moved) / bandwidth / reached.ns;
    reached.hits = static_cast<double>(hits) / static_cast<double>(reached.requests);
    reached.events = channel.events();
    return reached;
}

const Load nothing{.bytes = 0};

// A round of N bursts each way costs the two turns once: N t_burst per direction and half of the turns. The turns are
// the times that the bus stands still: after reads tRTW, after writes tWTR + CL.
TEST(DramLaws, PHY_P10a_BatchesOfNBurstsEachWayReachTheirShareOfThePeak) {
    for (const std::uint32_t batch : {1U, 2U, 4U, 8U, 16U, 32U}) {
        DramParams params;
        params.refi_ns = 0;
        params.write_batch = batch;
        params.row_bytes = 1U << 20U; // rows do not matter here
        const Reached reached = saturate(params, {.bytes = 32}, {.next = 1U << 20U, .bytes = 32}, 50'000);
        const double turns = params.rtw_ns + params.wtr_ns + params.cl_ns;
        const double expected = batch * burst_ns / (batch * burst_ns + turns / 2);
        EXPECT_NEAR(reached.share / expected, 1, 0.02) << batch;
    }
}

TEST(DramLaws, PHY_P10a_HalfReadsHalfWritesReachSeventyToNinetyTwoPercentOfThePeak) {
    for (const std::uint32_t bytes : {32U, 64U, 256U}) {
        const Reached reached = saturate({}, {.bytes = bytes}, {.next = 1U << 26U, .bytes = bytes}, 200'000);
        EXPECT_GE(reached.share, 0.70) << bytes;
        EXPECT_LE(reached.share, 0.92) << bytes;
    }
}

TEST(DramLaws, PHY_P10a_ReadsAloneReachThePeakLessRefresh) {
    const DramParams params;
    const Reached reached = saturate(params, {}, nothing, 200'000);
    EXPECT_GE(reached.share, 0.93 * (1 - params.rfc_ns / params.refi_ns));
    EXPECT_LE(reached.share, 1 - params.rfc_ns / params.refi_ns);
    EXPECT_EQ(reached.events.turnarounds, 0U);
}

TEST(DramLaws, RefreshesTakeTheirShareOfTheTime) {
    const DramParams params;
    const Reached reached = saturate(params, {}, nothing, 1'000'000);
    const double share = static_cast<double>(reached.events.refreshes) * params.rfc_ns / reached.ns;
    EXPECT_NEAR(share / (params.rfc_ns / params.refi_ns), 1, 0.01);
}

TEST(DramLaws, WindowOfFourActivationsBoundsRandomRows) {
    for (const double faw : {60.0, 100.0}) {
        DramParams params;
        params.refi_ns = 0;
        params.rrd_ns = 0;
        params.faw_ns = faw;
        params.overtakes = 0;
        const Reached reached = saturate(params, {.random = true}, nothing, 100'000);
        const double bound = 4 / faw; // activations per ns
        const double rate = static_cast<double>(reached.requests) * (1 - reached.hits) / reached.ns;
        EXPECT_LE(rate, bound * 1.001) << faw;
        EXPECT_GE(rate, bound * 0.95) << faw;
        EXPECT_GT(reached.events.activation_waits, reached.requests / 2) << faw;
    }
}

TEST(DramLaws, ActivationsKeepTheirDistance) {
    DramParams params;
    params.refi_ns = 0;
    params.rrd_ns = 20;
    params.faw_ns = 0;
    const Reached reached = saturate(params, {.random = true}, nothing, 100'000);
    const double rate = static_cast<double>(reached.requests) * (1 - reached.hits) / reached.ns;
    EXPECT_LE(rate, 1 / params.rrd_ns * 1.001);
    EXPECT_GE(rate, 1 / params.rrd_ns * 0.95);
}

TEST(DramLaws, PHY_C5_StreamHitsItsRowButOncePerRow) {
    for (const std::uint32_t row_bytes : {512U, 2048U, 4096U}) {
        DramParams params;
        params.refi_ns = 0; // a refresh closes rows
        params.row_bytes = row_bytes;
        EXPECT_NEAR(saturate(params, {}, nothing, 200'000).hits, 1 - 64.0 / row_bytes, 0.001) << row_bytes;
    }
}

} // namespace
