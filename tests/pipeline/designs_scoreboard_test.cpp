// Design `scoreboard` in time: what a conflict costs, and what none costs.
// Source: specification 004, section 7.2 and check K11.
#include "tests/support/replay.hpp"

#include <array>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace designs_scoreboard_test {

using pipeline::RunResult;
using support::counter;
using support::Replay;

using Settings = std::vector<std::string>;

const std::string scheduler = "fragment_scheduler/counters/";

/// L_rw: cycles from the dispatch of a quad to the commit that lets the next one of its pixels go.
double service_interval(const RunResult& run) {
    const auto& histogram = run.stages->at("fragment_scheduler").at("counters").at("service_interval");
    return histogram.at("sum").get<double>() / histogram.at("count").get<double>();
}

double cycles_of_geometry(const RunResult& run) {
    return static_cast<double>(support::pass_named(run, "geometry").cycles);
}

TEST(ScoreboardDesign, K11_StackOnOnePixelTakesItsLengthTimesTheServiceInterval) {
    constexpr double n = 1000;
    const Replay replay("gen:stack?n=1000&order=random", {.width = 16, .height = 16});
    for (const Settings& settings :
         {Settings{}, Settings{"scoreboard.granularity=pixel"}, Settings{"scoreboard.granularity=tile16"},
          Settings{"scoreboard.visibility=writeback"},
          Settings{"rop.read_request_latency=10", "rop.read_return_latency=10"}}) {
        const RunResult run = replay.run("scoreboard", settings);
        const double interval = service_interval(run);
        EXPECT_EQ(run.hazards.total(), 0U);
        EXPECT_NEAR(cycles_of_geometry(run), n * interval, 0.02 * n * interval)
            << fmt::format("{}", fmt::join(settings, " "));
        RecordProperty(settings.empty() ? "L_rw" : "L_rw of " + settings[0], fmt::format("{:.1f}", interval));
        // Only one is ever in flight: a new one leaves with the commit of the one before.
        EXPECT_EQ(counter(run.stages, "fragment_pipeline/counters/in_flight_max"), 1U);
    }
}

TEST(ScoreboardDesign, K11_ServiceIntervalOfTheDefaultsIsThatOfTheSpecification) {
    const Replay replay("gen:stack?n=100", {.width = 16, .height = 16});
    const double interval = service_interval(replay.run("scoreboard"));
    EXPECT_GE(interval, 330);
    EXPECT_LE(interval, 600);
}

TEST(ScoreboardDesign, K11_DisjointStreamIsAsFastAsWithoutScoreboard) {
    // Four fragments a quad, no pixel twice.
    traces::Scene scene = traces::load_scene("gen:quads?n=1");
    const Replay replay(scene, {.width = 512, .height = 512});
    for (const char* granularity : {"pixel", "quad"}) {
        const RunResult with = replay.run("scoreboard", {std::string("scoreboard.granularity=") + granularity});
        const RunResult without = replay.run("existing");
        EXPECT_EQ(counter(with.stages, scheduler + "true_conflicts"), 0U);
        EXPECT_LE(cycles_of_geometry(with), 1.02 * cycles_of_geometry(without)) << granularity;
        RecordProperty(std::string("slowdown_") + granularity,
                       fmt::format("{:.4f}", cycles_of_geometry(with) / cycles_of_geometry(without)));
    }
}

TEST(ScoreboardDesign, K11_WithoutSideBufferTheFirstConflictStallsTheRasterizer) {
    const Replay two("gen:stack?n=2", {.width = 16, .height = 16});
    const RunResult first = two.run("scoreboard", {"scoreboard.side_buffer=0"});
    EXPECT_EQ(counter(first.stages, scheduler + "overflow_stalls"), 1U);
    EXPECT_EQ(counter(first.stages, scheduler + "inserted"), 0U);

    const Replay many("gen:stack?n=64", {.width = 16, .height = 16});
    const RunResult none = many.run("scoreboard", {"scoreboard.side_buffer=0"});
    EXPECT_EQ(counter(none.stages, scheduler + "overflow_stalls"), 63U);
    const RunResult enough = many.run("scoreboard", {"scoreboard.side_buffer=63"});
    EXPECT_EQ(counter(enough.stages, scheduler + "overflow_stalls"), 0U);
    EXPECT_EQ(counter(enough.stages, scheduler + "waiting_max"), 63U);
    EXPECT_EQ(counter(enough.stages, scheduler + "inserted"), 63U);
    const RunResult one = many.run("scoreboard", {"scoreboard.side_buffer=1"});
    EXPECT_EQ(counter(one.stages, scheduler + "waiting_max"), 1U);
    // A stack has nothing else to send: the buffer does not help.
    EXPECT_EQ(none.cycles, enough.cycles);
}

TEST(ScoreboardDesign, K11_SideBufferHelpsWhenLaterQuadsGoElsewhere) {
    // A stack of two, then quads that are in nobody's way.
    const Replay replay("gen:random-quads?n=20000&area=4096", {.width = 64, .height = 64});
    double before = 0;
    for (const int size : {0, 8, 32}) {
        // All tiles stay on chip, so that conflicts and not memory set the pace.
        const RunResult run = replay.run(
            "scoreboard", {fmt::format("scoreboard.side_buffer={}", size), "rop.kbuffer_cache_bytes=524288"});
        const double cycles = cycles_of_geometry(run);
        if (size != 0) {
            EXPECT_LT(cycles, before) << size;
        }
        before = cycles;
    }
}

TEST(ScoreboardDesign, K11_FinerGranularityIsFasterOnADenseMesh) {
    const Replay replay("gen:blob?triangles=100000", {.width = 128, .height = 128});
    std::vector<double> cycles;
    for (const char* granularity : {"pixel", "quad", "tile4", "tile8", "tile16"}) {
        const RunResult run = replay.run("scoreboard", {std::string("scoreboard.granularity=") + granularity});
        EXPECT_EQ(run.hazards.total(), 0U);
        cycles.push_back(cycles_of_geometry(run));
        RecordProperty(std::string("cycles_") + granularity, fmt::format("{:.0f}", cycles.back()));
    }
    EXPECT_TRUE(std::is_sorted(cycles.begin(), cycles.end()));
    EXPECT_GT(cycles[3], 2 * cycles[0]); // false conflicts of 8x8 tiles dominate
}

TEST(ScoreboardDesign, CountsEveryHeldQuadUnderOneCause) {
    const Replay replay("gen:blob?triangles=20000", {.width = 64, .height = 64});
    for (const char* granularity : {"pixel", "quad", "tile8"})
        for (const int entries : {0, 50})
            for (const int places : {32, 65536}) {
                const RunResult run = replay.run("scoreboard", {std::string("scoreboard.granularity=") + granularity,
                                                                fmt::format("scoreboard.entries={}", entries),
                                                                fmt::format("scoreboard.side_buffer={}", places)});
                const std::uint64_t held = counter(run.stages, scheduler + "true_conflicts") +
                                           counter(run.stages, scheduler + "false_conflicts");
                const std::uint64_t inserted = counter(run.stages, scheduler + "inserted");
                // One that finds the buffer full is held at the input, and may go on from there.
                EXPECT_GE(held, inserted);
                EXPECT_LE(held, inserted + counter(run.stages, scheduler + "overflow_stalls"));
                EXPECT_LE(counter(run.stages, scheduler + "order_waits"), held);
                EXPECT_EQ(counter(run.stages, scheduler + "residence/count"), inserted);
                EXPECT_EQ(counter(run.stages, scheduler + "waiting/count"), inserted);
                EXPECT_GT(counter(run.stages, scheduler + "true_conflicts"), 0U);
            }
}

namespace {

constexpr std::array<const char*, 5> granularities{"pixel", "quad", "tile4", "tile8", "tile16"};

/// True and false conflicts of squares of 8x8 pixels on each other, by granularity. A square is two triangles in 20
/// quads: four of the 16 are cut by the diagonal.
std::vector<std::array<std::uint64_t, 2>> conflicts_of_layers(int layers) {
    const Replay replay(fmt::format("gen:stack?n={}&x=0&y=0&w=8&h=8", layers), {.width = 16, .height = 16});
    std::vector<std::array<std::uint64_t, 2>> conflicts;
    for (const char* granularity : granularities) {
        const RunResult run = replay.run(
            "scoreboard", {std::string("scoreboard.granularity=") + granularity, "scoreboard.side_buffer=512"});
        EXPECT_EQ(counter(run.stages, scheduler + "quads"), 20U * static_cast<unsigned>(layers));
        conflicts.push_back(
            {counter(run.stages, scheduler + "true_conflicts"), counter(run.stages, scheduler + "false_conflicts")});
    }
    return conflicts;
}

} // namespace

// One layer covers no pixel twice: whatever is held is held falsely, all quads of an area but the first.
TEST(ScoreboardDesign, PHY_H8_OneLayerHasFalseConflictsOnly) {
    const auto conflicts = conflicts_of_layers(1);
    const std::array<std::uint64_t, 5> areas{20, 16, 4, 1, 1};
    for (std::size_t i = 0; i < granularities.size(); ++i) {
        EXPECT_EQ(conflicts[i][0], 0U) << granularities[i];
        EXPECT_EQ(conflicts[i][1], 20 - areas[i]) << granularities[i];
    }
}

// Each quad of the second layer lies on one of the first, which is in flight or waits itself, whatever area is guarded.
TEST(ScoreboardDesign, PHY_H9_SecondLayerConflictsTrulyAtEveryGranularity) {
    const auto conflicts = conflicts_of_layers(2);
    for (std::size_t i = 0; i < granularities.size(); ++i) EXPECT_EQ(conflicts[i][0], 20U) << granularities[i];
    EXPECT_EQ(conflicts[0][1], 0U);
}

// More quads in flight do not wait less: those that run ahead touch tiles long before older quads come back to theirs,
// which the tile caches have replaced by then. Likewise Rogers, O'Connor, Aamodt, "Cache-conscious wavefront
// scheduling", MICRO 2012: more threads than a cache can hold the data of make it thrash.
TEST(ScoreboardDesign, PHY_H11_ALargerSideBufferLosesWhatTheTileCachesCannotHold) {
    const Replay replay("gen:discs?n=150&overlap=8&width=128&height=128", {.width = 128, .height = 128});
    const auto run = [&](int places, const char* tiles) {
        return replay.run("scoreboard", {fmt::format("scoreboard.side_buffer={}", places), tiles});
    };
    const auto misses = [](const RunResult& run) { return counter(run.stages, "rop/counters/kbuffer_tiles/misses"); };
    const RunResult few = run(128, "rop.kbuffer_cache_bytes=131072"),
                    many = run(8192, "rop.kbuffer_cache_bytes=131072");
    EXPECT_GT(misses(many), misses(few) * 3 / 2);
    EXPECT_GT(many.cycles, few.cycles);
    // With all tiles on chip nothing is lost.
    const RunResult few_on_chip = run(128, "rop.kbuffer_cache_bytes=1048576"),
                    many_on_chip = run(8192, "rop.kbuffer_cache_bytes=1048576");
    EXPECT_EQ(misses(many_on_chip), misses(few_on_chip));
    EXPECT_LE(cycles_of_geometry(many_on_chip), 1.02 * cycles_of_geometry(few_on_chip));
}

// But for the order rule, which holds a quad behind a waiting one of its 2x2 block though their masks are disjoint.
TEST(ScoreboardDesign, PixelMasksHaveNoFalseConflictUnlessHashed) {
    const Replay replay("gen:blob?triangles=20000", {.width = 64, .height = 64});
    const RunResult full = replay.run("scoreboard", {"scoreboard.granularity=pixel"});
    EXPECT_LE(counter(full.stages, scheduler + "false_conflicts"), counter(full.stages, scheduler + "order_waits"));
    const RunResult free = replay.run("scoreboard", {"scoreboard.granularity=pixel", "scoreboard.order_rule=false"});
    EXPECT_EQ(counter(free.stages, scheduler + "false_conflicts"), 0U);
    EXPECT_GT(counter(free.stages, scheduler + "true_conflicts"), 0U);
    const RunResult hashed = replay.run(
        "scoreboard", {"scoreboard.granularity=pixel", "scoreboard.order_rule=false", "scoreboard.entries=20"});
    EXPECT_GT(counter(hashed.stages, scheduler + "false_conflicts"), 0U);
    EXPECT_GT(hashed.cycles, free.cycles);
}

TEST(ScoreboardDesign, AreaIsThatOfTheSpecification) {
    // 512^2 at 2x2: 65,536 counters of 11 bits; at 8x8: 4,096.
    const Replay replay("gen:stack?n=2", {.width = 512, .height = 512});
    EXPECT_EQ(counter(replay.run("scoreboard").area, "added/scoreboard"), 65'536U * 11U / 8U);
    EXPECT_EQ(counter(replay.run("scoreboard", {"scoreboard.granularity=tile8"}).area, "added/scoreboard"),
              4'096U * 11U / 8U);
}

} // namespace designs_scoreboard_test
