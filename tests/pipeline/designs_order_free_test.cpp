// Designs that ask for no order, and the raster operation that peels: what they show, what they cost, what they drop.
// Source: specification 004, sections 7.4 and 8, checks K3, K10 and K15.
#include "tests/support/replay.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace designs_order_free_test {

using pipeline::RunResult;
using support::counter;
using support::Replay;

using Settings = std::vector<std::string>;

const std::string early = "early_depth_test/counters/";

double accepted_share(const RunResult& run) {
    return static_cast<double>(counter(run.stages, "rop/counters/insertions")) /
           static_cast<double>(counter(run.stages, "rop/counters/program_runs"));
}

/// Every fragment of the stack at one depth, in a colour of its own.
Replay all_at_one_depth() {
    Replay replay("gen:stack?n=20&x=0&y=0&w=32&h=32", {.width = 32, .height = 32});
    for (auto& depths : replay.streams[0].depths.own()) depths.fill(0.5F);
    replay.reference = pipeline::run_reference(replay.frame, replay.streams);
    return replay;
}

TEST(PeelRop, K15_EarlyRejectionNeverChangesTheResult) {
    for (const char* order : {"front-to-back", "back-to-front", "random"}) {
        const Replay replay(fmt::format("gen:stack?n=60&x=2&y=3&w=43&h=38&order={}", order),
                            {.width = 48, .height = 48});
        for (const char* reject : {"none", "tile", "pixel"}) {
            const RunResult run = replay.run("peel-rop", {fmt::format("peel-rop.early_reject={}", reject)});
            EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer) << order << ' ' << reject;
            EXPECT_EQ(run.wrong_pixels, 0U) << order << ' ' << reject;
        }
    }
}

TEST(PeelRop, K15_RejectionRisesWithSortingFromTheFront) {
    std::vector<std::uint64_t> rejected;
    for (const char* order : {"back-to-front", "random", "front-to-back"}) {
        const Replay replay(fmt::format("gen:stack?n=400&x=0&y=0&w=64&h=64&order={}", order),
                            {.width = 64, .height = 64});
        const RunResult run = replay.run("peel-rop");
        rejected.push_back(counter(run.stages, early + "fragments_beyond"));
        EXPECT_EQ(counter(run.stages, "rop/counters/fragments") + rejected.back(), 400U * 64 * 64);
    }
    EXPECT_EQ(rejected[0], 0U); // each layer is nearer than all before
    EXPECT_GT(rejected[1], rejected[0]);
    EXPECT_GT(rejected[2], rejected[1]);
    EXPECT_GT(rejected[2], 300U * 64 * 64); // all but four layers and those in flight
}

TEST(PeelRop, ATileThatIsNotCoveredWholeHasNoBoundButItsPixelsDo) {
    const Replay replay("gen:stack?n=400&x=0&y=0&w=2&h=2&order=front-to-back", {.width = 16, .height = 16});
    const auto rejected = [&](const char* reject) {
        return counter(replay.run("peel-rop", {fmt::format("peel-rop.early_reject={}", reject)}).stages,
                       early + "fragments_beyond");
    };
    EXPECT_EQ(rejected("tile"), 0U);
    EXPECT_GT(rejected("pixel"), 100U * 4);
}

TEST(PeelRop, K10_AcceptsWhatTheClosedFormSays) {
    // k + k (H_N - H_k) of N fragments in random order of depth.
    const Replay replay("gen:stack?n=16&x=0&y=0&w=1&h=1&order=random", {.width = 4, .height = 4});
    double accepted = 0;
    constexpr int runs = 4000;
    Replay shuffled = replay;
    sim::Random random(7, "depths");
    for (int i = 0; i < runs; ++i) {
        for (auto& depths : shuffled.streams[0].depths.own()) depths.fill(static_cast<float>(random.uniform()));
        shuffled.reference = pipeline::run_reference(shuffled.frame, shuffled.streams);
        accepted += static_cast<double>(shuffled.reference.accepted_insertions);
        if (i >= 20) continue; // the machine accepts what the reference does
        const RunResult run = shuffled.run("peel-rop", {"peel-rop.early_reject=none"});
        EXPECT_EQ(counter(run.stages, "rop/counters/insertions"), shuffled.reference.accepted_insertions);
    }
    EXPECT_NEAR(accepted / runs, 9.19, 0.01 * 9.19);
}

TEST(PeelRop, WritesOnlyTheEntriesThatMove) {
    const Replay front("gen:stack?n=500&x=0&y=0&w=2&h=2&order=front-to-back", {.width = 4, .height = 4});
    const Replay back("gen:stack?n=500&x=0&y=0&w=2&h=2&order=back-to-front", {.width = 4, .height = 4});
    const Settings plain{"peel-rop.early_reject=none"};
    const auto cycles = [&](const Replay& replay) {
        return counter(replay.run("peel-rop", plain).stages, "rop/counters/program_cycles");
    };
    // Four fragments on four ROPs of a partition: 1 cycle to reject, 1 + 64 B / 32 B to put one before all others.
    EXPECT_EQ(cycles(back), 500U * 3);
    EXPECT_LT(cycles(front), 510U);
}

TEST(OrderFree, FragmentsOfEqualDepthAreAllThatMayDiffer) {
    const Replay replay = all_at_one_depth();
    const std::vector<std::pair<std::string, Settings>> free{{"peel-rop", {"peel-rop.retirement=out_of_order"}},
                                                             {"interlock", {"interlock.ordered=false"}}};
    for (const auto& [design, settings] : free)
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            Settings all = settings;
            all.emplace_back("memory.controller.jitter_cycles=300");
            const RunResult run = replay.run(design, all, {.seed = seed});
            EXPECT_EQ(run.hazards.total(), 0U);
            EXPECT_EQ(run.tied_pixels, run.wrong_pixels) << design;
            EXPECT_EQ(run.unexplained_pixels(), 0U) << design;
        }
    // In order, the first arrival stays.
    EXPECT_EQ(replay.run("peel-rop").wrong_pixels, 0U);
    EXPECT_EQ(replay.run("interlock").wrong_pixels, 0U);
}

TEST(OrderFree, ResultsWithoutTiesAreTheReference) {
    for (const char* entry : {"rgbz", "z"}) {
        const Replay replay("gen:blob?triangles=6000&order=random",
                            {64, 64, "transparency", "auto", {fmt::format("entry={}", entry), "k=8"}});
        for (const auto& [design, settings] : std::vector<std::pair<std::string, Settings>>{
                 {"peel-rop", {"peel-rop.retirement=out_of_order"}}, {"interlock", {"interlock.ordered=false"}}}) {
            const RunResult run = replay.run(design, settings);
            EXPECT_EQ(run.wrong_pixels, 0U) << design << ' ' << entry;
        }
    }
}

TEST(AtomicMin, EntriesAreTheNearestDepths) {
    for (const std::uint32_t k : {1U, 4U, 16U}) {
        const Replay replay("gen:discs?n=300&overlap=12&width=64&height=64",
                            {64, 64, "transparency", "auto", {"entry=z", fmt::format("k={}", k)}});
        const RunResult run = replay.run("atomic-min");
        EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer) << k;
        EXPECT_EQ(run.hazards.total(), 0U);
        const std::uint64_t atomics = counter(run.stages, "rop/counters/atomics");
        EXPECT_GE(atomics, run.fragments);
        EXPECT_LE(atomics, run.fragments * k);
    }
}

TEST(AtomicMin, RefusesEntriesWiderThanAWord) {
    const Replay replay("gen:stack?n=2", {.width = 8, .height = 8});
    const std::vector<std::string> able = replay.designs();
    EXPECT_EQ(std::find(able.begin(), able.end(), "atomic-min"), able.end());
    EXPECT_THROW(replay.run("atomic-min"), sim::InputError);
}

TEST(OrderFree, TheUnitOfTheRopAcceptsAShareThatGrowsWithK) {
    double before = 0;
    for (const std::uint32_t k : {1U, 2U, 4U, 8U}) {
        const Replay replay("gen:stack?n=64&x=0&y=0&w=32&h=32&order=random",
                            {32, 32, "transparency", "auto", {fmt::format("k={}", k)}});
        const double share = accepted_share(replay.run("peel-rop", {"peel-rop.early_reject=none"}));
        EXPECT_GT(share, before);
        before = share;
    }
}

} // namespace designs_order_free_test
