// The closed forms of a DRAM channel: latency, bandwidth, rows, banks and order.
#include "pipeline/memory/dram_channel.hpp"

#include <gtest/gtest.h>
#include <set>

namespace {

using pipeline::DramChannel;
using pipeline::DramParams;
using Fine = DramChannel::Fine;

constexpr sim::Time cycle = 1000; // 1 GHz
constexpr Fine fine_cycle = cycle * DramChannel::fine_per_time;
constexpr std::uint64_t row = 1024;
constexpr DramParams params{.latency = 100, .row_miss = 20, .row_bytes = row, .banks = 4};

// 8 GB/s = 8 bytes per cycle.
DramChannel channel_8(std::uint32_t overtakes = 16) {
    DramParams with = params;
    with.overtakes = overtakes;
    return {with, 8.0, cycle, 64};
}

// Lets the channel work until nobody waits, from `now` on.
std::vector<DramChannel::Transfer> drain(DramChannel& channel, sim::Time now = 0) {
    std::vector<DramChannel::Transfer> list;
    for (; channel.waiting() > 0; now += cycle)
        while (const auto transfer = channel.transfer(now)) list.push_back(*transfer);
    return list;
}

std::vector<std::uint32_t> ids(const std::vector<DramChannel::Transfer>& transfers) {
    std::vector<std::uint32_t> list;
    for (const auto& transfer : transfers) list.push_back(transfer.id);
    return list;
}

TEST(DramChannel, LoneReadTakesRowMissTransferAndLatency) {
    DramChannel channel = channel_8();
    channel.enqueue(0, 64, 7, 5 * cycle);
    EXPECT_EQ(channel.next_start(), (5 + 20) * fine_cycle);
    EXPECT_FALSE(channel.transfer((5 + 19) * cycle).has_value());
    const auto transfer = channel.transfer((5 + 20) * cycle);
    ASSERT_TRUE(transfer.has_value());
    EXPECT_EQ(transfer->id, 7U);
    EXPECT_FALSE(transfer->row_hit);
    EXPECT_EQ(transfer->end, (5 + 20 + 8) * fine_cycle);
    EXPECT_EQ(transfer->done, (5 + 20 + 8 + 100) * fine_cycle);
    EXPECT_EQ(channel.unloaded_latency(64), (20 + 8 + 100) * fine_cycle);
}

TEST(DramChannel, OpenRowSavesTheRowMiss) {
    DramChannel channel = channel_8();
    channel.enqueue(0, 64, 0, 0);
    drain(channel);
    channel.enqueue(row - 64, 64, 1, 500 * cycle);
    const auto hit = drain(channel, 500 * cycle);
    EXPECT_TRUE(hit.front().row_hit);
    EXPECT_EQ(hit.front().done, (500 + 8 + 100) * fine_cycle);
    std::uint64_t other = 1; // another row of the same bank
    while (channel.bank_of(other * row) != channel.bank_of(0)) ++other;
    channel.enqueue(other * row, 64, 2, 900 * cycle);
    EXPECT_FALSE(drain(channel, 900 * cycle).front().row_hit);
    channel.enqueue(0, 64, 3, 1900 * cycle);
    EXPECT_FALSE(drain(channel, 1900 * cycle).front().row_hit);
}

TEST(DramChannel, ConsecutiveRowsAndDistancesOfAPowerOfTwoLieInDifferentBanks) {
    const DramChannel channel = channel_8();
    int neighbours_in_one_bank = 0; // happens where a digit carries
    for (std::uint64_t first = 0; first < 1024; ++first)
        neighbours_in_one_bank += channel.bank_of(first * row) == channel.bank_of((first + 1) * row) ? 1 : 0;
    EXPECT_LT(neighbours_in_one_bank, 1024 / 32);
    for (std::uint64_t distance = 4; distance < (1U << 20U); distance *= 2) {
        std::set<std::uint32_t> banks;
        for (std::uint64_t stream = 0; stream < 4; ++stream) banks.insert(channel.bank_of(stream * distance * row));
        EXPECT_GE(banks.size(), 2U) << distance;
    }
}

TEST(DramChannel, RowHitsStreamAtTheBandwidth) {
    DramChannel channel = channel_8();
    for (std::uint32_t i = 0; i < 16; ++i) channel.enqueue(i * 64, 64, i, 0);
    EXPECT_EQ(drain(channel).back().end, (20 + 16 * 8) * fine_cycle);
}

TEST(DramChannel, RowMissesOfOtherBanksHideBehindTransfers) {
    DramChannel channel = channel_8();
    for (std::uint32_t i = 0; i < 4; ++i) channel.enqueue(i * row, 256, i, 0);
    EXPECT_EQ(drain(channel).back().end, (20 + 4 * 32) * fine_cycle);
}

TEST(DramChannel, RowMissesOfOneBankAreSerial) {
    DramChannel channel({.latency = 100, .row_miss = 20, .row_bytes = row, .banks = 1}, 8.0, cycle, 64);
    for (std::uint32_t i = 0; i < 5; ++i) channel.enqueue(i * row, 64, i, 0);
    EXPECT_EQ(drain(channel).back().end, 5 * (20 + 8) * fine_cycle);
}

TEST(DramChannel, RequestsToTheOpenRowOvertakeUpToALimit) {
    const auto order = [](std::uint32_t overtakes) {
        DramChannel channel({.latency = 1, .row_miss = 20, .row_bytes = row, .banks = 1, .overtakes = overtakes}, 8.0,
                            cycle, 64);
        for (std::uint32_t i = 0; i < 8; ++i) channel.enqueue(i % 2 * row + i * 64, 64, i, 0);
        return ids(drain(channel));
    };
    EXPECT_EQ(order(0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(order(2), (std::vector<std::uint32_t>{0, 2, 4, 1, 3, 5, 7, 6}));
    EXPECT_EQ(order(16), (std::vector<std::uint32_t>{0, 2, 4, 6, 1, 3, 5, 7}));
}

TEST(DramChannel, RequestsToOneRowKeepTheirOrder) {
    DramChannel channel = channel_8();
    for (std::uint32_t i = 0; i < 60; ++i) channel.enqueue(i % 6 * row, 32, i, 0);
    std::vector<std::uint32_t> last(6, 0);
    for (const std::uint32_t id : ids(drain(channel))) {
        EXPECT_GE(id, last[id % 6]);
        last[id % 6] = id;
    }
}

TEST(DramChannel, BankThatIsReadyGoesFirst) {
    DramChannel channel = channel_8();
    channel.enqueue(0, 64, 0, 0);
    drain(channel);
    const sim::Time later = 100 * cycle;
    channel.enqueue(row, 64, 1, later); // its bank has to open the row first
    channel.enqueue(64, 64, 2, later);  // row 0 is open
    EXPECT_EQ(ids(drain(channel, later)), (std::vector<std::uint32_t>{2, 1}));
}

TEST(DramChannel, BandwidthNeedNotDivideTheClock) {
    constexpr sim::Time odd_cycle = 1538;
    DramChannel channel({.latency = 1, .row_miss = 0, .row_bytes = 1U << 20U, .banks = 1}, 12.8, odd_cycle, 1000);
    for (std::uint32_t i = 0; i < 1000; ++i) channel.enqueue(0, 64, i, 0);
    Fine end = 0;
    for (sim::Time now = 0; channel.waiting() > 0; now += odd_cycle)
        while (const auto transfer = channel.transfer(now)) end = transfer->end;
    EXPECT_EQ(end, Fine{64'000} * 78'125); // 12.8 GB/s: 78.125 ps per byte
}

} // namespace
