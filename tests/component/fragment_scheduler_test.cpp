// The fragment scheduler between a source of quads and mock pipes: who is dispatched when, and who has to wait.
#include "sim/described_json.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/scheduler_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <nlohmann/json.hpp>
#include <random>

namespace fragment_scheduler_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::FragmentEnd;
using pipeline::FragmentScheduler;
using pipeline::QuadTask;
using pipeline::SchedulingPlan;
using tests::KBufferPass;
using tests::SchedulerBench;
using tests::scoreboard_plan;

std::vector<std::uint32_t> sequences(const std::vector<QuadTask>& tasks) {
    std::vector<std::uint32_t> numbers;
    for (const QuadTask& task : tasks) numbers.push_back(task.sequence);
    return numbers;
}

TEST(FragmentScheduler, DealsQuadsToThePipesInTurnOneEachPerCycle) {
    tests::QuadPass pass;
    pass.quads(6);
    SchedulerBench bench(pass, {.pipes = 3});
    bench.run();
    // Sent at cycle 0, received at 1, in the pipes at 2.
    for (std::uint32_t pipe = 0; pipe < 3; ++pipe) {
        EXPECT_EQ(bench.quads_of_pipe(pipe), (std::vector<pipeline::QuadId>{pipe, pipe + 3}));
        EXPECT_EQ(bench.cycles_of_pipe(pipe), (Cycles{2, 3}));
    }
}

TEST(FragmentScheduler, TellsTheReorderBufferTheOrderOfDispatch) {
    tests::QuadPass pass;
    pass.quads(20);
    SchedulerBench bench(pass, {.pipes = 3});
    bench.run();
    EXPECT_EQ(tests::quads_of(bench.back_end.order), tests::counting(20));
    EXPECT_EQ(sequences(bench.back_end.order), tests::counting(20));
    EXPECT_EQ(bench.scheduler.stats().quads, 20U);
    EXPECT_EQ(bench.scheduler.stats().fragments, 80U);
}

TEST(FragmentScheduler, PassesOverAPipeThatTakesNothing) {
    tests::QuadPass pass;
    pass.quads(20);
    SchedulerBench bench(pass, {.pipes = 2, .closed_pipe = 0});
    EXPECT_THROW(bench.run(), sim::DeadlockError);
    EXPECT_EQ(bench.quads_of_pipe(1).size(), 20U - 4U); // the other link holds four
}

TEST(FragmentScheduler, TileAffinitySendsATileToOnePipe) {
    KBufferPass pass;
    pass.quads(4 * 32); // an 8x8 tile of 64 pixels: 4 x 4 quads, eight tiles side by side
    SchedulingPlan plan = scoreboard_plan(pass, {"policy=tile_affinity"});
    SchedulerBench bench(pass, {.pipes = 3}, &plan);
    bench.run();
    std::map<std::uint32_t, std::uint32_t> pipe_of_tile;
    for (const auto& arrival : bench.back_end.arrivals) {
        const pipeline::Quad& quad = pass.stream.quads[arrival.task.quad];
        const auto found = pipe_of_tile.emplace(quad.y / 8U * 64U + quad.x / 8U, arrival.pipe).first;
        EXPECT_EQ(found->second, arrival.pipe);
    }
    for (std::uint32_t pipe = 0; pipe < 3; ++pipe) EXPECT_GT(bench.quads_of_pipe(pipe).size(), 0U);
    EXPECT_EQ(bench.scheduler.stats().quads, 128U);
}

TEST(FragmentScheduler, ATileOfTheGpuGoesToOnePipeInEveryDesign) {
    for (const std::uint32_t tile : {4U, 8U, 16U}) {
        KBufferPass pass;
        pass.quads(4 * 32);
        SchedulerBench bench(pass, {.scheduler = {.tile = tile}, .pipes = 3});
        bench.run();
        ASSERT_EQ(bench.back_end.arrivals.size(), 128U);
        for (const auto& arrival : bench.back_end.arrivals) {
            const pipeline::Quad& quad = pass.stream.quads[arrival.task.quad];
            EXPECT_EQ(arrival.pipe, (quad.x / tile + 3 * (quad.y / tile)) % 3) << tile;
        }
    }
}

TEST(FragmentScheduler, CountsPredecessorsAtEachLivingPixel) {
    KBufferPass pass;
    pass.quad(0, 0, 0b1111);
    pass.quad(0, 0, 0b0101);
    pass.quad(2, 0, 0b1111);
    pass.quad(0, 0, 0b1110);
    SchedulerBench bench(pass, {.pipes = 1});
    bench.run();
    using Order = std::array<std::uint32_t, 4>;
    EXPECT_EQ(bench.arrival(0).task.order, (Order{0, 0, 0, 0}));
    EXPECT_EQ(bench.arrival(1).task.order, (Order{1, 0, 1, 0}));
    EXPECT_EQ(bench.arrival(2).task.order, (Order{0, 0, 0, 0}));
    EXPECT_EQ(bench.arrival(3).task.order, (Order{0, 1, 2, 1}));
}

TEST(FragmentScheduler, WaitsForAPayloadSlotAndCountsTheStallOnce) {
    KBufferPass pass;
    pass.context.end = FragmentEnd::kbuffer_store;
    pass.quads(3);
    pipeline::QuadPayloads payloads(2, 4);
    SchedulerBench bench(pass, {.pipes = 4, .commit_after = 100}, nullptr, {}, &payloads);
    bench.run();
    // Two slots; the third quad takes the one that comes back with the commit: in the pipe at 2, 100 later committed,
    // one cycle on the link, one to the pipe.
    EXPECT_EQ(bench.arrival_of(0), 2U);
    EXPECT_EQ(bench.arrival_of(1), 2U);
    EXPECT_EQ(bench.arrival_of(2), 2U + 100 + 1 + 1);
    EXPECT_EQ(bench.scheduler.stats().slot_waits, 1U);
    EXPECT_EQ(bench.scheduler.stats().service_interval.count(), 3U);
    EXPECT_EQ(bench.scheduler.stats().service_interval.max(), 102U); // dispatch to commit
}

TEST(FragmentScheduler, StopsWhenTheReorderBufferIsFull) {
    tests::QuadPass pass;
    pass.quads(30);
    SchedulerBench bench(pass, {.pipes = 4, .reorder_places = 8, .order_from = 200});
    bench.run();
    EXPECT_EQ(bench.scheduler.stats().reorder_places_max, 8U);
    EXPECT_EQ(bench.arrival_of(7), 3U);
    EXPECT_GE(bench.arrival_of(8), 200U);
    EXPECT_GE(bench.scheduler.stats().reorder_waits, 1U);
    EXPECT_EQ(bench.scheduler.stats().quads, 30U);
}

// ---- flush

struct FlushCase {
    bool drain, writeback, invalidate;
};

class FragmentSchedulerFlush : public testing::TestWithParam<FlushCase> {};

// Two batches of one quad each. Commits come 100 cycles after the pipe, acknowledgements 40 after the command.
TEST_P(FragmentSchedulerFlush, WaitsForAndCommandsWhatItIsMadeOf) {
    const auto [drain, writeback, invalidate] = GetParam();
    KBufferPass pass;
    for (std::uint32_t i = 0; i < 2; ++i) {
        pass.triangle();
        pass.quad(8 * i, 0);
    }
    pipeline::QuadPayloads payloads(8, 4);
    pass.context.end = FragmentEnd::kbuffer_store;
    const pipeline::FlushRule flush{1, false, drain, writeback, invalidate};
    SchedulerBench bench(pass, {.pipes = 2, .commit_after = 100, .acknowledge_after = 40}, nullptr, flush, &payloads);
    bench.run();

    std::size_t writebacks = 0;
    for (const QuadTask& task : bench.back_end.order) writebacks += task.kind == pipeline::QuadKind::writeback ? 1 : 0;
    EXPECT_EQ(writebacks, writeback ? 1U : 0U);
    for (std::uint32_t pipe = 0; pipe < 2; ++pipe) EXPECT_EQ(bench.back_end.invalidations[pipe], invalidate ? 1U : 0U);
    EXPECT_EQ(bench.scheduler.stats().flushes, 1U);

    // The first quad is in its pipe at 2 and committed at 102, which the scheduler sees at 103.
    const sim::Cycle drained = 103;
    const sim::Cycle acknowledged = drained + 1 + 40 + 1; // command on its link, answer, its link
    const sim::Cycle second = bench.arrival_of(1);
    if (!drain)
        EXPECT_LE(second, 4U); // follows the commands at once
    else if (writeback)
        EXPECT_EQ(second, acknowledged + 1);
    else
        EXPECT_EQ(second, drained + (invalidate ? 2 : 1)); // an invalidation goes before it on the same link
}

INSTANTIATE_TEST_SUITE_P(Combinations, FragmentSchedulerFlush,
                         testing::Values(FlushCase{false, false, false}, FlushCase{false, false, true},
                                         FlushCase{false, true, false}, FlushCase{false, true, true},
                                         FlushCase{true, false, false}, FlushCase{true, false, true},
                                         FlushCase{true, true, false}, FlushCase{true, true, true}));

TEST(FragmentScheduler, FlushesBetweenBatchesOfTrianglesAndNotWithin) {
    KBufferPass pass;
    for (std::uint32_t i = 0; i < 7; ++i) {
        pass.triangle();
        pass.quad(2 * i, 0);
    }
    pass.context.end = FragmentEnd::kbuffer_store;
    pipeline::QuadPayloads payloads(8, 4);
    SchedulerBench bench(pass, {.pipes = 2, .commit_after = 10}, nullptr, {3, false, true, true, true}, &payloads);
    bench.run();
    EXPECT_EQ(bench.scheduler.stats().flushes, 2U); // 3 + 3 + 1
    EXPECT_LT(bench.arrival_of(2), bench.arrival_of(0) + 3);
    EXPECT_GT(bench.arrival_of(3), bench.arrival_of(2) + 10);
    EXPECT_GT(bench.arrival_of(6), bench.arrival_of(5) + 10);
}

TEST(FragmentScheduler, FlushesAtDrawBoundaries) {
    KBufferPass pass;
    for (const std::uint32_t draw : {0U, 0U, 1U, 2U}) {
        pass.triangle(draw);
        pass.quad(0, 0);
    }
    pass.context.end = FragmentEnd::kbuffer_store;
    pipeline::QuadPayloads payloads(8, 4);
    SchedulerBench bench(pass, {.pipes = 2, .commit_after = 10}, nullptr, {0, true, true, true, true}, &payloads);
    bench.run();
    EXPECT_EQ(bench.scheduler.stats().flushes, 2U);
}

TEST(FragmentScheduler, DrainAlsoWaitsForTheSideBuffer) {
    KBufferPass pass;
    pass.triangle();
    pass.quad(0, 0);
    pass.quad(0, 0); // waits in the side buffer
    pass.triangle();
    pass.quad(8, 8); // the next batch
    SchedulingPlan plan = scoreboard_plan(pass);
    SchedulerBench bench(pass, {.pipes = 4, .commit_after = 30}, &plan, {1, false, true, false, false});
    bench.run();
    EXPECT_EQ(bench.arrival_of(1), 34U);
    EXPECT_EQ(bench.arrival_of(2), 34U + 32U);
}

// ---- whatever the order of ticks

TEST(FragmentScheduler, SameInAllModes) {
    KBufferPass pass;
    std::mt19937 random(7);
    for (std::uint32_t i = 0; i < 300; ++i) {
        if (i % 5 == 0) pass.triangle();
        pass.quad(random() % 8 * 2, random() % 4 * 2, static_cast<std::uint8_t>(random() % 16));
    }
    pass.context.end = FragmentEnd::kbuffer_store;
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        SchedulingPlan plan = scoreboard_plan(pass, {"side_buffer=4", "granularity=pixel"});
        pipeline::QuadPayloads payloads(6, 4);
        SchedulerBench bench(pass,
                             {.pipes = 3,
                              .commit_after = 23,
                              .acknowledge_after = 11,
                              .reorder_places = 7,
                              .order_every = 3,
                              .mode = mode,
                              .shuffle = shuffle},
                             &plan, {10, false, true, true, true}, &payloads);
        bench.run();
        EXPECT_EQ(bench.scheduler.stats().quads, 300U);
        std::vector<std::tuple<std::uint32_t, pipeline::QuadId, sim::Cycle>> arrivals;
        for (const auto& [pipe, task, cycle] : bench.back_end.arrivals) arrivals.emplace_back(pipe, task.quad, cycle);
        std::sort(arrivals.begin(), arrivals.end());
        return std::tuple(arrivals, sim::to_json(bench.scheduler.stats()).dump(), bench.scheduler.activity_times());
    });
}

} // namespace fragment_scheduler_test
