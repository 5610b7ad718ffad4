// A ROP group alone: the programmable blender. Four depths per pixel: 12 operations on 4 lanes, 3 cycles a
// fragment; a result is written 16 cycles after its quad entered. A tile asked for at 1 is there at 103.
#include "tests/support/rop_kit.hpp"

namespace output_rop_blender_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::BlenderSite;
using pipeline::BlendInterlock;
using pipeline::MemoryClient;
using tests::RopBench;
using tests::RopOptions;

constexpr sim::Cycle entered = 103; ///< the first quad, whose tile is missing
constexpr sim::Cycle cost = 3, latency = 16;

struct BlendPass : tests::QuadPass {
    BlendPass() { context.end = pipeline::FragmentEnd::kbuffer_blend; }
};

BlenderSite site(BlendInterlock interlock) {
    BlenderSite blender;
    blender.interlock = interlock;
    blender.latency = latency;
    return blender;
}

TEST(RopBlender, CommitsWhenTheTileIsThere) {
    BlendPass pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    RopBench bench(pass, {.blender = BlenderSite{}, .source = {.gap = 200}});
    bench.run();
    EXPECT_EQ(bench.commits->cycles(), (Cycles{entered + 1, 200 + 3})); // missing, then resident
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_read), (Cycles{2}));
}

TEST(RopBlender, KeepsTheNearestInOrder) {
    BlendPass pass;
    for (const float depth : {0.5F, 0.25F, 0.75F, 0.125F, 0.875F}) pass.quad(0, 0, 1, depth);
    RopBench bench(pass, {.blender = BlenderSite{}});
    bench.run();
    EXPECT_EQ((std::vector{bench.stored(0, 0), bench.stored(0, 1), bench.stored(0, 2), bench.stored(0, 3)}),
              (std::vector{0.125F, 0.25F, 0.5F, 0.75F}));
    EXPECT_EQ(bench.rop.stats().program_runs, 5U);
    EXPECT_EQ(bench.rop.stats().insertions, 4U); // the last one is farther than all that are kept
    EXPECT_EQ(bench.rop.ledger().counts().total(), 0U);
}

TEST(RopBlender, ProgramSetsTheRateOfDifferentBlocks) {
    BlendPass pass;
    for (const std::uint32_t block : {0U, 1U, 2U, 3U}) pass.quad(block % 2 * 2, block / 2 * 2);
    RopBench bench(pass, {.blender = site(BlendInterlock::stall)});
    bench.run();
    EXPECT_EQ(bench.commits->cycles(),
              (Cycles{entered + 1, entered + 1 + cost, entered + 1 + 2 * cost, entered + 1 + 3 * cost}));
    EXPECT_EQ(bench.rop.stats().program_cycles, 4 * cost);
    EXPECT_EQ(bench.rop.stats().interlock_stalls, 0U);
}

TEST(RopBlender, SamePixelComesBackAfterTheIntervalOfItsInterlock) {
    BlendPass pass;
    for (const float depth : {0.25F, 0.5F}) pass.quad(0, 0, 15, depth);
    for (const auto& [interlock, interval] :
         {std::pair{BlendInterlock::stall, latency}, {BlendInterlock::forward, cost}, {BlendInterlock::none, cost}}) {
        const bool unprotected = interlock == BlendInterlock::none;
        RopBench bench(pass, {.blender = site(interlock)});
        bench.run();
        EXPECT_EQ(bench.commits->cycles(), (Cycles{entered + 1, entered + 1 + interval}));
        EXPECT_EQ(bench.rop.stats().interlock_stalls, interlock == BlendInterlock::stall ? 1U : 0U);
        EXPECT_EQ(bench.stored(0, 0), unprotected ? 0.5F : 0.25F);
        EXPECT_EQ(bench.kbuffer.lost_updates(), unprotected ? 4U : 0U);
        EXPECT_EQ(bench.rop.ledger().counts().of(pipeline::HazardClass::h2_write_path), unprotected ? 4U : 0U);
        EXPECT_EQ(bench.rop.ledger().counts().total(),
                  bench.rop.ledger().counts().of(pipeline::HazardClass::h2_write_path));
    }
}

TEST(RopBlender, OtherPixelsOfTheBlockDoNotWait) {
    BlendPass pass;
    pass.quad(0, 0, 0b0011);
    pass.quad(0, 0, 0b1100);
    pass.quad(0, 0, 0b0110);
    RopBench bench(pass, {.blender = site(BlendInterlock::stall)});
    bench.run();
    EXPECT_EQ(bench.commits->cycles(), (Cycles{entered + 1, entered + 1 + cost, entered + 1 + cost + latency}));
}

// The second quad enters `interval` cycles after the first, whose result is written after 16.
TEST(RopBlender, WithoutInterlockAQuadSeesAResultFromTheCycleOfItsWriteOn) {
    BlendPass pass;
    for (const float depth : {0.25F, 0.5F}) pass.quad(0, 0, 15, depth);
    for (const auto& [interval, kept] : {std::pair{latency - 1, false}, {latency, true}}) {
        RopBench bench(pass, {.blender = site(BlendInterlock::none), .source = {.gap = entered + interval - 2}});
        bench.run();
        EXPECT_EQ(bench.commits->cycles(), (Cycles{entered + 1, entered + 1 + interval}));
        EXPECT_EQ(bench.stored(0, 0), kept ? 0.25F : 0.5F);
        EXPECT_EQ(bench.rop.ledger().counts().total(), kept ? 0U : 4U);
    }
}

TEST(RopBlender, DirtySectorIsWrittenBackOnce) {
    BlendPass pass;
    for (int i = 0; i < 3; ++i) pass.quad(0, 0);
    RopBench bench(pass, {.blender = site(BlendInterlock::forward)});
    bench.run();
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), 0U);
    bench.write_back();
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_write), (std::vector<std::uint64_t>{0}));
}

// A fragment behind all entries changes nothing, and its pixel need not be written.
TEST(RopBlender, PHY_P11_OnlyChangedPixelsAreWrittenBack) {
    BlendPass pass;
    for (int i = 0; i < 4; ++i) pass.quad(0, 0, 0b0001, 0.25F);
    pass.quad(0, 0, 0b1111, 0.5F); // the first pixel is full
    RopBench bench(pass, {.rop = {.kbuffer_cache_bytes = 64}, .blender = BlenderSite{}});
    bench.run();
    EXPECT_EQ(bench.rop.stats().insertions, 7U);
    bench.write_back();
    ASSERT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), 1U);
    EXPECT_EQ(bench.memory.arrivals.back().request.bytes, 64U); // both bursts of the sector
}

TEST(RopBlender, PHY_P11_ClearedSectorsAreNotFetched) {
    BlendPass pass;
    for (const std::uint32_t x : {0U, 2U, 4U, 0U}) pass.quad(x, 0, 0b0001);
    RopBench bench(pass, {.rop = {.kbuffer_cache_bytes = 64}, .blender = BlenderSite{}, .source = {.gap = 400}});
    bench.kbuffer_clear.set(pass.context.layout);
    bench.run();
    bench.write_back();
    // The last one comes back to a sector that was written when it was driven out; another write goes before its read.
    EXPECT_EQ(bench.requested_lines(MemoryClient::tile_read), (std::vector<std::uint64_t>{0}));
    EXPECT_EQ(bench.commits->cycles(), (Cycles{3, 403, 803, 1200 + entered + 2}));
    std::vector<std::uint32_t> bytes;
    for (const auto& [request, cycle] : bench.memory.arrivals)
        if (request.write) bytes.push_back(request.bytes);
    EXPECT_EQ(bytes, (std::vector<std::uint32_t>{64, 64, 64, 32})); // whole, but for the last
}

TEST(RopBlender, ModesAgreeUnderAllInterlocks) {
    BlendPass pass;
    for (std::uint32_t i = 0; i < 200; ++i)
        pass.quad(i / 20 % 4 * 4 + i % 2 * 2, i / 7 % 2 * 2, static_cast<std::uint8_t>(i % 15 + 1),
                  1.0F / static_cast<float>(i + 2));
    for (const BlendInterlock interlock : {BlendInterlock::stall, BlendInterlock::forward, BlendInterlock::none})
        tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
            RopBench bench(pass, {.rop = {.kbuffer_cache_bytes = 512, .queue = 8},
                                  .blender = site(interlock),
                                  .memory_latency = 30,
                                  .mode = mode,
                                  .shuffle = shuffle});
            bench.run();
            EXPECT_EQ(bench.commits->size(), 200U);
            EXPECT_EQ(bench.rop.ledger().counts().total() != 0, interlock == BlendInterlock::none);
            return std::tuple(bench.commits->cycles(), bench.kbuffer.image(), bench.rop.activity_times());
        });
}

} // namespace output_rop_blender_test
