// The books of the output stage: layout of surfaces, tile tags, versions of pixels, classes of hazards.
#include "models/programs/library.hpp"
#include "pipeline/image_difference.hpp"
#include "pipeline/output/hazard_ledger.hpp"
#include "pipeline/output/kbuffer_memory.hpp"
#include "pipeline/output/programmable_blender.hpp"
#include "pipeline/output/tile_cache.hpp"
#include "sim/check.hpp"

#include <gtest/gtest.h>
#include <set>

namespace {

using namespace pipeline;

constexpr SurfaceLayout layout{10, 7, 4}; // odd sizes: the last tiles hang over the edge

/// A ledger whose pixel 0 of block 0 was stored by quad 5: retired at 100, stored at 110, visible from 120 on.
struct LedgerTest : testing::Test {
    StoreHistory history{layout};
    HazardLedger ledger{layout, history};
    void SetUp() override { ledger.enter(0, 0, 5, 100, 110, 120); }
    HazardCounts book(std::uint32_t oldest, std::uint32_t newest, sim::Cycle read) {
        ledger.book(0, 0, 9, {3, oldest, newest, read});
        return ledger.counts();
    }
};

} // namespace

TEST(SurfaceLayoutTest, EveryPixelHasABlockOfItsOwnAndItsWayBack) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (std::uint32_t y = 0; y < layout.height; ++y)
        for (std::uint32_t x = 0; x < layout.width; ++x) {
            const std::uint32_t block = layout.block_of(x, y);
            ASSERT_LT(block, layout.blocks());
            EXPECT_EQ(layout.block_x(block), x / 2 * 2);
            EXPECT_EQ(layout.block_y(block), y / 2 * 2);
            EXPECT_EQ(SurfaceLayout::tile_of_block(block), layout.tile_of(x, y));
            EXPECT_TRUE(seen.insert({block, y % 2 * 2 + x % 2}).second);
        }
}

TEST(SurfaceLayoutTest, NeighbouringTilesLieInDifferentPartitions) {
    for (const std::uint32_t partitions : {2U, 4U, 8U}) {
        const SurfaceLayout wide{64, 64, partitions};
        for (std::uint32_t y = 0; y + 4 < 64; y += 4)
            for (std::uint32_t x = 0; x + 4 < 64; x += 4) {
                EXPECT_NE(wide.partition_of(x, y), wide.partition_of(x + 4, y));
                EXPECT_NE(wide.partition_of(x, y), wide.partition_of(x, y + 4));
            }
    }
}

TEST_F(LedgerTest, AReadOfAllPredecessorsIsNoHazard) { EXPECT_EQ(book(3, 3, 0).total(), 0U); }

TEST_F(LedgerTest, H1UntilThePredecessorRetires) {
    EXPECT_EQ(book(2, 2, 99).h1, 1U);
    EXPECT_EQ(book(2, 2, 100).h1, 1U);
}

TEST_F(LedgerTest, H2FromRetirementUntilTheStoreIsVisible) {
    EXPECT_EQ(book(2, 2, 100).h2, 1U);
    EXPECT_EQ(book(2, 2, 119).h2, 2U);
    EXPECT_EQ(book(2, 2, 120).h2, 2U);
}

TEST_F(LedgerTest, H3OnceItWasVisible) {
    EXPECT_EQ(book(2, 2, 120).h3, 1U);
    EXPECT_EQ(book(2, 2, 119).h3, 1U);
}

TEST_F(LedgerTest, H4WhenTheTargetsDifferWhateverTheTime) {
    EXPECT_EQ(book(1, 3, 50).h4, 1U);
    EXPECT_EQ(book(2, 3, 500).h4, 2U);
}

TEST_F(LedgerTest, NeverVisibleIsTheWritePath) {
    ledger.enter(0, 0, 6, 100, 110, StoreHistory::never);
    EXPECT_EQ(book(2, 2, 1'000'000).h2, 1U);
    history.tile_visible(0, 500);
    EXPECT_EQ(book(2, 2, 500).h3, 1U);
}

TEST_F(LedgerTest, ThePairNamesVictimAggressorAndStaleness) {
    book(1, 1, 105);
    ASSERT_EQ(ledger.pairs().size(), 1U);
    const HazardPair& pair = ledger.pairs()[0];
    EXPECT_EQ(pair.victim, 9U);
    EXPECT_EQ(pair.aggressor, 5U);
    EXPECT_EQ(pair.missing, 2U);
    EXPECT_EQ(pair.read, 105U);
    EXPECT_EQ(pair.write, 110U);
    EXPECT_EQ(ledger.staleness_max(), 2U);
    EXPECT_EQ(ledger.distances(), (std::vector<std::uint64_t>{0, 0, 1})); // 9 - 5 = 4 quads
    EXPECT_EQ(history.classes(0, 0), 1U << static_cast<unsigned>(HazardClass::h2_write_path));
}

TEST(TileCacheTest, ReplacesTheLeastRecentlyUsedThatIsNeitherPinnedNorPending) {
    TileCache cache(3, 16);
    for (const std::uint32_t tile : {4U, 5U, 6U}) {
        const std::uint32_t entry = cache.victim();
        cache.allocate(entry, tile, tile == 6);
        cache.pin(entry);
        if (tile != 4) cache.unpin(entry);
    }
    EXPECT_FALSE(cache.resident(6)); // still on its way
    EXPECT_EQ(cache.tile(cache.victim()), 5U);
    cache.unpin(cache.find(4));
    EXPECT_EQ(cache.tile(cache.victim()), 4U);
    cache.filled(cache.find(6));
    EXPECT_TRUE(cache.resident(6));
    const std::uint32_t entry = cache.victim();
    cache.allocate(entry, 9, false);
    EXPECT_EQ(cache.find(4), TileCache::none);
    cache.mark_dirty(entry);
    EXPECT_THROW(cache.allocate(entry, 10, false), sim::InternalError); // a dirty tile must be written back first
}

TEST(TileCacheTest, OneThatIsLeftOutHoldsNothing) {
    const TileCache cache(0, 16);
    EXPECT_EQ(cache.victim(), TileCache::none);
    EXPECT_EQ(cache.find(3), TileCache::none);
}

TEST(KBufferMemoryTest, MemorySeesAStoreOnlyOnceItsTileIsPublished) {
    const auto program = models::make_program("nearest-k", "z", 4);
    KBufferMemory memory(layout, *program, true);
    const float before = *memory.seen(5, 2, false);
    *memory.latest(5, 2) = 0.25F;
    memory.latest_version(5, 2) = {1, 1};
    EXPECT_EQ(*memory.seen(5, 2, true), 0.25F);
    EXPECT_EQ(*memory.seen(5, 2, false), before);
    EXPECT_EQ(memory.seen_version(5, 2, false).stores, 0U);
    memory.publish_tile(0); // another tile
    EXPECT_EQ(*memory.seen(5, 2, false), before);
    memory.publish_tile(1);
    EXPECT_EQ(*memory.seen(5, 2, false), 0.25F);
    EXPECT_EQ(memory.seen_version(5, 2, false).stores, 1U);
}

TEST(KBufferMemoryTest, LostUpdatesAreStoresThatTheChainDoesNotHold) {
    const auto program = models::make_program("nearest-k", "z", 4);
    KBufferMemory memory(layout, *program, false);
    memory.latest_version(0, 0) = {5, 2};
    memory.latest_version(3, 1) = {4, 4};
    EXPECT_EQ(memory.lost_updates(), 3U);
    EXPECT_EQ(memory.image().size(), 10U * 7U * 4U);
}

TEST(KBufferDifferenceTest, TellsMissingDuplicateAndUnsorted) {
    const auto program = models::make_program("nearest-k", "z", 4);
    std::vector<float> reference(4);
    program->clear(reference.data());
    const float empty = reference[3];
    reference = {0.1F, 0.2F, 0.3F, empty};
    const auto compare = [&](std::vector<float> run) { return compare_kbuffers(*program, run, reference); };
    EXPECT_EQ(compare(reference).wrong_pixels, 0U);
    const KBufferDifference missing = compare({0.1F, 0.3F, empty, empty});
    EXPECT_EQ(missing.lost_fragments, 1U);
    EXPECT_EQ(missing.layers[1].missing, 1U);
    const KBufferDifference twice = compare({0.1F, 0.1F, 0.2F, 0.3F});
    EXPECT_EQ(twice.layers[1].duplicate, 1U);
    EXPECT_EQ(twice.lost_fragments, 0U);
    EXPECT_EQ(compare({0.2F, 0.1F, 0.3F, empty}).layers[1].unsorted, 1U);
    // A farther fragment that came up because a nearer one was lost is no duplicate.
    EXPECT_EQ(compare({0.2F, 0.3F, 0.9F, empty}).layers[2].duplicate, 0U);
}

TEST(ProgrammableBlenderTest, K12_CyclesPerFragmentAreLanesOrPort) {
    const auto four = models::make_program("nearest-k", "rgbz", 4);
    const auto sixteen = models::make_program("nearest-k", "z", 16);
    EXPECT_EQ(ProgrammableBlender({}, *four, 4).cycles_per_fragment(), 9U);
    EXPECT_EQ(ProgrammableBlender({}, *sixteen, 4).cycles_per_fragment(), 12U);
    EXPECT_EQ(ProgrammableBlender({BlendInterlock::stall, 1000, 32, 16}, *four, 4).cycles_per_fragment(), 4U);
}

TEST(ProgrammableBlenderTest, AStalledPixelEntersWhenTheOlderResultIsWrittenAndNotBefore) {
    const auto program = models::make_program("nearest-k", "rgbz", 4);
    ProgrammableBlender blender({}, *program, 4);
    const sim::Cycle written = blender.enter(7, 0b0001, 100, blender.cycles_per_quad(1));
    EXPECT_EQ(written, 116U);
    EXPECT_EQ(blender.may_enter(7, 0b0001, 109), 116U);
    EXPECT_EQ(blender.may_enter(7, 0b0001, 115), 116U);
    EXPECT_EQ(blender.may_enter(7, 0b0010, 109), 109U); // another pixel of the quad
    EXPECT_EQ(blender.may_enter(8, 0b0001, 109), 109U); // another quad
    EXPECT_EQ(blender.may_enter(7, 0b0001, 116), 116U);
}
