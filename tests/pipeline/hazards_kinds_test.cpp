// Concurrency and incoherence: what each takes to happen, and that the books agree with the times they are kept by.
#include "tests/support/replay.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>

namespace hazards_kinds_test {

using Access = pipeline::HazardLedger::Access;
using pipeline::HazardClass;
using pipeline::HazardKind;
using pipeline::RunResult;
using support::Replay;
using Settings = std::vector<std::string>;

const Replay& discs() {
    static const Replay replay("gen:discs?n=60&overlap=8&width=64&height=64", {.width = 64, .height = 64});
    return replay;
}
const Replay& mesh() {
    static const Replay replay("gen:blob?triangles=8000", {.width = 64, .height = 64});
    return replay;
}

Settings visibility(const char* name, Settings more = {}) {
    more.push_back(std::string("existing.visibility=") + name);
    return more;
}
const std::vector<const char*> visibilities{"rop_cache", "writeback", "never_until_flush"};

struct Recorded {
    RunResult run;
    std::map<std::uint32_t, std::vector<Access>> by_place; ///< in raster order
};

Recorded recorded(const Replay& replay, const Settings& settings) {
    sim::Config config;
    for (const std::string& setting : settings) config.set(setting);
    pipeline::GpuParams gpu;
    config.read("", gpu);
    const auto design = models::make_design("existing", config);
    config.expect_all_used();
    pipeline::MachineOptions options;
    options.keep_accesses = true;
    pipeline::Machine machine(gpu, replay.frame, replay.streams, *design, options);
    Recorded result{machine.run(replay.reference), {}};
    for (const Access& access : machine.accesses()) result.by_place[access.place].push_back(access);
    for (auto& [place, accesses] : result.by_place)
        std::sort(accesses.begin(), accesses.end(), [](const Access& a, const Access& b) { return a.quad < b.quad; });
    return result;
}

/// Fragments that coherent reads at the recorded instants would have left without their latest predecessor, if every
/// store took `later` cycles more.
std::uint64_t missed(const Recorded& recorded, sim::Cycle later) {
    std::uint64_t count = 0;
    for (const auto& [place, accesses] : recorded.by_place)
        for (std::size_t i = 1; i < accesses.size(); ++i)
            count += accesses[i].read < accesses[i - 1].stored + later ? 1 : 0;
    return count;
}

TEST(HazardKinds, ReadsThatLookIntoTheTileCachePastTheL1AllTargetsAtOnceAreCoherent) {
    for (const Replay* replay : {&discs(), &mesh()}) {
        const RunResult run =
            replay->run("existing", visibility("rop_cache", {"existing.bypass_l1=true", "existing.atomic_reads=true"}));
        EXPECT_EQ(run.hazards.of(HazardKind::incoherence), 0U);
        EXPECT_GT(run.hazards.of(HazardKind::concurrency), 0U);
    }
}

// Where quads of a pixel may overtake, the one that was overtaken finds more than its predecessors: it misses nothing.
TEST(HazardKinds, OvertakenQuadsOfCoherentReadsAreNoIncoherence) {
    const RunResult run = discs().run(
        "scoreboard", {"scoreboard.order_rule=false", "scoreboard.granularity=pixel", "scoreboard.side_buffer=512"});
    EXPECT_EQ(run.hazards.of(HazardKind::incoherence), 0U);
    EXPECT_GT(run.hazards.of(HazardClass::h1_in_flight), 0U);
}

// What is left then are copies that nobody told of the store: tiles not written back, lines of the texture cache.
TEST(HazardKinds, PHY_H3_OneQuadAtATimeUntilItsStoreIsAppliedHasNoConcurrency) {
    for (const char* name : visibilities) {
        const RunResult run =
            mesh().run("existing", visibility(name, {"fragment.pipes=1", "scheduler.quads_until_store=1"}));
        EXPECT_EQ(run.hazards.of(HazardKind::concurrency), 0U) << name;
        EXPECT_GT(run.hazards.of(HazardKind::incoherence), 0U) << name;
        EXPECT_EQ(run.unexplained_pixels(), 0U) << name;
    }
    const RunResult coherent =
        mesh().run("existing", visibility("rop_cache", {"fragment.pipes=1", "scheduler.quads_until_store=1",
                                                        "existing.bypass_l1=true", "existing.atomic_reads=true"}));
    EXPECT_EQ(coherent.hazards.total(), 0U);
    EXPECT_EQ(coherent.wrong_pixels, 0U);
}

TEST(HazardKinds, InFlightIsAlwaysConcurrencyAndAStaleLineNever) {
    for (const char* name : visibilities)
        for (const Replay* replay : {&discs(), &mesh()}) {
            const RunResult run = replay->run("existing", visibility(name, {"texture.l1_bytes=65536"}));
            const auto& by = run.hazards.by;
            EXPECT_EQ(by[static_cast<std::size_t>(HazardClass::h1_in_flight)][1], 0U) << name;
            EXPECT_EQ(by[static_cast<std::size_t>(HazardClass::h3_stale_line)][0], 0U) << name;
            EXPECT_GT(run.hazards.total(), 0U) << name;
        }
}

// With atomic reads all targets of a fragment are read at one instant.
TEST(HazardKinds, RecordedTimesAgainstACoherentArrayGiveTheConcurrencyCount) {
    for (const char* name : visibilities)
        for (const Replay* replay : {&discs(), &mesh()}) {
            const Recorded record = recorded(*replay, visibility(name, {"existing.atomic_reads=true"}));
            EXPECT_EQ(missed(record, 0), record.run.hazards.of(HazardKind::concurrency)) << name;
        }
}

// Behind the read, latency only delays stores: on a given timeline it can make more reads stale, and no fewer.
TEST(HazardKinds, PHY_H5_MoreReturnLatencyOnARecordedTimelineNeverMeansFewerHazards) {
    const Recorded record =
        recorded(mesh(), visibility("rop_cache", {"existing.bypass_l1=true", "existing.atomic_reads=true",
                                                  "memory.controller.jitter_cycles=0"}));
    std::uint64_t before = missed(record, 0);
    EXPECT_EQ(before, record.run.hazards.total());
    for (const sim::Cycle later : {100U, 400U, 1600U, 6400U}) {
        const std::uint64_t now = missed(record, later);
        EXPECT_GT(now, before) << later;
        before = now;
    }
}

// Layers of 16 and 64 quads, whose values come from the tile cache or, where no store has been, from memory: whatever
// the way back, no layer is done when the next one reads.
TEST(HazardKinds, PHY_H1_LayersCloserThanTheWayBackMissTheirPredecessors) {
    for (const char* size : {"8", "16"})
        for (const int way_back : {280, 1000}) {
            const Replay layers(fmt::format("gen:stack?n=32&x=0&y=0&w={}&h={}", size, size),
                                {.width = 32, .height = 32});
            const RunResult run = layers.run(
                "existing", visibility("rop_cache", {"existing.bypass_l1=true", "existing.atomic_reads=true",
                                                     "memory.controller.jitter_cycles=0", "rop.read_request_latency=1",
                                                     fmt::format("rop.read_return_latency={}", way_back),
                                                     fmt::format("memory.controller.return_latency={}", way_back)}));
            EXPECT_EQ(run.hazards.total() * 32, run.fragments * 31) << size << ", " << way_back;
            EXPECT_EQ(run.hazards.of(HazardKind::concurrency), run.hazards.total());
        }
}

// One pixel, one quad a layer: a critical section is a read, the way back, the program through the whole pipe, a store.
TEST(HazardKinds, PHY_P5_TheProgramRunsInsideItsCriticalSection) {
    const auto cycles_per_quad = [](const char* design, std::uint32_t latency) {
        const auto cycles = [&](int layers) {
            const Replay stack(fmt::format("gen:stack?n={}&x=0&y=0&w=2&h=2", layers), {.width = 16, .height = 16});
            return stack.run(design, {fmt::format("fragment.latency={}", latency)}).cycles;
        };
        return static_cast<double>(cycles(200) - cycles(100)) / 100;
    };
    for (const char* design : {"framebuffer-fetch", "interlock", "rov", "scoreboard"}) {
        const double ways = design == std::string("scoreboard") ? 2 : 1; // of the pipe that lie between two releases
        EXPECT_NEAR(cycles_per_quad(design, 300) - cycles_per_quad(design, 30), ways * 270, 0.02 * ways * 270)
            << design;
    }
    EXPECT_GE(cycles_per_quad("framebuffer-fetch", 30), 74.0);
    EXPECT_LE(cycles_per_quad("framebuffer-fetch", 30), 82.0);
}

} // namespace hazards_kinds_test
