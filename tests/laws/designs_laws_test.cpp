// What must hold for every design, scene and seed: hazards and pictures, activities, determinism.
#include "tests/support/design_runs.hpp"
#include "tests/support/effort.hpp"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

namespace {

using pipeline::RunResult;
using support::counter;
using support::design_cases;
using support::DesignCase;
using support::for_every_run;
using support::jitter;
using support::Replay;
using support::ReplayOptions;
using support::Settings;

bool same_picture(const DesignCase& one, const RunResult& run) {
    return run.kbuffer == one.replay.reference.kbuffer && run.colour == one.replay.reference.colour;
}

void expect_the_reference_without_hazards(std::uint64_t seeds) {
    std::set<std::uint64_t> outcomes;
    for (const DesignCase& one : design_cases())
        for (const std::string& design : one.replay.designs())
            for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
                SCOPED_TRACE(fmt::format("{}, seed {}", support::run_text(one, design, {}), seed));
                const RunResult run = one.replay.run(design, jitter, {.seed = seed});
                EXPECT_EQ(run.unexplained_pixels(), 0U);
                // Triangles in another order have a reference of their own: it differs in ties.
                const bool same = support::keeps_submission(design) ? same_picture(one, run) : run.wrong_pixels == 0;
                EXPECT_EQ(same, run.wrong_pixels == 0);
                if (support::protects(design)) {
                    EXPECT_EQ(run.hazards.total(), 0U);
                    EXPECT_TRUE(same || (run.overflow_pixels > 0 && !support::holds_everything(design)));
                } else {
                    EXPECT_TRUE(same || run.hazards.total() > 0);
                }
                if (design == "existing" && &one == &design_cases()[0]) outcomes.insert(run.cycles);
            }
    EXPECT_GT(outcomes.size(), seeds / 4); // seeds matter
}

} // namespace

TEST(Laws, NoHazardMeansTheReferencePictureForEverySeed) {
    expect_the_reference_without_hazards(tests::repetitions(4));
}
TEST(LawsLong, NoHazardMeansTheReferencePictureForManySeeds) { expect_the_reference_without_hazards(16); }

TEST(Laws, EveryWrongPixelIsExplainedByARecordedHazard) {
    for_every_run(jitter, [](const DesignCase& one, const std::string& design, const Settings& settings) {
        for (std::uint64_t seed = 1; seed <= tests::repetitions(2); ++seed) {
            const RunResult run = one.replay.run(design, settings, {.seed = seed});
            EXPECT_EQ(run.unexplained_pixels(), 0U);
            const auto& hazards = run.hazards;
            EXPECT_EQ(hazards.total(), hazards.of(pipeline::HazardClass::h1_in_flight) +
                                           hazards.of(pipeline::HazardClass::h2_write_path) +
                                           hazards.of(pipeline::HazardClass::h3_stale_line) +
                                           hazards.of(pipeline::HazardClass::h4_torn_read));
            EXPECT_LE(hazards.pixels, hazards.total());
            EXPECT_EQ(std::accumulate(run.hazard_distance.begin(), run.hazard_distance.end(), std::uint64_t{0}),
                      hazards.total());
            EXPECT_EQ(std::count(run.wrong_mask.begin(), run.wrong_mask.end(), 1),
                      static_cast<std::ptrdiff_t>(run.wrong_pixels));
            EXPECT_EQ(run.hazard_mask.empty(), hazards.total() == 0);
            if (!run.hazard_mask.empty()) {
                EXPECT_EQ(run.hazard_mask.size() -
                              static_cast<std::size_t>(std::count(run.hazard_mask.begin(), run.hazard_mask.end(), 0)),
                          hazards.pixels);
            }
            for (const pipeline::HazardPair& pair : run.pairs) {
                EXPECT_LT(pair.aggressor, pair.victim);
                const std::size_t pixel = std::size_t{pair.y} * one.options.width + pair.x;
                EXPECT_NE(run.hazard_mask[pixel] >> static_cast<unsigned>(pair.cause) & 1U, 0U);
            }
        }
    });
}

TEST(Laws, ActivitiesOfEveryUnitSumToTheElapsedTime) {
    for_every_run(jitter, [](const DesignCase& one, const std::string& design, const Settings& settings) {
        const RunResult run = one.replay.run(design, settings);
        for (const auto& stage : run.stages->items()) {
            SCOPED_TRACE(stage.key());
            std::uint64_t sum = 0;
            for (const auto& activity : stage.value().at("activity").items())
                sum += activity.value().get<std::uint64_t>();
            const std::uint64_t units = stage.key() == "memory_partition" ? 4
                                        : stage.value().contains("units") ? counter(stage.value(), "units")
                                                                          : 1;
            EXPECT_EQ(sum, units * run.cycles);
        }
        for (const auto& stage : run.stalls->items()) {
            double sum = 0;
            for (const auto& activity : stage.value().items()) sum += activity.value().get<double>();
            EXPECT_NEAR(sum, 1.0, 1e-9) << stage.key();
        }
    });
}

TEST(Laws, SameInputsGiveTheSameBytes) {
    for (const DesignCase& one : design_cases()) {
        ReplayOptions one_thread = one.options, two_threads = one.options;
        one_thread.threads = 1;
        two_threads.threads = 2;
        const Replay first(one.scene, one_thread), second(one.scene, two_threads);
        EXPECT_TRUE(first.reference.kbuffer == second.reference.kbuffer);
        EXPECT_TRUE(first.reference.colour == second.reference.colour);
        EXPECT_TRUE(first.reference.picture == second.reference.picture);
        for (const auto& [design, settings] : support::design_variants()) {
            if (!one.allows(design)) continue;
            SCOPED_TRACE(support::run_text(one, design, settings));
            const RunResult run = one.replay.run(design, support::joined(settings, jitter), {.seed = 7});
            EXPECT_EQ(support::difference(run, first.run(design, support::joined(settings, jitter), {.seed = 7})), "");
            EXPECT_EQ(support::difference(run, second.run(design, support::joined(settings, jitter), {.seed = 7})), "");
        }
    }
}

TEST(Laws, ResultDoesNotDependOnTheOrderOfTicks) {
    for_every_run(jitter, [](const DesignCase& one, const std::string& design, const Settings& settings) {
        const RunResult run = one.replay.run(design, settings, {.seed = 3});
        EXPECT_EQ(support::difference(run, one.replay.run(design, settings, {.seed = 3, .mode = sim::Mode::shuffled})),
                  "");
    });
}

namespace {

void expect_the_same_without_sleep(std::size_t every) {
    for_every_run(
        jitter,
        [](const DesignCase& one, const std::string& design, const Settings& settings) {
            const RunResult run = one.replay.run(design, settings, {.seed = 3});
            EXPECT_EQ(
                support::difference(run, one.replay.run(design, settings, {.seed = 3, .mode = sim::Mode::never_sleep})),
                "");
        },
        every);
}

} // namespace

TEST(Laws, ResultDoesNotDependOnSleeping) { expect_the_same_without_sleep(5); }
TEST(LawsLong, ResultDoesNotDependOnSleepingInAnyRun) { expect_the_same_without_sleep(1); }

namespace {

/// Sees everything and does nothing.
class Watcher final : public sim::Observer {
  public:
    void activity(const sim::Component&, sim::Activity, sim::Time, sim::Time) override { ++seen; }
    void message(const sim::ChannelBase&, sim::Time, sim::Time) override { ++seen; }
    std::uint64_t seen = 0;
};

} // namespace

TEST(Laws, WatchingChangesNothing) {
    for (const std::string& design : design_cases()[0].replay.designs()) {
        SCOPED_TRACE(design);
        Watcher watcher;
        std::atomic<std::uint64_t> quads{0};
        const RunResult run = design_cases()[0].replay.run(design);
        EXPECT_EQ(support::difference(
                      run, design_cases()[0].replay.run(design, {}, {.quads_done = &quads, .observer = &watcher})),
                  "");
        EXPECT_GT(watcher.seen, 0U);
    }
}
