// The crossbar between a source of quads and one sink per ROP partition.
#include "pipeline/output/crossbar.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

namespace output_crossbar_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::FragmentEnd;
using pipeline::QuadKind;
using pipeline::QuadTask;

struct Bench {
    tests::Rig rig;
    pipeline::Crossbar unit;
    tests::Source<QuadTask> source;
    std::deque<tests::Sink<QuadTask>> sinks;

    Bench(const tests::QuadPass& pass, std::vector<QuadTask> tasks, const pipeline::CrossbarParams& params,
          const std::vector<tests::SinkOptions>& sink_options, sim::Mode mode = sim::Mode::normal,
          std::uint64_t shuffle = 1)
        : rig(mode, 1, shuffle),
          unit(rig.context("crossbar"), params, pass.context, pass.context.layout.partitions),
          source(rig.context("source"), std::move(tasks)) {
        sim::connect(source.out, unit.quads_in, {1, 4, 16});
        for (std::uint32_t rop = 0; rop < pass.context.layout.partitions; ++rop) {
            sinks.emplace_back(rig.context("rop" + std::to_string(rop)),
                               rop < sink_options.size() ? sink_options[rop] : tests::SinkOptions{});
            sim::connect(unit.partitions_out[rop], sinks[rop].in,
                         {params.latency, 1, static_cast<std::uint32_t>(params.latency) + 1});
        }
        rig.simulation.run();
    }
};

TEST(Crossbar, SendsEachQuadToThePartitionOfItsTile) {
    tests::QuadPass pass(64, 64, 4);
    pass.quads(256);
    const Bench bench(pass, pass.quad_tasks(), {}, {});
    std::size_t total = 0;
    for (std::uint32_t rop = 0; rop < 4; ++rop) {
        const auto quads = tests::quads_of(bench.sinks[rop].values());
        EXPECT_TRUE(std::is_sorted(quads.begin(), quads.end()));
        for (const pipeline::QuadId id : quads) {
            const pipeline::Quad& quad = pass.stream.quads[id];
            EXPECT_EQ(pass.context.layout.partition_of(quad.x, quad.y), rop);
        }
        EXPECT_EQ(quads.size(), 64U);
        total += quads.size();
    }
    EXPECT_EQ(bench.unit.stats().quads, total);
}

// Sent at cycle 0, received at 1, `latency` cycles to the partition.
TEST(Crossbar, LatencyIsExact) {
    tests::QuadPass pass;
    pass.quad(0, 0);
    for (const std::uint32_t latency : {1U, 10U, 33U}) {
        const Bench bench(pass, pass.quad_tasks(), {.bytes_per_clk = 64, .latency = latency, .queue = 16}, {});
        EXPECT_EQ(bench.sinks[0].cycles(), (Cycles{1 + latency}));
    }
}

TEST(Crossbar, LinkIsBusyForTheBytesOfTheFragmentOutputs) {
    tests::QuadPass pass(64, 64, 1, 4, "rgbz"); // 64 bytes per pixel
    pass.quads(4);
    pass.context.end = FragmentEnd::kbuffer_store;
    const Bench stores(pass, pass.quad_tasks(), {.bytes_per_clk = 64, .latency = 1, .queue = 16}, {});
    EXPECT_EQ(stores.sinks[0].cycles(), (Cycles{2, 6, 10, 14})); // 256 bytes each
    EXPECT_EQ(stores.unit.stats().bytes, 4U * 256);

    pass.context.end = FragmentEnd::kbuffer_blend; // one entry of 16 bytes per fragment
    const Bench entries(pass, pass.quad_tasks(), {.bytes_per_clk = 64, .latency = 1, .queue = 16}, {});
    EXPECT_EQ(entries.sinks[0].cycles(), (Cycles{2, 3, 4, 5}));
    EXPECT_EQ(entries.unit.stats().bytes, 4U * 64);
}

TEST(Crossbar, BytesOfAFragmentFollowFromHowThePassEnds) {
    tests::QuadPass pass(64, 64, 1, 16, "z");
    tests::Rig rig;
    const pipeline::Crossbar unit(rig.context("crossbar"), {}, pass.context, 1);
    EXPECT_EQ(unit.bytes_per_fragment(), 4U); // depth
    pass.context.colours = {{0, 8}};
    EXPECT_EQ(unit.bytes_per_fragment(), 12U);
    pass.context.end = FragmentEnd::kbuffer_blend;
    EXPECT_EQ(unit.bytes_per_fragment(), 4U); // a z entry
    pass.context.end = FragmentEnd::kbuffer_store;
    EXPECT_EQ(unit.bytes_per_fragment(), 64U); // sixteen of them
}

TEST(Crossbar, OnlyLivingPixelsCostBytes) {
    tests::QuadPass pass(64, 64, 1, 4, "rgbz");
    pass.context.end = FragmentEnd::kbuffer_store;
    pass.quad(0, 0, 0b0001);
    pass.quad(0, 0, 0b0011);
    pass.quad(0, 0, 0b1111);
    const Bench bench(pass, pass.quad_tasks(), {.bytes_per_clk = 64, .latency = 1, .queue = 16}, {});
    EXPECT_EQ(bench.sinks[0].cycles(), (Cycles{2, 3, 5}));
    EXPECT_EQ(bench.unit.stats().bytes, 7U * 64);
}

// Group 0 takes nothing before cycle 100: two of its quads are on the wire, the others wait in its queue.
TEST(Crossbar, QuadsPassAGroupThatIsHeldUntilItsQueueIsFull) {
    tests::QuadPass pass(64, 64, 2);
    for (std::uint32_t i = 0; i < 10; ++i) pass.quad(0, 0); // group 0
    pass.quad(4, 0);                                        // group 1
    for (const auto& [queue, passes] : {std::pair{4U, false}, {7U, false}, {8U, true}, {16U, true}}) {
        const Bench bench(pass, pass.quad_tasks(), {.bytes_per_clk = 64, .latency = 1, .queue = queue},
                          {{.start = 100}, {}});
        EXPECT_EQ(tests::quads_of(bench.sinks[0].values()), tests::counting(10));
        EXPECT_EQ(bench.sinks[1].cycles().at(0) < 20, passes) << queue;
        EXPECT_GT(bench.unit.activity_times()[static_cast<std::size_t>(sim::Activity::blocked)], 80'000U);
    }
}

TEST(Crossbar, BroadcastsACommandToAllPartitionsAtOnceInOrder) {
    tests::QuadPass pass(64, 64, 2);
    pass.quad(0, 0);
    pass.quad(4, 0);
    std::vector<QuadTask> tasks = pass.quad_tasks();
    QuadTask command;
    command.kind = QuadKind::writeback;
    tasks.insert(tasks.begin() + 1, command);
    const Bench bench(pass, tasks, {.bytes_per_clk = 64, .latency = 1, .queue = 1}, {{.start = 50}, {}});
    ASSERT_EQ(bench.sinks[0].size(), 2U);
    ASSERT_EQ(bench.sinks[1].size(), 2U);
    EXPECT_EQ(bench.sinks[0].values()[1].kind, QuadKind::writeback);
    EXPECT_EQ(bench.sinks[1].values()[0].kind, QuadKind::writeback);
    EXPECT_EQ(bench.sinks[1].values()[1].quad, 1U);
    EXPECT_EQ(bench.unit.stats().quads, 2U); // a command is no quad
}

TEST(Crossbar, SameInAllModes) {
    tests::QuadPass pass(64, 64, 3, 4, "rgbz");
    pass.context.end = FragmentEnd::kbuffer_store;
    for (std::uint32_t i = 0; i < 200; ++i) pass.quad(i * 6 % 64, i * 10 % 64, static_cast<std::uint8_t>(i % 15 + 1));
    tests::expect_same_in_all_modes([&](std::uint64_t, sim::Mode mode, std::uint64_t shuffle) {
        const Bench bench(pass, pass.quad_tasks(), {.bytes_per_clk = 48, .latency = 3, .queue = 2},
                          {{.every = 3}, {.every = 5}, {}}, mode, shuffle);
        std::vector<Cycles> cycles;
        for (const auto& sink : bench.sinks) cycles.push_back(sink.cycles());
        return std::tuple(cycles, bench.unit.activity_times());
    });
}

} // namespace output_crossbar_test
