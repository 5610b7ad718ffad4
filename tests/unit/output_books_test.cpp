// The books of the output stage: layout of surfaces, tile tags, versions of pixels, classes of hazards.
#include "models/programs/library.hpp"
#include "pipeline/image_difference.hpp"
#include "pipeline/output/clear_bits.hpp"
#include "pipeline/output/hazard_ledger.hpp"
#include "pipeline/output/kbuffer_memory.hpp"
#include "pipeline/output/programmable_blender.hpp"
#include "pipeline/output/tile_cache.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <gtest/gtest.h>
#include <set>

namespace output_books_test {

using namespace pipeline;

using HazardTable = decltype(HazardCounts::by);

constexpr SurfaceLayout layout{10, 7, 4}; // odd sizes: the last tiles hang over the edge

/// A ledger whose pixel 0 of block 0 was stored by quad 5: retired at 100, coherent reads see it from 110 on, others
/// from 120 on.
struct LedgerTest : testing::Test {
    StoreHistory history{layout};
    HazardLedger ledger{layout, history};
    void SetUp() override {
        for (const std::uint32_t quad : {3U, 4U}) ledger.enter(0, 0, quad, 50, 60, 70);
        ledger.enter(0, 0, 5, 100, 110, 120);
    }
    HazardCounts book(std::uint32_t oldest, std::uint32_t newest, sim::Cycle read, sim::Cycle fill = 0) {
        ledger.book(0, 0, 9, {3, oldest, newest, read, fill}, 1'000'001);
        return ledger.counts();
    }
};

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
    EXPECT_EQ(book(2, 2, 99).of(HazardClass::h1_in_flight), 1U);
    EXPECT_EQ(book(2, 2, 100).of(HazardClass::h1_in_flight), 1U);
}

TEST_F(LedgerTest, H2FromRetirementUntilTheStoreIsVisible) {
    EXPECT_EQ(book(2, 2, 100).of(HazardClass::h2_write_path), 1U);
    EXPECT_EQ(book(2, 2, 119).of(HazardClass::h2_write_path), 2U);
    EXPECT_EQ(book(2, 2, 120).of(HazardClass::h2_write_path), 2U);
}

TEST_F(LedgerTest, H3OnceItWasVisible) {
    EXPECT_EQ(book(2, 2, 120).of(HazardClass::h3_stale_line), 1U);
    EXPECT_EQ(book(2, 2, 119).of(HazardClass::h3_stale_line), 1U);
}

TEST_F(LedgerTest, ALineFilledAfterTheStoreWasVisibleCannotLackIt) {
    EXPECT_EQ(book(2, 2, 130, 119).of(HazardClass::h3_stale_line), 1U);
    EXPECT_THROW(book(2, 2, 130, 120), sim::InternalError);
}

TEST_F(LedgerTest, H4WhenTheTargetsDifferWhateverTheTime) {
    EXPECT_EQ(book(1, 3, 50).of(HazardClass::h4_torn_read), 1U);
    EXPECT_EQ(book(2, 3, 500).of(HazardClass::h4_torn_read), 2U);
}

// A coherent read at 109 misses the store, one at 110 sees it.
TEST_F(LedgerTest, ConcurrencyUntilCoherentReadsSeeTheStoreIncoherenceFromThenOn) {
    EXPECT_EQ(book(2, 2, 109).by, (HazardTable{{{0, 0}, {1, 0}, {0, 0}, {0, 0}}}));
    EXPECT_EQ(book(2, 2, 110).by, (HazardTable{{{0, 0}, {1, 1}, {0, 0}, {0, 0}}}));
    EXPECT_EQ(book(2, 2, 99).by, (HazardTable{{{1, 0}, {1, 1}, {0, 0}, {0, 0}}}));
    EXPECT_EQ(book(2, 2, 120).by, (HazardTable{{{1, 0}, {1, 1}, {0, 1}, {0, 0}}}));
    EXPECT_EQ(book(1, 3, 109).by, (HazardTable{{{1, 0}, {1, 1}, {0, 1}, {1, 0}}}));
    const HazardCounts counts = book(1, 3, 110);
    EXPECT_EQ(counts.by, (HazardTable{{{1, 0}, {1, 1}, {0, 1}, {1, 1}}}));
    EXPECT_EQ(counts.of(HazardKind::concurrency), 3U);
    EXPECT_EQ(counts.of(HazardKind::incoherence), 3U);
    EXPECT_EQ(counts.total(), 6U);
}

TEST_F(LedgerTest, APredecessorThatHasNotStoredYetIsInFlight) {
    ledger.book(0, 0, 9, {4, 3, 3, 500, 0}, 600); // three of four predecessors have stored
    EXPECT_EQ(ledger.counts().by, (HazardTable{{{1, 0}, {0, 0}, {0, 0}, {0, 0}}}));
}

TEST_F(LedgerTest, NeverVisibleIsTheWritePath) {
    ledger.enter(0, 0, 6, 100, 110, StoreHistory::never);
    EXPECT_EQ(book(2, 2, 1'000'000).of(HazardClass::h2_write_path), 1U);
    history.make_visible(0, 0, 3, 400); // what memory took held the store before it only
    EXPECT_EQ(book(2, 2, 500).of(HazardClass::h2_write_path), 2U);
    history.make_visible(0, 0, 4, 500);
    EXPECT_EQ(book(2, 2, 500).of(HazardClass::h3_stale_line), 1U);
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

TEST(TileCacheTest, ReplacesTheLeastRecentlyUsedThatNoQuadWaitsFor) {
    TileCache cache;
    cache.begin(3, {});
    for (const std::uint32_t line : {4U, 5U, 6U}) {
        const std::uint32_t entry = cache.victim();
        cache.allocate(entry, line, line == 6, 0);
        cache.pin(entry);
        if (line == 5) cache.unpin(entry);
    }
    EXPECT_FALSE(cache.holds(6, 15)); // still on its way
    EXPECT_EQ(cache.line(cache.victim()), 5U);
    cache.pin(cache.victim());
    EXPECT_EQ(cache.victim(), TileCache::none);
    cache.filled(cache.find(6));
    EXPECT_TRUE(cache.holds(6, 15));
    for (const std::uint32_t line : {4U, 6U, 5U}) cache.unpin(cache.find(line));
    EXPECT_EQ(cache.line(cache.victim()), 4U);
    cache.pin(cache.find(4)); // used again
    cache.unpin(cache.find(4));
    const std::uint32_t entry = cache.victim();
    EXPECT_EQ(cache.line(entry), 6U);
    cache.allocate(entry, 9, false, 0);
    EXPECT_EQ(cache.find(6), TileCache::none);
    EXPECT_EQ(cache.find(9), entry);
    cache.mark_dirty(entry, 1);
    EXPECT_THROW(cache.allocate(entry, 10, false, 0), sim::InternalError); // dirty pixels must be written back first
}

// The same as a plain list of the lines in the order of their last use.
TEST(TileCacheTest, AgreesWithAListOfTheLastUses) {
    TileCache cache;
    cache.begin(37, {});
    std::vector<std::uint32_t> uses;
    std::uint32_t random = 1;
    for (int i = 0; i < 20'000; ++i) {
        random = random * 1664525 + 1013904223;
        const std::uint32_t line = random >> 16U & 63U;
        const auto known = std::find(uses.begin(), uses.end(), line);
        std::uint32_t entry = cache.find(line);
        ASSERT_EQ(entry != TileCache::none, known != uses.end());
        if (known != uses.end()) uses.erase(known);
        if (uses.size() == 37) {
            ASSERT_EQ(cache.line(cache.victim()), uses.front());
            uses.erase(uses.begin());
        }
        if (entry == TileCache::none) cache.allocate(entry = cache.victim(), line, false, 0);
        cache.pin(entry);
        cache.unpin(entry);
        uses.push_back(line);
    }
}

TEST(TileCacheTest, PixelsAreValidWhenStoredFetchedOrCompleted) {
    TileCache cache;
    cache.begin(2, {4}); // a line has two sectors
    const std::uint32_t entry = cache.victim();
    cache.allocate(entry, cache.shape().line_of(7), false, 0);
    cache.mark_dirty(entry, cache.shape().in_line(7, 0b0110));
    EXPECT_EQ(cache.dirty(entry), 0b0110'0000);
    EXPECT_FALSE(cache.holds(7, 15));
    EXPECT_TRUE(cache.holds(7, 0b0110)); // the pixels that a partial quad reads
    EXPECT_TRUE(cache.holds(7, 0b0010));
    EXPECT_FALSE(cache.holds(7, 0b0011));
    cache.complete(7);
    EXPECT_TRUE(cache.holds(7, 15));
    EXPECT_FALSE(cache.holds(6, 15));
    EXPECT_EQ(cache.dirty(entry), 0b0110'0000); // what was fetched is clean
    cache.complete(100);                        // not on chip
    cache.mark_clean(entry, 0b0010'0000);
    EXPECT_EQ(cache.dirty(entry), 0b0100'0000);
}

TEST(TileCacheTest, LineIsASectorOrWhatSharesItsBurst) {
    for (const auto& [pixel, sectors] : {std::pair{2U, 4U}, {4U, 2U}, {8U, 1U}, {16U, 1U}, {64U, 1U}}) {
        const SectorShape shape{pixel};
        EXPECT_EQ(shape.sectors(), sectors);
        EXPECT_EQ(shape.line_bytes(), std::max(32U, 4 * pixel));
        EXPECT_EQ(shape.line_of(4 * sectors - 1), 3U);
        EXPECT_EQ(std::popcount(shape.whole_line()), static_cast<int>(4 * sectors));
    }
}

TEST(TileCacheTest, OneThatIsLeftOutHoldsNothing) {
    TileCache cache;
    EXPECT_EQ(cache.victim(), TileCache::none);
    EXPECT_EQ(cache.find(3), TileCache::none);
    cache.begin(0, {});
    EXPECT_EQ(cache.victim(), TileCache::none);
    EXPECT_FALSE(cache.holds(3, 15));
}

TEST(ClearBitsTest, CountsTheSectorsOfThePictureUntilTheyAreWritten) {
    ClearBits bits;
    EXPECT_FALSE(bits.cleared(0));
    bits.set(layout);
    EXPECT_EQ(bits.left(), 5U * 4); // 10x7 pixels
    EXPECT_TRUE(bits.cleared(3));
    bits.written(3);
    bits.written(3);
    EXPECT_EQ(bits.left(), 19U);
    EXPECT_FALSE(bits.cleared(3));
    bits.reset();
    EXPECT_EQ(bits.left(), 0U);
    EXPECT_FALSE(bits.cleared(0));
}

TEST(KBufferMemoryTest, MemorySeesAStoreOnlyOnceItHasTakenTheBlockAsItWasWritten) {
    const auto program = models::make_program("nearest-k", "z", 4);
    KBufferMemory memory(layout, *program, true);
    const float before = *memory.seen(5, 2, false);
    *memory.latest(5, 2) = 0.25F;
    memory.latest_version(5, 2) = {1, 1};
    EXPECT_EQ(*memory.seen(5, 2, true), 0.25F);
    EXPECT_EQ(*memory.seen(5, 2, false), before);
    EXPECT_EQ(memory.seen_version(5, 2, false).stores, 0U);
    std::vector<float> written(memory.latest(5, 0), memory.latest(5, 0) + std::size_t{4} * memory.floats_per_pixel());
    const std::array<PixelVersion, 4> versions{PixelVersion{}, {}, memory.latest_version(5, 2), {}};
    *memory.latest(5, 2) = 0.125F;                                    // while the block is on its way
    memory.publish_block(4, 15, written.data(), versions.data());     // another block
    memory.publish_block(5, 0b1011, written.data(), versions.data()); // its other pixels
    EXPECT_EQ(*memory.seen(5, 2, false), before);
    memory.publish_block(5, 0b0100, written.data(), versions.data());
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

} // namespace output_books_test
