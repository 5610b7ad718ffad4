// The lock table between pipes that ask and ROPs that release.
#include "pipeline/fragment/lock_table.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <optional>

namespace fragment_lock_table_test {

using pipeline::Commit;
using pipeline::CriticalSection;
using pipeline::LockArea;
using pipeline::LockGrant;
using pipeline::LockRequest;
using pipeline::QuadKind;

using Cycles = std::vector<sim::Cycle>;

/// Quads 0 and 1 cover one block, quad 2 its right neighbour in the same tile, quad 3 another tile.
struct Bench {
    tests::Rig rig;
    tests::QuadPass pass{64, 64};
    pipeline::ShaderSite site;
    std::optional<pipeline::LockTable> unit;
    std::optional<tests::Source<LockRequest>> requests;
    std::optional<tests::Source<Commit>> releases;
    std::optional<tests::Sink<LockGrant>> grants;

    Bench(CriticalSection section, LockArea area, std::vector<LockRequest> asked, std::vector<Commit> left,
          tests::SourceOptions release_options = {}, std::uint32_t grants_per_clk = 4) {
        pass.triangle();
        pass.quad(0, 0);
        pass.triangle();
        pass.quad(0, 0);
        pass.triangle();
        pass.quad(2, 0);
        pass.triangle();
        pass.quad(8, 0);
        site.critical_section = section;
        site.lock_area = area;
        site.grants_per_clk = grants_per_clk;
        unit.emplace(rig.context("locks"), site, pass.context, 1, 1, 16);
        requests.emplace(rig.context("pipe"), std::move(asked));
        releases.emplace(rig.context("rop"), std::move(left), release_options);
        grants.emplace(rig.context("sink"));
        sim::connect(requests->out, unit->requests_in[0], {1, 8, 16});
        sim::connect(releases->out, unit->releases_in[0], {1, 2, 16});
        sim::connect(unit->grants_out[0], grants->in, {1, 8, 64});
        rig.simulation.run();
    }

    std::vector<std::uint16_t> order() const {
        std::vector<std::uint16_t> threads;
        for (const LockGrant& grant : grants->values()) threads.push_back(grant.thread);
        return threads;
    }
};

LockRequest ask(std::uint32_t quad, std::uint16_t thread, std::uint32_t ticket = 0, std::uint8_t mask = 15) {
    return {quad, mask, thread, {ticket, ticket, ticket, ticket}, ticket};
}

Commit leave(std::uint32_t quad, std::uint8_t mask = 15) { return {pipeline::no_slot, quad, mask, QuadKind::quad}; }

TEST(LockTable, AFreeLockIsGrantedTheCycleItIsAskedFor) {
    const Bench bench(CriticalSection::ordered, LockArea::pixel, {ask(0, 7)}, {});
    EXPECT_EQ(bench.grants->cycles(), (Cycles{2})); // sent at 0, here at 1, back at 2
    EXPECT_EQ(bench.unit->stats().waits, 0U);
}

TEST(LockTable, TheNextQuadEntersWithTheReleaseOfTheOneBeforeAndNotEarlier) {
    const Bench bench(CriticalSection::ordered, LockArea::pixel, {ask(0, 1), ask(1, 2, 1)}, {leave(0)}, {.start = 50});
    EXPECT_EQ(bench.grants->cycles(), (Cycles{2, 52}));
    EXPECT_EQ(bench.unit->stats().waits, 1U);
    EXPECT_EQ(bench.unit->stats().released, 1U);
}

TEST(LockTable, TicketsDecideNotTheOrderOfArrival) {
    const Bench bench(CriticalSection::ordered, LockArea::pixel, {ask(1, 2, 1), ask(0, 1, 0)}, {leave(0)},
                      {.start = 50});
    EXPECT_EQ(bench.order(), (std::vector<std::uint16_t>{1, 2}));
    const Bench any(CriticalSection::unordered, LockArea::pixel, {ask(1, 2, 1), ask(0, 1, 0)}, {leave(1)},
                    {.start = 50});
    EXPECT_EQ(any.order(), (std::vector<std::uint16_t>{2, 1}));
    EXPECT_EQ(any.grants->cycles(), (Cycles{2, 52}));
}

TEST(LockTable, DisjointPixelsOfABlockDoNotWaitForEachOther) {
    const std::vector<LockRequest> halves{ask(0, 1, 0, 3), ask(1, 2, 0, 12)};
    const Bench by_pixel(CriticalSection::unordered, LockArea::pixel, halves, {});
    EXPECT_EQ(by_pixel.grants->cycles(), (Cycles{2, 2}));
    const Bench by_quad(CriticalSection::unordered, LockArea::quad, halves, {leave(0, 3)}, {.start = 30});
    EXPECT_EQ(by_quad.grants->cycles(), (Cycles{2, 32}));
}

TEST(LockTable, ATileHoldsItsBlocksAndNoOtherTile) {
    const Bench bench(CriticalSection::ordered, LockArea::tile, {ask(0, 1, 0), ask(2, 2, 1), ask(3, 3, 0)}, {leave(0)},
                      {.start = 40});
    EXPECT_EQ(bench.order(), (std::vector<std::uint16_t>{1, 3, 2}));
    EXPECT_EQ(bench.grants->cycles(), (Cycles{2, 2, 42}));
}

TEST(LockTable, GrantsPerCycleAreBounded) {
    const Bench bench(CriticalSection::ordered, LockArea::quad, {ask(0, 1), ask(2, 2), ask(3, 3)}, {}, {}, 1);
    EXPECT_EQ(bench.grants->cycles(), (Cycles{2, 3, 4}));
}

TEST(LockTable, AQuadTakesAllItsPixelsOrNone) {
    // Quad 1 wants all four pixels, of which quad 0 holds two; the other two stay free for a third.
    const Bench bench(CriticalSection::unordered, LockArea::pixel,
                      {ask(0, 1, 0, 3), ask(1, 2, 0, 15), ask(1, 3, 0, 12)}, {leave(0, 3), leave(1, 12)},
                      {.start = 30, .gap = 30});
    EXPECT_EQ(bench.order(), (std::vector<std::uint16_t>{1, 3, 2}));
    EXPECT_EQ(bench.grants->cycles(), (Cycles{2, 2, 62}));
}

} // namespace fragment_lock_table_test
