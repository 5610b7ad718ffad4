// The fragment scheduler with the scoreboard's guard and side buffer: which quads are held back, and for how long.
#include "tests/support/scheduler_kit.hpp"

#include <string>

namespace fragment_scheduler_guard_test {

using pipeline::SchedulingPlan;
using tests::KBufferPass;
using tests::SchedulerBench;
using tests::scoreboard_plan;

TEST(FragmentScheduler, HoldsAConflictingQuadWhileOthersPass) {
    KBufferPass pass;
    pass.quad(0, 0);
    pass.quad(0, 0); // conflicts
    pass.quad(4, 0);
    pass.quad(6, 0);
    SchedulingPlan plan = scoreboard_plan(pass);
    SchedulerBench bench(pass, {.pipes = 4, .commit_after = 50}, &plan);
    bench.run();
    EXPECT_EQ(bench.arrival_of(0), 2U);
    EXPECT_EQ(bench.arrival_of(2), 2U);
    EXPECT_EQ(bench.arrival_of(3), 2U);
    // Commit sent at 52, received at 53, dispatched in the same cycle, in the pipe at 54.
    EXPECT_EQ(bench.arrival_of(1), 54U);
    EXPECT_EQ(bench.scheduler.stats().true_conflicts, 1U);
    EXPECT_EQ(bench.scheduler.stats().inserted, 1U);
    EXPECT_EQ(bench.scheduler.stats().residence.max(), 52U); // inserted at 1
    EXPECT_EQ(bench.scheduler.stats().waiting_max, 1U);
}

TEST(FragmentScheduler, StackOnOnePixelIsServedOneAtATime) {
    KBufferPass pass;
    for (std::uint32_t i = 0; i < 10; ++i) pass.quad(0, 0);
    SchedulingPlan plan = scoreboard_plan(pass);
    SchedulerBench bench(pass, {.pipes = 4, .commit_after = 40}, &plan);
    bench.run();
    for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(bench.arrival_of(i), 2U + i * 42U);
}

TEST(FragmentScheduler, LooksUpSoManyQuadsPerCycle) {
    KBufferPass pass;
    pass.quads(12);
    SchedulingPlan plan = scoreboard_plan(pass, {"lookups=2"});
    SchedulerBench bench(pass, {.pipes = 6}, &plan);
    bench.run();
    EXPECT_EQ(bench.arrival_of(1), 2U);
    EXPECT_EQ(bench.arrival_of(2), 3U);
    EXPECT_EQ(bench.arrival_of(11), 2U + 5U);
}

TEST(FragmentScheduler, WakesSoManyQuadsPerCycleOldestFirst) {
    KBufferPass pass;
    for (const std::uint32_t x : {0U, 4U, 8U, 0U, 4U, 8U}) pass.quad(x, 0);
    for (const std::uint32_t wakes : {1U, 3U}) {
        SchedulingPlan plan = scoreboard_plan(pass, {"lookups=6", "wakes=" + std::to_string(wakes)});
        SchedulerBench bench(pass, {.pipes = 6, .commit_after = 30}, &plan);
        bench.run();
        EXPECT_EQ(bench.arrival_of(3), 34U);
        EXPECT_EQ(bench.arrival_of(4), wakes == 1 ? 35U : 34U);
        EXPECT_EQ(bench.arrival_of(5), wakes == 1 ? 36U : 34U);
    }
}

TEST(FragmentScheduler, OrderRuleHoldsAQuadBehindAnOlderOneOfItsArea) {
    KBufferPass pass;
    pass.quad(0, 0, 0b0001);
    pass.quad(0, 0, 0b0011); // pixel 0 is in flight
    pass.quad(0, 0, 0b0010); // pixel 1 is not
    SchedulingPlan with = scoreboard_plan(pass, {"granularity=pixel"});
    SchedulerBench ordered(pass, {.pipes = 4, .commit_after = 50}, &with);
    ordered.run();
    EXPECT_EQ(ordered.scheduler.stats().order_waits, 1U);
    EXPECT_LT(ordered.arrival_of(1), ordered.arrival_of(2));
    SchedulingPlan without = scoreboard_plan(pass, {"granularity=pixel", "order_rule=false"});
    SchedulerBench unordered(pass, {.pipes = 4, .commit_after = 50}, &without);
    unordered.run();
    EXPECT_EQ(unordered.scheduler.stats().order_waits, 0U);
    EXPECT_EQ(unordered.arrival_of(2), 2U);
    EXPECT_GT(unordered.arrival_of(1), unordered.arrival_of(2));
}

TEST(FragmentScheduler, FalseConflictsAreThoseOfTheAreaOnly) {
    KBufferPass pass;
    pass.quad(0, 0);
    pass.quad(2, 0); // another quad of the same 8x8 tile
    pass.quad(8, 0); // the next tile
    SchedulingPlan plan = scoreboard_plan(pass, {"granularity=tile8"});
    SchedulerBench bench(pass, {.pipes = 4, .commit_after = 20}, &plan);
    bench.run();
    EXPECT_EQ(bench.scheduler.stats().false_conflicts, 1U);
    EXPECT_EQ(bench.scheduler.stats().true_conflicts, 0U);
    EXPECT_EQ(bench.arrival_of(2), 2U);
    EXPECT_GT(bench.arrival_of(1), 20U);
}

TEST(FragmentScheduler, ConflictWithAWaitingQuadIsTrueAndCountedAtTheFirstLookup) {
    KBufferPass pass;
    pass.quad(0, 0);
    pass.quad(2, 0);                                                     // waits: another quad of the same 8x8 tile
    pass.quad(2, 0);                                                     // its pixels are not in flight, but wait
    pass.quad(4, 0);                                                     // nobody's pixels
    for (const char* side_buffer : {"side_buffer=8", "side_buffer=0"}) { // the second: all are held at the input
        SchedulingPlan plan = scoreboard_plan(pass, {"granularity=tile8", side_buffer});
        SchedulerBench bench(pass, {.pipes = 4, .commit_after = 20}, &plan);
        bench.run();
        EXPECT_EQ(bench.scheduler.stats().true_conflicts, 1U) << side_buffer;
        EXPECT_EQ(bench.scheduler.stats().false_conflicts, 2U) << side_buffer;
        EXPECT_EQ(bench.scheduler.stats().order_waits, 0U) << side_buffer;
    }
}

TEST(FragmentScheduler, FullSideBufferStallsTheRasterizerOnce) {
    KBufferPass pass;
    for (std::uint32_t i = 0; i < 4; ++i) pass.quad(0, 0);
    pass.quad(8, 8);
    SchedulingPlan plan = scoreboard_plan(pass, {"side_buffer=2", "lookups=8"});
    SchedulerBench bench(pass, {.pipes = 8, .commit_after = 60}, &plan);
    bench.run();
    EXPECT_EQ(bench.scheduler.stats().overflow_stalls, 1U);
    EXPECT_EQ(bench.scheduler.stats().waiting_max, 2U);
    EXPECT_EQ(bench.scheduler.stats().inserted, 3U);
    EXPECT_GT(bench.arrival_of(4), 60U); // behind the stall, though its pixels are free
    EXPECT_GT(bench.scheduler.activity_times()[static_cast<std::size_t>(sim::Activity::hazard)], 50'000U);
}

TEST(FragmentScheduler, NoSideBufferStallsAtTheFirstConflict) {
    KBufferPass pass;
    pass.quad(0, 0);
    pass.quad(0, 0);
    pass.quad(8, 8);
    SchedulingPlan plan = scoreboard_plan(pass, {"side_buffer=0"});
    SchedulerBench bench(pass, {.pipes = 4, .commit_after = 60}, &plan);
    bench.run();
    EXPECT_EQ(bench.scheduler.stats().inserted, 0U);
    EXPECT_EQ(bench.arrival_of(1), 2U + 60 + 2);
    EXPECT_EQ(bench.arrival_of(2), 2U + 60 + 2);
}

TEST(FragmentScheduler, QuadsWithoutALivingPixelPassTheGuard) {
    KBufferPass pass;
    pass.quad(0, 0);
    pass.quad(0, 0, 0);
    SchedulingPlan plan = scoreboard_plan(pass);
    SchedulerBench bench(pass, {.pipes = 4, .commit_after = 60}, &plan);
    bench.run();
    EXPECT_EQ(bench.arrival_of(1), 2U);
    EXPECT_EQ(bench.scheduler.stats().bypassed, 1U);
}

TEST(FragmentScheduler, GuardIsNotAskedInPassesThatDoNotTouchTheKBuffer) {
    tests::QuadPass pass; // ends in the depth test
    for (std::uint32_t i = 0; i < 4; ++i) pass.quad(0, 0);
    SchedulingPlan plan = scoreboard_plan(pass);
    SchedulerBench bench(pass, {.pipes = 4, .commits = false}, &plan);
    bench.run();
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(bench.arrival_of(i), 2U);
}

} // namespace fragment_scheduler_guard_test
