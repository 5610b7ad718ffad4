// Design `existing` in time: which hazards appear, of which class, and what they leave in the pixel.
// Source: specification 004, section 7.1 (read value rule, hazard classes, lemmas L1, L2, flush rule), checks K2, K5 to
// K7.
#include "tests/support/kbuffer_facts.hpp"
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>

namespace designs_existing_test {

using pipeline::HazardClass;
using pipeline::HazardPair;
using pipeline::QuadId;
using pipeline::RunResult;
using support::Replay;

using Settings = std::vector<std::string>;

Settings with(Settings settings, const Settings& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

const Replay& discs() {
    static const Replay replay("gen:discs?n=300&overlap=12&width=64&height=64", {.width = 64, .height = 64});
    return replay;
}

/// How many predecessors each hazardous read missed, by pixel and victim. Every hazard must be among the recorded
/// pairs.
std::map<std::pair<std::size_t, QuadId>, std::uint32_t> missing_reads(const RunResult& run, std::uint32_t width) {
    std::map<std::pair<std::size_t, QuadId>, std::uint32_t> missing;
    for (const HazardPair& pair : run.pairs)
        missing[{std::size_t{pair.y} * width + pair.x, pair.victim}] = pair.missing;
    return missing;
}

/// The two full-screen layers of K2, 65,536 quads apart.
const Replay& two_layers() {
    static const Replay replay("gen:quads?n=2", {.width = 512, .height = 512});
    return replay;
}

TEST(Existing, L1_AtomicReadsOnlyRemoveFragments) {
    const support::TrueFragments fragments(discs());
    for (const char* visibility : {"rop_cache", "writeback", "never_until_flush"}) {
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            const RunResult run =
                discs().run("existing",
                            {"existing.atomic_reads=true", std::string("existing.visibility=") + visibility,
                             "memory.controller.jitter_cycles=200"},
                            {.seed = seed});
            EXPECT_GT(run.hazards.total(), 0U);
            EXPECT_EQ(run.hazards.of(HazardClass::h4_torn_read), 0U);
            EXPECT_EQ(fragments.first_violation_of_l1(run.kbuffer), "") << visibility << ", seed " << seed;
        }
    }
}

TEST(Existing, L2_SurvivorsAreTheNearestOfTheChainOfReads) {
    const Replay replay("gen:discs?n=40&overlap=3&width=32&height=32&segments=8", {.width = 32, .height = 32});
    const auto quads = support::quads_by_pixel(replay.kbuffer_stream());
    for (const char* visibility : {"rop_cache", "writeback", "never_until_flush"}) {
        const RunResult run =
            replay.run("existing", {"existing.atomic_reads=true", std::string("existing.visibility=") + visibility});
        ASSERT_GT(run.hazards.total(), 100U);
        ASSERT_EQ(run.pairs.size(), run.hazards.total());
        const auto missing = missing_reads(run, 32);
        std::size_t wrong = 0;
        for (std::size_t pixel = 0; pixel < quads.size(); ++pixel) {
            // A read that missed m of its n predecessors saw what the (n - m)-th fragment stored.
            std::vector<QuadId> chain;
            for (std::size_t at = quads[pixel].size(); at > 0;) {
                chain.push_back(quads[pixel][--at]);
                const auto found = missing.find({pixel, chain.back()});
                if (found == missing.end()) continue;
                ASSERT_LE(found->second, at);
                at -= found->second;
            }
            if (support::pixel_of(replay, run.kbuffer, pixel) != support::entries_of_chain(replay, pixel, chain))
                ++wrong;
        }
        EXPECT_EQ(wrong, 0U) << visibility;
    }
}

TEST(Existing, HazardPairsNameTheLatestPredecessorThatWasMissed) {
    const Replay replay("gen:discs?n=40&overlap=3&width=32&height=32&segments=8", {.width = 32, .height = 32});
    const auto quads = support::quads_by_pixel(replay.kbuffer_stream());
    const RunResult run = replay.run("existing", {"existing.atomic_reads=true"});
    ASSERT_EQ(run.pairs.size(), run.hazards.total());
    for (const HazardPair& pair : run.pairs) {
        const auto& list = quads[std::size_t{pair.y} * 32 + pair.x];
        const auto victim = std::find(list.begin(), list.end(), pair.victim);
        ASSERT_NE(victim, list.end());
        ASSERT_NE(victim, list.begin());
        EXPECT_EQ(*(victim - 1), pair.aggressor); // stores are in raster order: what was missed includes the last one
        EXPECT_GE(pair.missing, 1U);
        EXPECT_LE(pair.missing, victim - list.begin());
        if (pair.cause != HazardClass::h3_stale_line) {
            EXPECT_LT(pair.read, pair.write + 100'000);
        }
    }
}

TEST(Existing, K2_RevisitAfter65536QuadsHasNoHazardInFlightOrOnTheWritePath) {
    const RunResult run = two_layers().run("existing");
    EXPECT_GE(two_layers().kbuffer_stream().quads.size(), 131'072U);
    EXPECT_EQ(run.hazards.of(HazardClass::h1_in_flight), 0U);
    EXPECT_EQ(run.hazards.of(HazardClass::h2_write_path), 0U);
}

TEST(Existing, K2_SmallTextureCacheHasEvictedEveryLineBeforeTheRevisit) {
    const RunResult run = two_layers().run("existing", {"existing.tex_coherence=none", "texture.l1_bytes=4096"});
    EXPECT_EQ(run.hazards.total(), 0U);
    EXPECT_EQ(run.wrong_pixels, 0U);
}

TEST(Existing, K2_UnboundedTextureCacheIsStaleAtEveryPixel) {
    // One pipe, so that the layer in front reads through the cache that the layer behind has filled.
    for (const char* visibility : {"rop_cache", "writeback"}) {
        const RunResult run = two_layers().run("existing", {"existing.tex_coherence=none", "texture.l1_bytes=67108864",
                                                            "fragment.pipes=1", "rop.kbuffer_cache_bytes=8192",
                                                            std::string("existing.visibility=") + visibility});
        EXPECT_EQ(run.hazards.of(HazardClass::h3_stale_line), 512U * 512U) << visibility;
        EXPECT_EQ(run.hazards.total(), 512U * 512U) << visibility;
        EXPECT_EQ(run.hazards.pixels, 512U * 512U) << visibility;
        EXPECT_EQ(run.wrong_pixels, 512U * 512U) << visibility;
        EXPECT_EQ(run.unexplained_pixels(), 0U) << visibility;
    }
}

TEST(Existing, K2_CoherentUnboundedTextureCacheHasNoStaleLine) {
    const RunResult run = two_layers().run(
        "existing", {"existing.tex_coherence=invalidate_on_write", "texture.l1_bytes=67108864", "fragment.pipes=1",
                     "rop.kbuffer_cache_bytes=8192", "existing.visibility=rop_cache"});
    EXPECT_EQ(run.hazards.total(), 0U);
}

TEST(Existing, InvalidationOnWriteLeavesNoStaleLines) {
    for (const char* visibility : {"rop_cache", "writeback"}) {
        const RunResult run = discs().run("existing", {"existing.tex_coherence=invalidate_on_write",
                                                       std::string("existing.visibility=") + visibility});
        EXPECT_GT(run.hazards.total(), 0U) << visibility;
        EXPECT_EQ(run.hazards.of(HazardClass::h3_stale_line), 0U) << visibility;
    }
}

namespace {

struct TornRun {
    std::uint64_t duplicate = 0, unsorted = 0, h4 = 0;
};

TornRun random_quads_run(std::uint32_t quads, bool atomic) {
    const Replay replay(fmt::format("gen:random-quads?n={}&area=4096", quads), {.width = 64, .height = 64});
    const RunResult run =
        replay.run("existing", {atomic ? "existing.atomic_reads=true" : "existing.atomic_reads=false",
                                "existing.visibility=rop_cache", "memory.controller.jitter_cycles=50"});
    EXPECT_EQ(run.fragments, std::uint64_t{4} * quads);
    EXPECT_GT(run.hazards.total(), 0U);
    TornRun torn{.h4 = run.hazards.of(HazardClass::h4_torn_read)};
    for (const pipeline::LayerErrors& layer : run.layers) {
        torn.duplicate += layer.duplicate;
        torn.unsorted += layer.unsorted;
    }
    return torn;
}

} // namespace

TEST(Existing, K5_AtomicReadsNeverDuplicateOrDisorder) {
    const TornRun torn = random_quads_run(50'000, true);
    EXPECT_EQ(torn.h4, 0U);
    EXPECT_EQ(torn.duplicate, 0U);
    EXPECT_EQ(torn.unsorted, 0U);
}

TEST(Existing, K5_TornReadsDuplicate) {
    const TornRun torn = random_quads_run(50'000, false);
    EXPECT_GT(torn.h4, 0U);
    EXPECT_GT(torn.duplicate, 0U);
}

TEST(Existing, K5_LongMillionFragmentsWithAtomicReadsNeverDuplicateOrDisorder) {
    const TornRun torn = random_quads_run(250'000, true);
    EXPECT_EQ(torn.h4, 0U);
    EXPECT_EQ(torn.duplicate, 0U);
    EXPECT_EQ(torn.unsorted, 0U);
    EXPECT_GT(random_quads_run(250'000, false).duplicate, 0U);
}

TEST(Existing, K6_FullFlushAfterEveryTriangleHasNoHazard) {
    for (const char* scene : {"gen:blob?triangles=2000", "gen:discs?n=60&overlap=6&width=64&height=64&segments=12"}) {
        const Replay replay(scene, {.width = 64, .height = 64});
        for (const char* visibility : {"rop_cache", "writeback", "never_until_flush"}) {
            for (const char* coherence : {"none", "invalidate_on_draw", "invalidate_on_write"}) {
                const RunResult run = replay.run("existing", {"existing.flush_triangles=1",
                                                              std::string("existing.visibility=") + visibility,
                                                              std::string("existing.tex_coherence=") + coherence});
                EXPECT_EQ(run.hazards.total(), 0U) << scene << ", " << visibility << ", " << coherence;
                EXPECT_EQ(run.wrong_pixels, 0U) << scene << ", " << visibility << ", " << coherence;
            }
        }
    }
}

TEST(Existing, K6_ResidualHazardsOf32TriangleBatchesLieWithinOneBatch) {
    const Replay replay("gen:discs?n=120&overlap=8&width=64&height=64&segments=12", {.width = 64, .height = 64});
    const auto& stream = replay.kbuffer_stream();
    const auto quads = support::quads_by_pixel(stream);
    const auto batch = [&](QuadId quad) { return stream.quads[quad].triangle / 32; };
    const RunResult unflushed = replay.run("existing");
    for (const char* visibility : {"rop_cache", "writeback", "never_until_flush"}) {
        const RunResult run =
            replay.run("existing", {"existing.flush_triangles=32", std::string("existing.visibility=") + visibility});
        EXPECT_GT(run.hazards.total(), 0U);
        EXPECT_LT(run.hazards.total(), unflushed.hazards.total());
        ASSERT_EQ(run.pairs.size(), run.hazards.total());
        for (const HazardPair& pair : run.pairs) {
            EXPECT_EQ(batch(pair.victim), batch(pair.aggressor));
            // The oldest predecessor missed lies in the batch, too.
            const auto& list = quads[std::size_t{pair.y} * 64 + pair.x];
            const auto victim = std::find(list.begin(), list.end(), pair.victim);
            EXPECT_EQ(batch(*(victim - pair.missing)), batch(pair.victim));
        }
    }
}

namespace {

/// Layers of 32x32 pixels, two triangles each, flushed layer by layer: every flush is followed by a revisit.
RunResult flushed_layers(const Settings& settings) {
    static const Replay replay("gen:stack?n=40&x=8&y=8&w=32&h=32", {.width = 64, .height = 64});
    return replay.run("existing", with({"existing.flush_triangles=2", "existing.tex_coherence=none", "fragment.pipes=1",
                                        "texture.l1_bytes=1048576"},
                                       settings));
}

} // namespace

TEST(Existing, K7_FlushWithoutWriteBackLeavesStoresUnseen) {
    EXPECT_EQ(flushed_layers({}).hazards.total(), 0U);
    for (const char* visibility : {"writeback", "never_until_flush"}) {
        const RunResult run =
            flushed_layers({"existing.writeback=false", std::string("existing.visibility=") + visibility});
        EXPECT_GT(run.hazards.of(HazardClass::h2_write_path), 0U) << visibility;
        EXPECT_EQ(run.hazards.of(HazardClass::h1_in_flight), 0U) << visibility;
    }
    // Where reads look into the ROP's tile cache there is nothing to write back.
    EXPECT_EQ(flushed_layers({"existing.writeback=false", "existing.visibility=rop_cache"}).hazards.total(), 0U);
}

TEST(Existing, K7_FlushWithoutInvalidationLeavesStaleLines) {
    for (const char* visibility : {"rop_cache", "writeback", "never_until_flush"}) {
        const RunResult run =
            flushed_layers({"existing.invalidate=false", std::string("existing.visibility=") + visibility});
        EXPECT_GT(run.hazards.of(HazardClass::h3_stale_line), 0U) << visibility;
        EXPECT_EQ(run.hazards.of(HazardClass::h1_in_flight), 0U) << visibility;
    }
}

TEST(Existing, K7_FlushWithoutDrainLeavesStoresInFlight) {
    EXPECT_GT(flushed_layers({"existing.drain=false", "fragment.pipes=24"}).hazards.of(HazardClass::h1_in_flight), 0U);
}

TEST(Existing, FlushAtDrawBoundariesSeparatesDraws) {
    const Replay replay("gen:grid-soup?boxes=200&boxes_per_draw=10", {.width = 64, .height = 64});
    const auto& stream = replay.kbuffer_stream();
    const auto draw = [&](QuadId quad) { return stream.triangles[stream.quads[quad].triangle].draw; };
    const RunResult run = replay.run("existing", {"existing.flush_draws=true"});
    EXPECT_EQ(support::counter(run.stages, "fragment_scheduler/counters/flushes"), 19U);
    for (const HazardPair& pair : run.pairs) EXPECT_EQ(draw(pair.victim), draw(pair.aggressor));
}

TEST(Existing, LosesFragmentsOnDenseMeshesAndOnDiscs) {
    const Replay blob("gen:blob?triangles=100000", {.width = 128, .height = 128});
    for (const Replay* replay : {&blob, &discs()}) {
        const RunResult run = replay->run("existing");
        EXPECT_GT(run.hazards.total(), 0U);
        EXPECT_GT(run.wrong_pixels, 0U);
        EXPECT_GT(run.lost_fragments, 0U);
        EXPECT_GT(run.lost_updates, 0U);
        EXPECT_EQ(run.unexplained_pixels(), 0U);
        EXPECT_LE(run.wrong_pixels, run.hazards.pixels);
    }
}

TEST(Existing, LongLosesFragmentsOnTheDensestScan) {
    const std::string scene = support::shared_scene("stanford_dragon_full/stanford_dragon_full.gltf");
    if (scene.empty()) GTEST_SKIP() << "no further scenes here: set ROPSIM_SHARED_DIR";
    const Replay replay(scene, {.width = 512, .height = 512});
    const RunResult run = replay.run("existing");
    EXPECT_GT(run.hazards.total(), 0U);
    EXPECT_GT(run.wrong_pixels, 0U);
    EXPECT_EQ(run.unexplained_pixels(), 0U);
    RecordProperty("hazards_per_million", static_cast<int>(1'000'000 * run.hazards.total() / run.fragments));
    RecordProperty("wrong_pixels", static_cast<int>(run.wrong_pixels));
}

TEST(Existing, LongLosesFragmentsOnTheDemoScene) {
    const std::string scene = support::demo_scene();
    if (scene.empty()) GTEST_SKIP() << "no demo scene here: ./demo makes it";
    const Replay replay(scene, {.width = 512, .height = 512});
    const RunResult run = replay.run("existing");
    EXPECT_GT(run.hazards.total(), 0U);
    EXPECT_GT(run.wrong_pixels, 0U);
    EXPECT_EQ(run.unexplained_pixels(), 0U);
    RecordProperty("hazards_per_million", static_cast<int>(1'000'000 * run.hazards.total() / run.fragments));
}

} // namespace designs_existing_test
