// The reorder buffer between mock scheduler and pipes and a sink.
#include "pipeline/fragment/reorder_buffer.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace fragment_reorder_buffer_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::Completion;
using pipeline::QuadKind;
using pipeline::QuadTask;

std::vector<QuadTask> tasks(std::uint32_t count) {
    std::vector<QuadTask> list(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        list[i].quad = i;
        list[i].sequence = i;
        list[i].mask = 15;
    }
    return list;
}

std::vector<Completion> completions(const std::vector<std::uint32_t>& sequences, std::uint8_t mask = 15) {
    std::vector<Completion> list;
    for (const std::uint32_t sequence : sequences) list.push_back({sequence, mask});
    return list;
}

struct Bench {
    tests::Rig rig;
    pipeline::ReorderBuffer unit;
    tests::Source<QuadTask> order;
    std::deque<tests::Source<Completion>> pipes;
    tests::Sink<QuadTask> sink;

    Bench(std::vector<QuadTask> in_order, const std::vector<std::vector<Completion>>& by_pipe,
          const pipeline::ReorderBufferParams& params = {}, tests::SourceOptions pipe_options = {},
          tests::SinkOptions sink_options = {}, std::uint32_t places = 1024, sim::Mode mode = sim::Mode::normal,
          std::uint64_t shuffle = 1)
        : rig(mode, 1, shuffle),
          unit(rig.context("reorder_buffer"), params, static_cast<std::uint32_t>(by_pipe.size()), places),
          order(rig.context("order"), std::move(in_order)),
          sink(rig.context("sink"), std::move(sink_options)) {
        sim::connect(order.out, unit.order_in, {1, 64, places});
        for (std::size_t pipe = 0; pipe < by_pipe.size(); ++pipe) {
            pipes.emplace_back(rig.context("pipe" + std::to_string(pipe)), by_pipe[pipe], pipe_options);
            sim::connect(pipes[pipe].out, unit.completions_in[pipe], {1, 1, 4});
        }
        sim::connect(unit.quads_out, sink.in, {1, params.retire_per_clk, 4 * params.retire_per_clk});
        rig.simulation.run();
    }
};

TEST(ReorderBuffer, CompletionsInAnyOrderLeaveInDispatchOrder) {
    std::vector<std::uint32_t> any(200);
    std::iota(any.begin(), any.end(), 0U);
    std::shuffle(any.begin(), any.end(), std::mt19937(3));
    const std::vector<Completion> all = completions(any);
    const std::vector<Completion> first(all.begin(), all.begin() + 77), second(all.begin() + 77, all.end());
    const Bench bench(tasks(200), {first, second});
    EXPECT_EQ(tests::quads_of(bench.sink.values()), tests::counting(200));
    EXPECT_EQ(bench.unit.stats().retired, 200U);
    EXPECT_EQ(bench.unit.stats().dropped, 0U);
}

// A completion sent at cycle 10 arrives at 11; the quad leaves at once and arrives at 12.
TEST(ReorderBuffer, RetiresAQuadInTheCycleItsCompletionArrives) {
    const Bench bench(tasks(1), {completions({0})}, {}, {.start = 10});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{12}));
    EXPECT_EQ(bench.sink.values().front().retired, 11U);
}

TEST(ReorderBuffer, LateOldestHoldsTheRestBack) {
    const Bench bench(tasks(5), {completions({1, 2, 3, 4}), completions({0})}, {.quads = 0, .retire_per_clk = 4},
                      {.start = 20});
    EXPECT_EQ(bench.sink.cycles(), (Cycles{22, 22, 23, 24, 25})); // one completion per pipe and cycle
    const Bench late(tasks(3), {completions({1, 2, 0})}, {.quads = 0, .retire_per_clk = 4}, {.start = 20, .gap = 10});
    EXPECT_EQ(late.sink.cycles(), (Cycles{42, 42, 42}));
    EXPECT_GT(late.unit.activity_times()[static_cast<std::size_t>(sim::Activity::memory)], 20'000U);
}

TEST(ReorderBuffer, RetiresNoMoreThanItsWidth) {
    std::vector<std::uint32_t> backwards(16);
    std::iota(backwards.rbegin(), backwards.rend(), 0U);
    for (const std::uint32_t width : {1U, 2U, 4U}) {
        const Bench bench(tasks(16), {completions(backwards)}, {.quads = 0, .retire_per_clk = width});
        // The oldest completes last, at cycle 16; then all leave at the retire rate.
        for (std::uint32_t i = 0; i < 16; ++i) EXPECT_EQ(bench.sink.cycles()[i], 17 + i / width) << width;
    }
}

TEST(ReorderBuffer, DropsQuadsWithoutASurvivorAndKeepsTheOthersMasks) {
    const std::vector<Completion> done{{0, 15}, {1, 0}, {2, 5}, {3, 0}};
    const Bench bench(tasks(4), {done});
    ASSERT_EQ(tests::quads_of(bench.sink.values()), (std::vector<pipeline::QuadId>{0, 2}));
    EXPECT_EQ(bench.sink.values()[1].mask, 5);
    EXPECT_EQ(bench.unit.stats().retired, 2U);
    EXPECT_EQ(bench.unit.stats().dropped, 2U);
}

TEST(ReorderBuffer, CommandsKeepTheirPlaceAndNeedNoCompletion) {
    std::vector<QuadTask> order = tasks(3);
    order[1].kind = QuadKind::writeback;
    const Bench bench(order, {completions({2, 0})}, {}, {.start = 5});
    ASSERT_EQ(bench.sink.size(), 3U);
    EXPECT_EQ(bench.sink.values()[1].kind, QuadKind::writeback);
    EXPECT_EQ(bench.sink.cycles(), (Cycles{8, 8, 8})); // quad 0 completes at cycle 7
}

TEST(ReorderBuffer, StalledSinkBlocksItAndNothingIsLost) {
    std::vector<std::uint32_t> all(100);
    std::iota(all.begin(), all.end(), 0U);
    const Bench bench(tasks(100), {completions(all)}, {}, {}, {.start = 1000});
    EXPECT_EQ(tests::quads_of(bench.sink.values()), tests::counting(100));
    EXPECT_GT(bench.unit.activity_times()[static_cast<std::size_t>(sim::Activity::blocked)], 800'000U);
}

TEST(ReorderBuffer, PlacesAreUsedAgain) {
    std::vector<std::uint32_t> all(100);
    std::iota(all.begin(), all.end(), 0U);
    const Bench bench(tasks(100), {completions(all)}, {.quads = 5, .retire_per_clk = 1}, {.start = 2}, {}, 5);
    EXPECT_EQ(tests::quads_of(bench.sink.values()), tests::counting(100));
}

TEST(ReorderBuffer, SameInAllModes) {
    std::vector<Completion> first, second;
    std::mt19937 random(5);
    for (std::uint32_t block = 0; block < 200; block += 10) { // out of order within ten
        std::vector<std::uint32_t> ten(10);
        std::iota(ten.begin(), ten.end(), block);
        std::shuffle(ten.begin(), ten.end(), random);
        for (const std::uint32_t sequence : ten)
            (sequence % 2 == 0 ? first : second).push_back({sequence, static_cast<std::uint8_t>(random() % 16)});
    }
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        const Bench bench(tasks(200), {first, second}, {.quads = 0, .retire_per_clk = 2}, {}, {.every = 3}, 256, mode,
                          shuffle);
        return std::tuple(bench.sink.cycles(), tests::quads_of(bench.sink.values()), bench.unit.activity_times());
    });
}

} // namespace fragment_reorder_buffer_test
