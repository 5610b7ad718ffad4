// The closed forms of a DRAM channel: latency, rows, banks and order.
#include "pipeline/memory/dram_channel.hpp"

#include <gtest/gtest.h>
#include <map>
#include <set>

namespace memory_dram_channel_test {

using pipeline::DramChannel;
using pipeline::DramParams;
using Fine = DramChannel::Fine;

constexpr sim::Time cycle = 1000; // 1 GHz: a cycle is a nanosecond
constexpr Fine fine_cycle = cycle * DramChannel::fine_per_time;
constexpr std::uint64_t row = 1024;

// Activation 12 ns, CL 8, WL 6, precharge 10; nothing across banks.
DramParams plain() {
    DramParams params;
    params.rcd_read_ns = 12;
    params.rcd_write_ns = 5;
    params.cl_ns = 8;
    params.wl_ns = 6;
    params.rp_ns = 10;
    params.ras_ns = 0;
    params.wr_ns = 0;
    params.rrd_ns = 0;
    params.faw_ns = 0;
    params.rtw_ns = 0;
    params.wtr_ns = 0;
    params.refi_ns = 0;
    params.row_bytes = row;
    params.banks = 4;
    return params;
}

// 8 GB/s = 8 bytes per cycle.
DramChannel channel_8(const DramParams& params = plain()) { return {params, 8.0, cycle, 64}; }

void read(DramChannel& channel, std::uint64_t local, std::uint32_t id, sim::Time now = 0, std::uint32_t bytes = 64) {
    channel.enqueue(local, bytes, false, id, now);
}
void write(DramChannel& channel, std::uint64_t local, std::uint32_t id, sim::Time now = 0, std::uint32_t bytes = 64) {
    channel.enqueue(local, bytes, true, id, now);
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

std::uint64_t other_row_of_bank(const DramChannel& channel, std::uint64_t local) {
    std::uint64_t other = local + row;
    while (channel.bank_of(other) != channel.bank_of(local)) other += row;
    return other;
}

TEST(DramChannel, LoneReadOfAClosedBankTakesActivationCasLatencyAndTransfer) {
    DramChannel channel = channel_8();
    read(channel, 0, 7, 5 * cycle);
    EXPECT_FALSE(channel.transfer(5 * cycle).has_value());
    EXPECT_EQ(channel.next_start(), (5 + 12 + 8) * fine_cycle);
    EXPECT_FALSE(channel.transfer((5 + 19) * cycle).has_value());
    const auto transfer = channel.transfer((5 + 20) * cycle);
    ASSERT_TRUE(transfer.has_value());
    EXPECT_EQ(transfer->id, 7U);
    EXPECT_FALSE(transfer->row_hit);
    EXPECT_EQ(transfer->end, (5 + 20 + 8) * fine_cycle);
    EXPECT_EQ(channel.unloaded_latency(64), (20 + 8) * fine_cycle);
}

TEST(DramChannel, LoneWriteTakesActivationWriteLatencyAndTransfer) {
    DramChannel channel = channel_8();
    write(channel, 0, 0, 5 * cycle);
    EXPECT_EQ(drain(channel, 5 * cycle).front().end, (5 + 5 + 6 + 8) * fine_cycle);
}

TEST(DramChannel, OpenRowSavesTheActivationAnotherRowCostsAPrecharge) {
    DramChannel channel = channel_8();
    read(channel, 0, 0);
    drain(channel);
    read(channel, row - 64, 1, 500 * cycle);
    const auto hit = drain(channel, 500 * cycle);
    EXPECT_TRUE(hit.front().row_hit);
    EXPECT_EQ(hit.front().end, (500 + 8 + 8) * fine_cycle);
    read(channel, other_row_of_bank(channel, 0), 2, 900 * cycle);
    const auto miss = drain(channel, 900 * cycle);
    EXPECT_FALSE(miss.front().row_hit);
    EXPECT_EQ(miss.front().end, (900 + 10 + 12 + 8 + 8) * fine_cycle);
    read(channel, 0, 3, 1900 * cycle);
    EXPECT_FALSE(drain(channel, 1900 * cycle).front().row_hit);
}

TEST(DramChannel, RowStaysOpenForItsActiveTimeAndTheRecoveryOfAWrite) {
    DramParams params = plain();
    params.ras_ns = 40;
    DramChannel active = channel_8(params);
    read(active, 0, 0);
    read(active, other_row_of_bank(active, 0), 1);
    EXPECT_EQ(drain(active).back().end, (40 + 10 + 12 + 8 + 8) * fine_cycle); // tRC = tRAS + tRP

    params = plain();
    params.wr_ns = 25;
    DramChannel recovering = channel_8(params);
    write(recovering, 0, 0);
    write(recovering, other_row_of_bank(recovering, 0), 1);
    EXPECT_EQ(drain(recovering).back().end, (5 + 6 + 8 + 25 + 10 + 5 + 6 + 8) * fine_cycle);
}

TEST(DramChannel, BusTurnsTakeTheirTime) {
    DramParams params = plain();
    params.rtw_ns = 3;
    params.wtr_ns = 7;
    DramChannel channel = channel_8(params);
    read(channel, 0, 0); // the row opens, and serves all of them
    read(channel, 64, 1);
    drain(channel);
    const sim::Time later = 500 * cycle;
    read(channel, 128, 2, later);
    write(channel, 192, 3, later);
    const auto first = drain(channel, later);
    EXPECT_EQ(first.back().end - first.front().end, (3 + 8) * fine_cycle);
    EXPECT_EQ(channel.events().turnarounds, 1U);
    write(channel, 256, 4, later + 100 * cycle);
    read(channel, 320, 5, later + 100 * cycle);
    const auto second = drain(channel, later + 100 * cycle);
    EXPECT_EQ(second.back().id, 5U);
    EXPECT_EQ(second.back().end - second.front().end, (7 + 8 + 8) * fine_cycle); // tWTR, CL, transfer
    EXPECT_EQ(channel.events().turnarounds, 2U);
}

TEST(DramChannel, TransfersAreWholeBursts) {
    DramChannel channel = channel_8();
    EXPECT_EQ(channel.burst_bytes_of(0, 1), 32U);
    EXPECT_EQ(channel.burst_bytes_of(64, 64), 64U);
    EXPECT_EQ(channel.burst_bytes_of(30, 4), 64U); // across the border of two
    write(channel, 40, 0, 0, 4);
    EXPECT_EQ(drain(channel).front().end, (5 + 6 + 4) * fine_cycle);
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
    for (std::uint32_t i = 0; i < 16; ++i) read(channel, std::uint64_t{i} * 64, i);
    EXPECT_EQ(drain(channel).back().end, (20 + 16 * 8) * fine_cycle);
}

TEST(DramChannel, RowMissesOfOtherBanksHideBehindTransfers) {
    DramChannel channel = channel_8();
    for (std::uint32_t i = 0; i < 4; ++i) read(channel, i * row, i, 0, 256);
    EXPECT_EQ(drain(channel).back().end, (20 + 4 * 32) * fine_cycle);
}

TEST(DramChannel, RowMissesOfOneBankAreSerial) {
    DramParams params = plain();
    params.banks = 1;
    DramChannel channel = channel_8(params);
    for (std::uint32_t i = 0; i < 5; ++i) read(channel, i * row, i);
    // Every row but the first waits for the data of the one before: precharge, activation, transfer; CL overlaps.
    EXPECT_EQ(drain(channel).back().end, (12 + 8 + 8 + 4 * (10 + 12 + 8)) * fine_cycle);
}

TEST(DramChannel, RequestsToTheOpenRowOvertakeUpToALimit) {
    const auto order = [](std::uint32_t overtakes) {
        DramParams params = plain();
        params.banks = 1;
        params.overtakes = overtakes;
        DramChannel channel = channel_8(params);
        for (std::uint32_t i = 0; i < 8; ++i) read(channel, i % 2 * row + std::uint64_t{i} * 64, i);
        return ids(drain(channel));
    };
    EXPECT_EQ(order(0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(order(2), (std::vector<std::uint32_t>{0, 2, 4, 1, 3, 5, 7, 6}));
    EXPECT_EQ(order(16), (std::vector<std::uint32_t>{0, 2, 4, 6, 1, 3, 5, 7}));
}

TEST(DramChannel, BankThatIsReadyGoesFirst) {
    DramChannel channel = channel_8();
    read(channel, 0, 0);
    drain(channel);
    const sim::Time later = 100 * cycle;
    read(channel, row, 1, later); // its bank has to open the row first
    read(channel, 64, 2, later);  // row 0 is open
    EXPECT_EQ(ids(drain(channel, later)), (std::vector<std::uint32_t>{2, 1}));
}

TEST(DramChannel, ReadsGoFirstAndWritesInBatches) {
    DramParams params = plain();
    params.write_batch = 4;
    DramChannel channel = channel_8(params);
    for (std::uint32_t i = 0; i < 12; ++i) read(channel, std::uint64_t{i} * 32, i, 0, 32);
    for (std::uint32_t i = 100; i < 108; ++i) write(channel, 512 + std::uint64_t{i - 100} * 32, i, 0, 32);
    // A batch of writes has gathered; as many reads follow; then the next batch.
    EXPECT_EQ(ids(drain(channel)), (std::vector<std::uint32_t>{100, 101, 102, 103, 0, 1, 2, 3, 104, 105,
                                                               106, 107, 4,   5,   6, 7, 8, 9, 10,  11}));
}

// Reads and writes at random addresses of few rows, some of two bursts: whatever goes first, two requests of which one
// writes keep their order at every burst that they share.
TEST(DramChannel, RequestsThatShareABurstKeepTheirOrder) {
    DramParams params = plain();
    params.write_batch = 6;
    params.wtr_ns = 5;
    params.ras_ns = 30;
    DramChannel channel = channel_8(params);
    struct Asked {
        std::uint64_t first;
        std::uint64_t end;
        bool write;
    };
    std::vector<Asked> asked;
    std::vector<std::uint32_t> done;
    std::uint64_t random = 1;
    sim::Time now = 0;
    while (asked.size() < 3000 || channel.waiting() > 0) {
        random = random * 6364136223846793005U + 1442695040888963407U;
        const std::uint64_t draw = random >> 33U;
        if (asked.size() < 3000 && channel.waiting() < 48) {
            const std::uint64_t burst = draw % 8 + draw / 8 % 3 * (row / 32);
            const std::uint32_t bytes = draw / 64 % 2 == 0 ? 32 : 64;
            const bool writes = draw / 128 % 2 == 0;
            channel.enqueue(burst * 32, bytes, writes, static_cast<std::uint32_t>(asked.size()), now);
            asked.push_back({burst, burst + bytes / 32, writes});
        }
        while (const auto transfer = channel.transfer(now)) done.push_back(transfer->id);
        now += cycle;
    }
    ASSERT_EQ(done.size(), asked.size());
    for (std::size_t i = 0; i < done.size(); ++i)
        for (std::size_t later = i + 1; later < std::min(done.size(), i + 200); ++later) {
            const Asked& a = asked[done[i]];
            const Asked& b = asked[done[later]];
            if ((a.write || b.write) && a.first < b.end && b.first < a.end) {
                ASSERT_LT(done[i], done[later]);
            }
        }
}

TEST(DramChannel, ReadThatNeedsAWaitingWriteIsNotHeldUpByOtherReads) {
    DramParams params = plain();
    params.write_batch = 8;
    params.read_batch = 100000;
    DramChannel channel = channel_8(params);
    sim::Time now = 0;
    std::uint32_t id = 0;
    write(channel, 512, 1000, now, 32);
    read(channel, 512, 1001, now, 32);
    std::optional<std::uint32_t> before;
    for (; !before; now += cycle) {
        while (channel.waiting(false) < 16) read(channel, std::uint64_t{id % 16} * 32, id, now, 32), ++id;
        while (const auto transfer = channel.transfer(now))
            if (transfer->id == 1001) before = id;
        ASSERT_LT(now, 2000 * cycle);
    }
    EXPECT_LT(*before, 64U);
}

TEST(DramChannel, NobodyStarves) {
    for (const bool rare : {false, true}) { // the direction of the lone request
        DramParams params = plain();
        params.write_batch = 8;
        params.read_batch = 40;
        DramChannel channel = channel_8(params);
        std::uint32_t others = 0;
        sim::Time now = 0;
        bool served = false;
        for (; !served; now += cycle) {
            while (channel.waiting(!rare) < 16) channel.enqueue(others % 16 * 32, 32, !rare, others, now), ++others;
            if (now == 100 * cycle) channel.enqueue(768, 32, rare, 1'000'000, now);
            while (const auto transfer = channel.transfer(now)) served |= transfer->id == 1'000'000;
            ASSERT_LT(now, 400 * cycle) << rare;
        }
    }
}

TEST(DramChannel, RefreshClosesTheRowsAndHoldsUpWhatArrives) {
    DramParams params = plain();
    params.refi_ns = 1000;
    params.rfc_ns = 50;
    DramChannel channel = channel_8(params);
    read(channel, 0, 0);
    drain(channel);
    // Two refreshes have passed unseen: the row is closed, and no precharge is needed.
    read(channel, 0, 1, 2500 * cycle);
    const auto later = drain(channel, 2500 * cycle);
    EXPECT_FALSE(later.front().row_hit);
    EXPECT_EQ(later.front().end, (2500 + 12 + 8 + 8) * fine_cycle);
    EXPECT_EQ(channel.events().refreshes, 2U);
    // The third one is due at 3000. The row closes for 10 once the read at 2998 has left it (CL before its data end, at
    // 2998), and opens 50 later.
    read(channel, 0, 2, 2990 * cycle);
    read(channel, 64, 3, 2995 * cycle);
    const auto held = drain(channel, 2995 * cycle);
    EXPECT_EQ(held.front().end, (2998 + 8) * fine_cycle);
    EXPECT_EQ(held.back().end, (2998 + 10 + 50 + 12 + 8 + 8) * fine_cycle);
}

// Calling at every edge, or only when told, makes no difference.
TEST(DramChannel, SuperfluousCallsChangeNothing) {
    const auto run = [](bool every_edge) {
        DramParams params;
        params.refi_ns = 500;
        DramChannel channel(params, 12.8, cycle, 64);
        std::vector<std::pair<std::uint32_t, Fine>> ends;
        std::uint64_t random = 7;
        sim::Time wake = 0;
        for (sim::Time now = 0; now < 40000 * cycle; now += cycle) {
            random = random * 6364136223846793005U + 1442695040888963407U;
            const std::uint64_t draw = random >> 33U;
            const bool arrives = draw % 5 == 0 && channel.waiting() < 40;
            if (arrives)
                channel.enqueue(draw / 8 % 4096 * 32, 64, draw / 65536 % 2 == 0, static_cast<std::uint32_t>(draw), now);
            if (!arrives && !every_edge && now < wake) continue;
            while (const auto transfer = channel.transfer(now)) ends.emplace_back(transfer->id, transfer->end);
            const auto next = channel.next_start();
            wake = next ? *next / fine_cycle * cycle : ~sim::Time{0};
        }
        return ends;
    };
    EXPECT_EQ(run(true), run(false));
    EXPECT_GT(run(true).size(), 1000U);
}

TEST(DramChannel, BandwidthNeedNotDivideTheClock) {
    constexpr sim::Time odd_cycle = 1538;
    DramParams params = plain();
    params.rcd_read_ns = 0;
    params.cl_ns = 0;
    params.row_bytes = 1U << 20U;
    params.banks = 1;
    DramChannel channel(params, 12.8, odd_cycle, 1000);
    for (std::uint32_t i = 0; i < 1000; ++i) read(channel, 0, i);
    Fine end = 0;
    for (sim::Time now = 0; channel.waiting() > 0; now += odd_cycle)
        while (const auto transfer = channel.transfer(now)) end = transfer->end;
    EXPECT_EQ(end, Fine{64'000} * 78'125); // 12.8 GB/s: 78.125 ps per byte
}

} // namespace memory_dram_channel_test
