// A ROP partition alone: k-buffer values computed by a shader are stored, written back and read by a texture unit.
// Links take one cycle, memory 100: a quad sent at cycle 0 is executed at 2, its commit arrives at 3; a read sent at s
// is accepted at s + 1, and sampled at s + 103 where it comes from memory.
#include "tests/support/rop_kit.hpp"

namespace {

using Cycles = std::vector<sim::Cycle>;
using Tiles = std::vector<std::uint64_t>;
using pipeline::MemoryClient;
using pipeline::QuadKind;
using pipeline::QuadTask;
using pipeline::ShaderSite;
using pipeline::TextureCoherence;
using pipeline::Visibility;
using tests::RopBench;
using tests::RopOptions;

constexpr sim::Cycle from_memory = 103;
constexpr float cleared = std::numeric_limits<float>::max();

struct StorePass : tests::QuadPass {
    explicit StorePass(std::string_view entry = "z") : QuadPass(64, 64, 1, 4, entry) {
        context.end = pipeline::FragmentEnd::kbuffer_store;
    }
};

ShaderSite site(Visibility visibility, TextureCoherence coherence = TextureCoherence::none) {
    ShaderSite shader;
    shader.visibility = visibility;
    shader.coherence = coherence;
    return shader;
}

QuadTask write_back() {
    QuadTask task;
    task.kind = QuadKind::writeback;
    return task;
}

TEST(RopStore, CommitsInTheCycleAfterAdmissionWithoutFetchingTheTile) {
    StorePass pass;
    pass.quad(0, 0);
    RopBench bench(pass, {.shader = site(Visibility::rop_cache)});
    bench.run();
    EXPECT_EQ(bench.commits->cycles(), (Cycles{3}));
    EXPECT_EQ(bench.stored(0), 1.0F);
    EXPECT_EQ(bench.commits->values()[0].slot, 0U);
    EXPECT_TRUE(bench.memory.arrivals.empty());
    EXPECT_EQ(bench.rop.stats().stores, 4U);
}

// Four pixels of 64 bytes through ports of 16 bytes per ROP.
TEST(RopStore, PortOfTheTileCacheSetsTheRate) {
    StorePass pass("rgbz");
    pass.quads(3);
    for (const auto& [units, cycles] : {std::pair{1U, 16U}, {4U, 4U}, {16U, 1U}}) {
        RopBench bench(pass, {.rop = {.units = units, .bytes_per_clk = 16}, .shader = site(Visibility::rop_cache)});
        bench.run();
        EXPECT_EQ(bench.commits->cycles(), (Cycles{3, 3 + cycles, 3 + 2 * cycles}));
    }
}

TEST(RopStore, StoresOnlyThePixelsOfTheMask) {
    StorePass pass;
    pass.quad(0, 0, 0b1010);
    RopBench bench(pass, {.shader = site(Visibility::rop_cache)});
    bench.run();
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
        EXPECT_EQ(bench.kbuffer.latest(0, pixel)[0], pixel % 2 == 1 ? 1.0F : cleared);
}

TEST(RopStore, HeldCommitHoldsTheStoreAndNothingIsLost) {
    StorePass pass;
    for (std::uint32_t i = 0; i < 12; ++i) pass.quad(0, 0);
    RopBench bench(pass, {.rop = {.queue = 2}, .shader = site(Visibility::rop_cache), .commits = {.start = 500}});
    bench.run();
    EXPECT_EQ(bench.commits->size(), 12U);
    EXPECT_EQ(bench.commits->cycles()[3], 501U); // four in the link, two leave it per cycle
    EXPECT_EQ(bench.source.cycles()[7], 7U);     // four executed, two in the queue, two in the link
    EXPECT_EQ(bench.source.cycles()[8], 502U);
    EXPECT_EQ(bench.stored(0), 12.0F);
}

// The second store is applied at 402. A read is accepted at s + 1 and sampled 280 cycles later.
TEST(RopStore, ReadFromTheTileCacheSeesAStoreFromTheNextCycleOn) {
    StorePass pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    for (const auto& [start, value] : {std::pair{121U, 1.0F}, {122U, 2.0F}}) {
        RopBench bench(pass, {.rop = {.read_latency = 280},
                              .shader = site(Visibility::rop_cache),
                              .reads = {0},
                              .reads_source = {.start = start},
                              .source = {.gap = 400}});
        bench.run();
        EXPECT_EQ(bench.commits->cycles()[1], 403U);
        EXPECT_EQ(bench.read_at(0), start + 1 + 280);
        EXPECT_EQ(bench.read_value(0), value);
        EXPECT_EQ(bench.reads_done->cycles(), (Cycles{start + 1 + 280 + 1}));
        EXPECT_EQ(bench.rop.stats().kbuffer_reads_from_tiles, 1U);
        EXPECT_TRUE(bench.memory.arrivals.empty());
    }
}

TEST(RopStore, ReadOfATileThatIsNotInTheCacheComesFromMemory) {
    StorePass pass;
    pass.quad(0, 0);
    RopBench bench(pass, {.shader = site(Visibility::rop_cache), .reads = {4}, .reads_source = {.start = 50}});
    bench.run();
    EXPECT_EQ(bench.read_at(0), 50 + from_memory);
    EXPECT_EQ(bench.read_value(0), cleared);
    EXPECT_EQ(bench.request_cycles(MemoryClient::kbuffer_read), (Cycles{52}));
    EXPECT_EQ(bench.rop.stats().kbuffer_reads_from_tiles, 0U);
}

TEST(RopStore, ReadGoesPastTheTileCacheWhereStoresBecomeVisibleInMemory) {
    StorePass pass;
    pass.quad(0, 0);
    for (const Visibility visibility : {Visibility::writeback, Visibility::never_until_flush}) {
        RopBench bench(pass, {.shader = site(visibility), .reads = {0}, .reads_source = {.start = 50}});
        bench.run();
        EXPECT_EQ(bench.read_at(0), 50 + from_memory);
        EXPECT_EQ(bench.read_value(0), cleared); // stored at 2, still in the tile cache only
        EXPECT_EQ(bench.stored(0), 1.0F);
    }
}

TEST(RopStore, TargetsAreReadOneByOneOrAllAtOneInstant) {
    StorePass pass("rgbz");
    for (const bool atomic : {false, true}) {
        ShaderSite shader = site(Visibility::writeback);
        shader.atomic_reads = atomic;
        RopBench bench(pass, {.shader = shader, .reads = {0}});
        bench.run();
        EXPECT_EQ(bench.request_cycles(MemoryClient::kbuffer_read), (atomic ? Cycles{2} : Cycles{2, 3, 4, 5}));
        EXPECT_EQ(bench.memory.arrivals[0].request.bytes, atomic ? 256U : 64U);
        EXPECT_EQ(bench.reads_done->cycles(), (Cycles{atomic ? from_memory + 1 : from_memory + 3 + 1}));
    }
}

TEST(RopStore, ReadsAreAcceptedAtTheirRateAndAnsweredInOrder) {
    StorePass pass;
    pass.quad(0, 0);
    RopBench bench(pass, {.rop = {.read_latency = 50},
                          .shader = site(Visibility::rop_cache),
                          .reads = {0, 1, 2, 3},
                          .reads_source = {.start = 10}});
    bench.run();
    EXPECT_EQ(bench.reads_done->cycles(), (Cycles{62, 63, 64, 65}));
    std::vector<std::uint32_t> threads;
    for (const pipeline::KBufferReadDone& done : bench.reads_done->values()) threads.push_back(done.thread);
    EXPECT_EQ(threads, tests::counting(4));
}

// A cache of one tile: the second quad is admitted at 401 and drives the first one's tile out.
TEST(RopStore, WrittenBackStoreIsVisibleFromTheNextCycleOn) {
    StorePass pass;
    for (const std::uint32_t x : {0U, 4U}) pass.quad(x, 0);
    for (const auto& [sampled, value] : {std::pair{401U, cleared}, {402U, 1.0F}}) {
        RopBench bench(pass, {.rop = {.cache_tiles = 1},
                              .shader = site(Visibility::writeback),
                              .reads = {0},
                              .reads_source = {.start = sampled - from_memory},
                              .source = {.gap = 400}});
        bench.run();
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{402}));
        EXPECT_EQ(bench.read_at(0), sampled);
        EXPECT_EQ(bench.read_value(0), value);
        EXPECT_EQ(bench.history.store(0, 0).visible, 402U);
    }
}

// The tile is driven out at 401. The command is executed at 802; the tile of the second quad is written at 803, and at
// 804 what had been driven out is declared observable.
TEST(RopStore, NothingIsVisibleUntilAFlushWhereTheHardwareSaysSo) {
    StorePass pass;
    for (const std::uint32_t x : {0U, 4U}) pass.quad(x, 0);
    std::vector<QuadTask> tasks = pass.quad_tasks();
    tasks.push_back(write_back());
    for (const auto& [sampled, value] : {std::pair{600U, cleared}, {804U, cleared}, {805U, 1.0F}}) {
        RopBench bench(pass,
                       {.rop = {.cache_tiles = 1},
                        .shader = site(Visibility::never_until_flush),
                        .reads = {0},
                        .reads_source = {.start = sampled - from_memory},
                        .source = {.gap = 400}},
                       tasks);
        bench.run();
        EXPECT_EQ(bench.requested_tiles(MemoryClient::tile_write), (Tiles{0, 1}));
        EXPECT_EQ(bench.read_at(0), sampled);
        EXPECT_EQ(bench.read_value(0), value);
        EXPECT_EQ(bench.commits->cycles().back(), 806U);
    }
}

TEST(RopStore, WriteThroughWritesTheBlockAndIsVisibleInTheNextCycle) {
    StorePass pass;
    for (int i = 0; i < 2; ++i) pass.quad(2, 0);
    ShaderSite shader = site(Visibility::writeback);
    shader.write_through = true;
    for (const auto& [sampled, value] : {std::pair{202U, 1.0F}, {203U, 2.0F}}) {
        RopBench bench(
            pass,
            {.shader = shader, .reads = {1}, .reads_source = {.start = sampled - from_memory}, .source = {.gap = 200}});
        bench.run();
        EXPECT_EQ(bench.read_value(0), value);
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{3, 203}));
        EXPECT_EQ(bench.memory.arrivals[0].request.bytes, 64U);
        bench.write_back();
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), 2U); // nothing is left to write
    }
}

// Executed at 5; one dirty tile per cycle at 6, 7 and 8; the acknowledgement at 9. The quad behind it waits.
TEST(RopStore, InBandWriteBackIsAcknowledgedWhenAllDirtyTilesAreOnTheirWay) {
    StorePass pass;
    for (std::uint32_t i = 0; i < 4; ++i) pass.quad(i % 3 * 4, 0);
    std::vector<QuadTask> tasks = pass.quad_tasks();
    tasks.insert(tasks.begin() + 3, write_back());
    RopBench bench(pass, {.shader = site(Visibility::writeback)}, tasks);
    bench.run();
    std::vector<QuadKind> kinds;
    for (const pipeline::Commit& commit : bench.commits->values()) kinds.push_back(commit.kind);
    EXPECT_EQ(kinds,
              (std::vector{QuadKind::quad, QuadKind::quad, QuadKind::quad, QuadKind::writeback, QuadKind::quad}));
    EXPECT_EQ(bench.commits->cycles(), (Cycles{3, 4, 5, 10, 10}));
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{7, 8, 9}));
    EXPECT_EQ(bench.rop.stats().quads, 4U); // the command is none
}

TEST(RopStore, CoherentTextureCachesAreToldWhenAStoreBecomesVisible) {
    StorePass pass;
    pass.quad(2, 0);
    pass.quad(4, 0);
    const auto blocks = [&](Visibility visibility) {
        RopBench bench(pass, {.rop = {.cache_tiles = 1},
                              .shader = site(visibility, TextureCoherence::invalidate_on_write),
                              .source = {.gap = 400}});
        bench.run();
        std::vector<std::pair<std::uint32_t, sim::Cycle>> told;
        for (const auto& arrival : bench.invalidations->arrivals())
            told.emplace_back(arrival.value.block, arrival.cycle);
        return told;
    };
    using Told = std::vector<std::pair<std::uint32_t, sim::Cycle>>;
    EXPECT_EQ(blocks(Visibility::rop_cache), (Told{{1, 3}, {4, 403}}));
    EXPECT_EQ(blocks(Visibility::writeback), (Told{{0, 402}, {1, 402}, {2, 402}, {3, 402}})); // the whole tile
}

TEST(RopStore, ModesAgreeUnderAllVisibilities) {
    StorePass pass("rgbz");
    for (std::uint32_t i = 0; i < 200; ++i) pass.quad(i * 6 % 32, i * 10 % 16, static_cast<std::uint8_t>(i % 15 + 1));
    std::vector<std::uint32_t> blocks;
    for (std::uint32_t i = 0; i < 100; ++i) blocks.push_back(i * 7 % 32);
    std::vector<QuadTask> tasks = pass.quad_tasks();
    tasks.insert(tasks.begin() + 100, write_back());
    for (const Visibility visibility : {Visibility::rop_cache, Visibility::writeback, Visibility::never_until_flush})
        tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
            RopBench bench(pass,
                           {.rop = {.units = 4, .cache_tiles = 4, .queue = 8},
                            .shader = site(visibility, TextureCoherence::invalidate_on_write),
                            .memory_latency = 30,
                            .reads = blocks,
                            .reads_source = {.gap = 5},
                            .mode = mode,
                            .shuffle = shuffle},
                           tasks);
            bench.run();
            std::vector<float> values;
            for (std::uint32_t read = 0; read < 100; ++read) values.push_back(bench.read_value(read));
            EXPECT_EQ(bench.reads_done->size(), 100U);
            EXPECT_EQ(bench.commits->size(), 201U);
            return std::tuple(bench.commits->cycles(), bench.reads_done->cycles(), values, bench.rop.activity_times());
        });
}

} // namespace
