// A fragment pipe that reads the k-buffer: what it samples when, from its L1 cache or from the memory side.
#include "tests/support/pipe_kit.hpp"

#include <set>

namespace fragment_pipeline_kbuffer_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::QuadKind;
using pipeline::QuadTask;
using pipeline::ShaderSite;
using pipeline::TextureCoherence;
using tests::MockKBuffer;
using tests::PipeBench;
using tests::PipeOptions;

ShaderSite site(TextureCoherence coherence = TextureCoherence::none) {
    ShaderSite site;
    site.coherence = coherence;
    return site;
}

/// One render target, and a program of three scalar operations: it issues in one cycle, like the shader before it.
struct OneTarget : tests::QuadPass {
    OneTarget() : QuadPass(64, 64, 1, 1, "z") {}
};

constexpr sim::Cycle through = 30;            ///< the pipe, once before the read and once behind it
constexpr sim::Cycle looked_up = 1 + through; ///< the L1 lookup of a quad that is received at cycle 1
constexpr sim::Cycle unit = 4;                ///< texture unit time of one render target
constexpr sim::Cycle hit_latency = 40;

TEST(FragmentPipelineKBuffer, MissIsServedByTheMemorySideAndSampledThere) {
    OneTarget pass;
    pass.quad(6, 2);
    PipeBench bench(pass, {.site = site(), .kbuffer_latency = 100});
    bench.run();
    ASSERT_EQ(bench.kbuffer->reads.size(), 1U);
    EXPECT_EQ(bench.kbuffer->reads[0].block, pass.context.layout.block_of(6, 2));
    EXPECT_EQ(bench.kbuffer->reads[0].targets, 1U);
    EXPECT_EQ(bench.kbuffer->cycles[0], looked_up + 1);
    EXPECT_EQ(bench.read_at(0), looked_up + 1 + 100);
    EXPECT_EQ(bench.done(0), looked_up + 1 + 100 + 1 + through + 1); // two links
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_misses, 1U);
    EXPECT_EQ(bench.pipe.stats().kbuffer_reads, 1U);
}

TEST(FragmentPipelineKBuffer, HitSamplesTheSnapshotAtTheLookup) {
    OneTarget pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    // A store after the line was filled: the hit does not see it.
    PipeBench bench(pass, {.site = site(), .stores = {{500, 0}}, .source = {.gap = 1000}});
    bench.run();
    EXPECT_EQ(bench.kbuffer->reads.size(), 1U);
    EXPECT_EQ(bench.read_at(1), 1000 + looked_up);
    EXPECT_EQ(bench.read_version(1), 0U);
    EXPECT_EQ(bench.done(1), 1000 + looked_up + unit + hit_latency + through + 1);
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_hits, 1U);
}

// A value that comes back is worked on by the whole pipe again: its program issues for as many cycles as it has vector
// instructions, before quads that have not started.
TEST(FragmentPipelineKBuffer, ProgramBehindTheReadIsASecondWayThroughThePipe) {
    for (const std::uint32_t instructions : {1U, 2U, 9U, 40U}) {
        OneTarget pass;
        for (std::uint32_t i = 0; i < 2; ++i) pass.quad(8 * i, 0);
        pass.context.shader_costs[0].behind_read = instructions;
        PipeBench bench(pass, {.fragment = {.alu_per_clk = 2}, .site = site(), .kbuffer_latency = 100});
        bench.run();
        const sim::Cycle issue = (instructions + 1) / 2;
        const sim::Cycle back = looked_up + 1 + 100 + 1;
        EXPECT_EQ(bench.done(0), back + through + issue - 1 + 1);
        EXPECT_EQ(bench.done(1),
                  std::max<sim::Cycle>(back + 4, back + issue) + through + issue - 1 + 1); // texture unit
        EXPECT_EQ(bench.pipe.stats().issue_cycles, 2 + 2 * issue);
    }
}

TEST(FragmentPipelineKBuffer, BypassReadsTheMemorySideEveryTime) {
    OneTarget pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    ShaderSite bypass = site();
    bypass.bypass_l1 = true;
    PipeBench bench(pass, {.site = bypass, .stores = {{500, 0}}, .source = {.gap = 1000}});
    bench.run();
    EXPECT_EQ(bench.kbuffer->reads.size(), 2U);
    EXPECT_EQ(bench.read_version(0), 0U);
    EXPECT_EQ(bench.read_version(1), 1U);
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_misses, 2U);
}

TEST(FragmentPipelineKBuffer, ReadsOfALineOnItsWayJoinIt) {
    OneTarget pass;
    for (int i = 0; i < 5; ++i) pass.quad(0, 0);
    PipeBench bench(pass, {.site = site(), .kbuffer_latency = 300});
    bench.run();
    EXPECT_EQ(bench.kbuffer->reads.size(), 1U);
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_misses, 1U);
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_merged, 4U);
    for (std::uint32_t i = 0; i < 5; ++i) {
        EXPECT_EQ(bench.read_at(i), looked_up + 1 + 300);
        EXPECT_EQ(bench.done(i), looked_up + 1 + 300 + 2 + through + i); // one program issues a cycle
    }
}

TEST(FragmentPipelineKBuffer, AMissIsJoinedOnlyWhenALineWasLeftForIt) {
    OneTarget pass;
    for (const std::uint32_t x : {0U, 8U, 8U, 0U}) pass.quad(x, 0);
    PipeBench bench(pass, {.texture = {.l1_bytes = 64, .l1_ways = 1}, .site = site(), .kbuffer_latency = 300});
    bench.run();
    EXPECT_EQ(bench.kbuffer->reads.size(), 3U); // the first quad's line is the only one
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_misses, 3U);
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_merged, 1U);
}

TEST(FragmentPipelineKBuffer, ReadsPastTheL1WantThePixelsOfTheQuadOnly) {
    for (const bool past : {true, false}) {
        OneTarget pass;
        pass.quad(0, 0, 0b0101);
        ShaderSite shader = site();
        shader.bypass_l1 = past;
        PipeBench bench(pass, {.site = shader});
        bench.run();
        EXPECT_EQ(bench.kbuffer->reads.at(0).pixels, past ? 0b0101 : 0b1111);
    }
}

TEST(FragmentPipelineKBuffer, TextureUnitReadsOneTargetEveryFourCycles) {
    tests::QuadPass pass(64, 64, 1, 4, "rgbz"); // four targets
    for (std::uint32_t i = 0; i < 4; ++i) pass.quad(8 * i, 0);
    PipeBench bench(pass, {.site = site()});
    bench.run();
    for (std::uint32_t i = 1; i < 4; ++i) EXPECT_EQ(bench.kbuffer->cycles[i] - bench.kbuffer->cycles[i - 1], 16U);
    EXPECT_EQ(bench.pipe.stats().texture_cycles, 64U);
    EXPECT_EQ(bench.kbuffer->reads[0].targets, 15U);
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_misses, 16U); // one line per target
}

TEST(FragmentPipelineKBuffer, HitsMissesAndMergesAreTheLookups) {
    tests::QuadPass pass(64, 64, 1, 4, "rgbz");
    for (std::uint32_t i = 0; i < 200; ++i) pass.quad(i * 6 % 32, i * 10 % 32);
    for (const bool atomic : {false, true}) {
        ShaderSite shader = site();
        shader.atomic_reads = atomic;
        PipeBench bench(pass, {.texture = {.l1_bytes = 2048}, .site = shader});
        bench.run();
        const auto& l1 = bench.pipe.stats().l1;
        EXPECT_EQ(l1.kbuffer_hits + l1.kbuffer_misses + l1.kbuffer_merged, atomic ? 200U : 800U);
        std::uint64_t asked = 0;
        for (const pipeline::KBufferRead& read : bench.kbuffer->reads)
            asked += static_cast<std::uint64_t>(std::popcount(read.targets));
        EXPECT_EQ(asked, l1.kbuffer_misses * (atomic ? 4U : 1U));
        EXPECT_EQ(bench.sink.size(), 200U);
    }
}

// Two of four lines of a block are evicted: the reads of one quad then hold two versions.
TEST(FragmentPipelineKBuffer, PartialHitsGiveTornReadsUnlessReadsAreAtomic) {
    tests::QuadPass pass(64, 64, 1, 4, "rgbz");
    pass.quad(0, 0);
    pass.quad(8, 0); // its lines share sets with those of the first block
    pass.quad(0, 0);
    const auto versions = [&](bool atomic) {
        ShaderSite shader = site();
        shader.atomic_reads = atomic;
        PipeBench bench(pass, {.texture = {.l1_bytes = 64 * 6, .l1_ways = 6},
                               .site = shader,
                               .stores = {{500, 0}},
                               .source = {.gap = 1000}});
        bench.run();
        std::set<std::uint32_t> found;
        for (std::uint32_t target = 0; target < 4; ++target) found.insert(bench.read_version(2, target));
        return found;
    };
    EXPECT_EQ(versions(false), (std::set<std::uint32_t>{0, 1}));
    EXPECT_EQ(versions(true).size(), 1U);
}

TEST(FragmentPipelineKBuffer, DrawBoundaryDropsTheLinesWhenToldTo) {
    for (const TextureCoherence coherence : {TextureCoherence::none, TextureCoherence::invalidate_on_draw}) {
        OneTarget pass;
        for (const std::uint32_t draw : {0U, 0U, 1U}) {
            pass.triangle(draw);
            pass.quad(0, 0);
        }
        PipeBench bench(pass, {.site = site(coherence), .stores = {{500, 0}}, .source = {.gap = 1000}});
        bench.run();
        EXPECT_EQ(bench.read_version(1), 0U);
        EXPECT_EQ(bench.read_version(2), coherence == TextureCoherence::none ? 0U : 1U);
    }
}

TEST(FragmentPipelineKBuffer, CommandDropsTheLinesAndIsNoQuad) {
    OneTarget pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    std::vector<QuadTask> tasks = pass.quad_tasks();
    QuadTask command;
    command.kind = QuadKind::invalidate;
    tasks.insert(tasks.begin() + 1, command);
    PipeBench bench(pass, {.site = site(), .stores = {{500, 0}}, .source = {.gap = 1000}}, tasks);
    bench.run();
    EXPECT_EQ(bench.read_version(1), 1U);
    EXPECT_EQ(bench.pipe.stats().quads, 2U);
    EXPECT_EQ(bench.pipe.stats().l1.invalidations, 1U);
}

// The line is asked for before, and comes back after the command: it must not be found later.
TEST(FragmentPipelineKBuffer, LineOnItsWayAtACommandIsNotKept) {
    OneTarget pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    std::vector<QuadTask> tasks = pass.quad_tasks();
    QuadTask command;
    command.kind = QuadKind::invalidate;
    tasks.insert(tasks.begin() + 1, command);
    PipeBench bench(pass, {.site = site(), .kbuffer_latency = 1500, .source = {.gap = 1000}}, tasks);
    bench.run();
    EXPECT_EQ(bench.kbuffer->reads.size(), 2U);
}

TEST(FragmentPipelineKBuffer, CoherentCacheSeesAStoreFromTheNextCycleOn) {
    OneTarget pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    const auto version_read = [&](sim::Cycle store) {
        PipeBench bench(
            pass,
            {.site = site(TextureCoherence::invalidate_on_write), .stores = {{store, 0}}, .source = {.gap = 1000}});
        bench.run();
        return std::pair(bench.read_version(1), bench.kbuffer->reads.size());
    };
    const sim::Cycle lookup = 1000 + looked_up;
    EXPECT_EQ(version_read(lookup - 1), (std::pair(1U, std::size_t{2}))); // invalidated at the lookup's cycle
    EXPECT_EQ(version_read(lookup), (std::pair(0U, std::size_t{1})));     // one too late
}

// The value is sampled, then stored to, then comes back: who waits gets it, but it must not be found later.
TEST(FragmentPipelineKBuffer, CoherentCacheKeepsNoLineThatWasSampledBeforeTheStore) {
    OneTarget pass;
    for (int i = 0; i < 2; ++i) pass.quad(0, 0);
    tests::PipeOptions options{.site = site(TextureCoherence::invalidate_on_write), .kbuffer_latency = 100};
    options.stores = {{looked_up + 1 + 100, 0}}; // in the cycle of the sample, after it
    options.source = {.gap = 1000};
    PipeBench bench(pass, options);
    bench.run();
    EXPECT_EQ(bench.read_version(0), 0U);
    EXPECT_EQ(bench.read_version(1), 1U);
    EXPECT_EQ(bench.kbuffer->reads.size(), 2U);
}

TEST(FragmentPipelineKBuffer, LaterQuadsDoNotJoinALineThatWasInvalidatedOnItsWay) {
    OneTarget pass;
    for (int i = 0; i < 3; ++i) pass.quad(0, 0);
    // The first two read version 0; the store falls between the lookups of the second and the third.
    tests::PipeOptions options{.site = site(TextureCoherence::invalidate_on_write), .kbuffer_latency = 100};
    options.source = {.gap = 20};
    options.stores = {{looked_up + 25, 0}};
    PipeBench bench(pass, options);
    bench.run();
    EXPECT_EQ(bench.kbuffer->reads.size(), 2U);
    EXPECT_EQ(bench.pipe.stats().l1.kbuffer_merged, 1U);
    EXPECT_EQ(bench.read_version(2), 1U);
}

TEST(FragmentPipelineKBuffer, RunsTheProgramOnWhatItRead) {
    OneTarget pass;
    pass.quad(0, 0, 15, 0.25F);
    PipeBench bench(pass, {.site = site(), .stores = {{0, 0}}}); // memory holds 1.0 in every channel
    bench.run();
    EXPECT_EQ(bench.payloads.values(0, 0)[0], 0.25F);
    EXPECT_EQ(bench.payloads.values(0, 3)[0], 0.25F);
}

TEST(FragmentPipelineKBuffer, SameInAllModes) {
    for (const TextureCoherence coherence :
         {TextureCoherence::none, TextureCoherence::invalidate_on_draw, TextureCoherence::invalidate_on_write}) {
        tests::QuadPass pass(64, 64, 1, 2, "rgbz");
        for (std::uint32_t i = 0; i < 300; ++i) {
            if (i % 40 == 0) pass.triangle(i / 80);
            pass.quad(i * 6 % 32, i * 10 % 16, static_cast<std::uint8_t>(i % 15 + 1));
        }
        std::vector<MockKBuffer::Store> stores;
        for (std::uint32_t i = 0; i < 300; ++i) stores.push_back({20 + i * 9, i * 5 % 64});
        tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
            PipeBench bench(pass, {.fragment = {.quads_in_flight = 32},
                                   .texture = {.l1_bytes = 1024},
                                   .site = site(coherence),
                                   .stores = stores,
                                   .sink = {.every = 5},
                                   .mode = mode,
                                   .shuffle = shuffle});
            bench.run();
            std::vector<std::uint32_t> versions;
            for (std::uint32_t quad = 0; quad < 300; ++quad)
                for (std::uint32_t target = 0; target < 2; ++target)
                    versions.push_back(bench.read_version(quad, target));
            return std::tuple(bench.sink.cycles(), versions, bench.pipe.activity_times(),
                              bench.pipe.stats().l1.kbuffer_hits.value);
        });
    }
}

} // namespace fragment_pipeline_kbuffer_test
