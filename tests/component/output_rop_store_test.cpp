// A ROP group alone: k-buffer values computed by a shader are stored, written back and read by a texture unit.
// Links take one cycle, memory 100: a quad sent at cycle 0 is executed at 2, its commit arrives at 3; a read sent at s
// is accepted at s + 1, and reads memory's array at s + 103. A write sent at s is in that array at s + 102.
#include "tests/support/rop_kit.hpp"

namespace output_rop_store_test {

using Cycles = std::vector<sim::Cycle>;
using Lines = std::vector<std::uint64_t>;
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

TEST(RopStore, CommitsInTheCycleAfterAdmissionWithoutFetchingTheSector) {
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

// Four pixels of 64 bytes through the ports of four ROPs.
TEST(RopStore, PortOfTheCacheSetsTheRate) {
    StorePass pass("rgbz");
    pass.quads(3);
    for (const auto& [port, cycles] : {std::pair{4U, 16U}, {16U, 4U}, {64U, 1U}}) {
        RopBench bench(pass, {.rop = {.bytes_per_clk = port}, .shader = site(Visibility::rop_cache)});
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

// The second store is applied at 402. A read is accepted at s + 1 and reads the array 140 cycles later; the way back
// does not change what it carries.
TEST(RopStore, ReadFromTheCacheSeesAStoreFromTheNextCycleOn) {
    StorePass pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    for (const auto& [start, value] : {std::pair{261U, 1.0F}, {262U, 2.0F}}) {
        RopBench bench(pass, {.rop = {.read_request_latency = 140, .read_return_latency = 140},
                              .shader = site(Visibility::rop_cache),
                              .reads = {0},
                              .reads_source = {.start = start},
                              .source = {.gap = 400}});
        bench.run();
        EXPECT_EQ(bench.commits->cycles()[1], 403U);
        EXPECT_EQ(bench.read_at(0), start + 1 + 140);
        EXPECT_EQ(bench.read_value(0), value);
        EXPECT_EQ(bench.reads_done->cycles(), (Cycles{start + 1 + 280 + 1}));
        EXPECT_EQ(bench.rop.stats().kbuffer_reads_from_tiles, 1U);
        EXPECT_TRUE(bench.memory.arrivals.empty());
    }
}

TEST(RopStore, ReadOfASectorThatIsNotInTheCacheComesFromMemory) {
    StorePass pass;
    pass.quad(0, 0);
    RopBench bench(pass, {.shader = site(Visibility::rop_cache), .reads = {4}, .reads_source = {.start = 50}});
    bench.run();
    EXPECT_EQ(bench.read_at(0), 50 + from_memory);
    EXPECT_EQ(bench.read_value(0), cleared);
    EXPECT_EQ(bench.request_cycles(MemoryClient::kbuffer_read), (Cycles{52}));
    EXPECT_EQ(bench.rop.stats().kbuffer_reads_from_tiles, 0U);
}

TEST(RopStore, ReadGoesPastTheCacheWhereStoresBecomeVisibleInMemory) {
    StorePass pass;
    pass.quad(0, 0);
    for (const Visibility visibility : {Visibility::writeback, Visibility::never_until_flush}) {
        RopBench bench(pass, {.shader = site(visibility), .reads = {0}, .reads_source = {.start = 50}});
        bench.run();
        EXPECT_EQ(bench.read_at(0), 50 + from_memory);
        EXPECT_EQ(bench.read_value(0), cleared); // stored at 2, still in the cache only
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
    for (const std::uint32_t block : {0U, 1U, 2U, 3U}) pass.quad(block % 2 * 2, block / 2 * 2);
    RopBench bench(pass, {.rop = {.read_request_latency = 25, .read_return_latency = 25},
                          .shader = site(Visibility::rop_cache),
                          .reads = {0, 1, 2, 3},
                          .reads_source = {.start = 10}});
    bench.run();
    EXPECT_EQ(bench.reads_done->cycles(), (Cycles{62, 63, 64, 65}));
    std::vector<std::uint32_t> threads;
    for (const pipeline::KBufferReadDone& done : bench.reads_done->values()) threads.push_back(done.thread);
    EXPECT_EQ(threads, tests::counting(4));
}

// A cache of one sector: the second quad is admitted at 401 and drives the first one's sector out; memory has it at
// 503.
TEST(RopStore, WrittenBackStoreIsVisibleOnceTheArrayOfMemoryHasIt) {
    StorePass pass;
    for (const std::uint32_t x : {0U, 4U}) pass.quad(x, 0);
    for (const auto& [sampled, value] : {std::pair{502U, cleared}, {504U, 1.0F}}) {
        RopBench bench(pass, {.rop = {.kbuffer_cache_bytes = 64},
                              .shader = site(Visibility::writeback),
                              .reads = {0},
                              .reads_source = {.start = sampled - from_memory},
                              .source = {.gap = 400}});
        bench.run();
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{402}));
        EXPECT_EQ(bench.read_at(0), sampled);
        EXPECT_EQ(bench.read_value(0), value);
        EXPECT_EQ(bench.history.store(0, 0).visible, 504U);
    }
}

// The sector is driven out at 401. The command is executed at 802; the sector of the second quad is written at 803, and
// when memory has it, at 905, all is declared observable.
TEST(RopStore, NothingIsVisibleUntilAFlushWhereTheHardwareSaysSo) {
    StorePass pass;
    for (const std::uint32_t x : {0U, 4U}) pass.quad(x, 0);
    std::vector<QuadTask> tasks = pass.quad_tasks();
    tasks.push_back(write_back());
    for (const auto& [sampled, value] : {std::pair{600U, cleared}, {904U, cleared}, {906U, 1.0F}}) {
        RopBench bench(pass,
                       {.rop = {.kbuffer_cache_bytes = 64},
                        .shader = site(Visibility::never_until_flush),
                        .reads = {0},
                        .reads_source = {.start = sampled - from_memory},
                        .source = {.gap = 400}},
                       tasks);
        bench.run();
        EXPECT_EQ(bench.requested_lines(MemoryClient::tile_write), (Lines{0, 4}));
        EXPECT_EQ(bench.read_at(0), sampled);
        EXPECT_EQ(bench.read_value(0), value);
        EXPECT_EQ(bench.commits->cycles().back(), 906U);
    }
}

TEST(RopStore, WriteThroughIsCommittedAndVisibleWhenMemoryHasTheBlock) {
    StorePass pass;
    for (int i = 0; i < 2; ++i) pass.quad(2, 0);
    ShaderSite shader = site(Visibility::writeback);
    shader.write_through = true;
    for (const auto& [sampled, value] : {std::pair{303U, 1.0F}, {305U, 2.0F}}) {
        RopBench bench(
            pass,
            {.shader = shader, .reads = {1}, .reads_source = {.start = sampled - from_memory}, .source = {.gap = 200}});
        bench.run();
        EXPECT_EQ(bench.read_value(0), value);
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{3, 203}));
        EXPECT_EQ(bench.commits->cycles(), (Cycles{105, 305}));
        EXPECT_EQ(bench.memory.arrivals[0].request.bytes, 64U);
        bench.write_back();
        EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write).size(), 2U); // nothing is left to write
    }
}

// Executed at 5; one dirty sector per cycle at 6, 7 and 8, in memory at 108, 109 and 110. The quad behind it waits.
TEST(RopStore, InBandWriteBackIsAcknowledgedWhenMemoryHasAllDirtySectors) {
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
    EXPECT_EQ(bench.commits->cycles(), (Cycles{3, 4, 5, 111, 111}));
    EXPECT_EQ(bench.request_cycles(MemoryClient::tile_write), (Cycles{7, 8, 9}));
    EXPECT_EQ(bench.rop.stats().quads, 4U); // the command is none
}

TEST(RopStore, CoherentTextureCachesAreToldWhenAStoreBecomesVisible) {
    StorePass pass;
    pass.quad(2, 0);
    pass.quad(4, 0);
    const auto blocks = [&](Visibility visibility) {
        RopBench bench(pass, {.rop = {.kbuffer_cache_bytes = 64},
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
    EXPECT_EQ(blocks(Visibility::writeback), (Told{{1, 504}}));
}

// A pixel of four rgbz entries lies in four render targets of 64 bytes a sector; bursts have 32 bytes.
TEST(RopStore, PHY_P11_WriteBackMovesTheBurstsOfTheStoredPixelsOnly) {
    struct Expected {
        std::string_view entry;
        std::uint8_t mask;
        std::vector<std::uint32_t> bytes;
    };
    for (const Expected& expected : {Expected{"z", 0b0001, {32}}, Expected{"z", 0b1100, {32}},
                                     Expected{"z", 0b0101, {64}}, Expected{"rgbz", 0b0010, {32, 32, 32, 32}},
                                     Expected{"rgbz", 0b1111, {256}}, Expected{"rgbz", 0b0110, {256}}}) {
        StorePass pass(expected.entry);
        pass.quad(2, 0, expected.mask);
        RopBench bench(pass, {.shader = site(Visibility::writeback)});
        bench.run();
        bench.write_back();
        std::vector<std::uint32_t> bytes;
        for (const auto& [request, cycle] : bench.memory.arrivals) {
            EXPECT_TRUE(request.write);
            bytes.push_back(request.bytes);
        }
        EXPECT_EQ(bytes, expected.bytes) << expected.entry << " " << int{expected.mask};
    }
}

// The read at 50 finds one of four pixels stored; what it brings from memory completes the sector for the second one.
TEST(RopStore, ReadOfAPartlyStoredSectorTakesTheRestFromMemoryOnce) {
    StorePass pass;
    pass.quad(0, 0, 0b0001);
    RopBench bench(pass,
                   {.shader = site(Visibility::rop_cache), .reads = {0, 0}, .reads_source = {.start = 50, .gap = 500}});
    bench.run();
    EXPECT_EQ(bench.read_at(0), 50 + from_memory);
    EXPECT_EQ(bench.read_value(0), 1.0F); // merged with what was stored here
    EXPECT_EQ(bench.request_cycles(MemoryClient::kbuffer_read).size(), 1U);
    EXPECT_EQ(bench.rop.stats().kbuffer_reads_from_tiles, 1U);
}

TEST(RopStore, TileMemoryHoldsTheWholeSurfaceAndStoresWholeSectors) {
    StorePass pass;
    for (std::uint32_t i = 0; i < 64; ++i) pass.quad(i % 8 * 8, i / 8 * 8, 0b1000);
    ShaderSite shader = site(Visibility::rop_cache);
    shader.tile_memory = true;
    RopBench bench(pass, {.rop = {.kbuffer_cache_bytes = 64}, .shader = shader});
    bench.kbuffer_clear.set(pass.context.layout);
    bench.run();
    EXPECT_TRUE(bench.memory.arrivals.empty());
    bench.write_back();
    EXPECT_EQ(bench.memory.arrivals.size(), 64U);
    for (const auto& [request, cycle] : bench.memory.arrivals) EXPECT_EQ(request.bytes, 64U);
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
                           {.rop = {.kbuffer_cache_bytes = 1024, .queue = 8},
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

} // namespace output_rop_store_test
