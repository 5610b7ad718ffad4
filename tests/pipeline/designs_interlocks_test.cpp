// Interlocks: in the shader, in the ROP, in tile memory. What waiting costs, and what it never breaks.
// Source: specification 004, section 8 and the shape that measurements of interlocks show: nearly free without overlap.
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace designs_interlocks_test {

using pipeline::RunResult;
using support::counter;
using support::Replay;

using Settings = std::vector<std::string>;

double cycles(const RunResult& run) { return static_cast<double>(support::pass_named(run, "geometry").cycles); }

/// Layers over a square of 32 x 32 pixels.
Replay overlapping(std::uint32_t layers) {
    return Replay(fmt::format("gen:stack?n={}&x=0&y=0&w=32&h=32", layers), {.width = 64, .height = 64});
}

TEST(RopInterlocks, AreNearlyFreeWithoutOverlap) {
    const Replay screen("gen:quads?n=1", {.width = 256, .height = 256});
    const double without = cycles(screen.run("blender", {"blender.interlock=forward"}));
    EXPECT_LE(cycles(screen.run("cam")), 1.02 * without);
    EXPECT_LE(cycles(screen.run("hashed", {"hashed.counters=4096"})), 1.02 * without);
}

TEST(RopInterlocks, CostExactLeastThenHashedThenByTile) {
    double before = 0;
    for (const std::uint32_t layers : {4U, 16U, 64U}) {
        const Replay replay(fmt::format("gen:stack?n={}&x=0&y=0&w=8&h=8", layers * 8), {.width = 16, .height = 16});
        const auto stalls = [&](const char* design, const Settings& settings = {}) {
            const RunResult run = replay.run(design, settings);
            EXPECT_EQ(run.wrong_pixels, 0U);
            return static_cast<double>(counter(run.stages, "rop/counters/interlock_stalls"));
        };
        const double exact = stalls("cam"), hashed = stalls("hashed", {"hashed.counters=64"}),
                     tile = stalls("tile-ticket");
        EXPECT_LE(exact, hashed) << layers;
        EXPECT_LE(hashed, tile) << layers;
        EXPECT_GE(tile, before) << layers; // grows with overlap
        before = tile;
    }
    EXPECT_GT(before, 0);
}

TEST(RopInterlocks, HashedConvergesToExactAsCountersGrow) {
    const Replay mesh("gen:blob?triangles=20000", {.width = 128, .height = 128});
    const double exact = cycles(mesh.run("cam"));
    const double few = cycles(mesh.run("hashed", {"hashed.counters=4"}));
    const double many = cycles(mesh.run("hashed", {"hashed.counters=4096"}));
    EXPECT_GT(few, 1.02 * exact);
    EXPECT_NEAR(many, exact, 0.01 * exact);
}

TEST(RopInterlocks, AliasesCostStallsAndNeverAPixel) {
    const Replay replay("gen:discs?n=300&overlap=12&width=64&height=64", {.width = 64, .height = 64});
    for (const int counters : {1, 2, 7, 64}) {
        const RunResult run = replay.run("hashed", {fmt::format("hashed.counters={}", counters)});
        EXPECT_EQ(run.hazards.total(), 0U);
        EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer) << counters;
    }
    const RunResult small = replay.run("cam", {"cam.entries=1"});
    EXPECT_TRUE(small.kbuffer == replay.reference.kbuffer);
    EXPECT_GT(counter(small.stages, "rop/counters/interlock_stalls"),
              counter(replay.run("cam").stages, "rop/counters/interlock_stalls"));
}

TEST(ShaderInterlock, IsNearlyFreeWithoutOverlap) {
    const Replay screen("gen:quads?n=1", {.width = 256, .height = 256});
    const double without = cycles(screen.run("existing", {"existing.visibility=rop_cache", "existing.bypass_l1=true"}));
    for (const char* design : {"interlock", "rov"}) EXPECT_LE(cycles(screen.run(design)), 1.02 * without) << design;
}

TEST(ShaderInterlock, CostGrowsWithOverlap) {
    double before = 0;
    for (const std::uint32_t layers : {1U, 4U, 16U, 64U}) {
        const Replay replay = overlapping(layers);
        const RunResult run = replay.run("interlock");
        EXPECT_EQ(run.wrong_pixels, 0U);
        const double share = static_cast<double>(counter(run.stages, "lock_table/counters/waits")) /
                             static_cast<double>(counter(run.stages, "lock_table/counters/requests"));
        EXPECT_GE(share, before) << layers;
        before = share;
    }
    EXPECT_GT(before, 0.5);
}

TEST(ShaderInterlock, AStackOnOnePixelTakesItsLengthTimesReadAndStore) {
    // One critical section at a time: a read, the program, the way to the ROP, and the release back to the table.
    const Replay replay("gen:stack?n=500&order=random", {.width = 16, .height = 16});
    const double slow = cycles(replay.run("interlock")),
                 fast = cycles(replay.run("interlock", {"rop.read_request_latency=10", "rop.read_return_latency=10"}));
    EXPECT_NEAR(slow - fast, 500.0 * 260, 0.02 * 500 * 260);
    EXPECT_LT(slow, cycles(replay.run("scoreboard"))); // which adds shading and dispatch to each
}

TEST(ShaderInterlock, CoarserLocksWaitMore) {
    const Replay mesh("gen:blob?triangles=20000", {.width = 128, .height = 128});
    const auto waits = [&](const char* area) {
        const RunResult run = mesh.run("interlock", {fmt::format("interlock.area={}", area)});
        EXPECT_EQ(run.wrong_pixels, 0U);
        return counter(run.stages, "lock_table/counters/waits");
    };
    EXPECT_LT(waits("pixel"), waits("quad"));
    EXPECT_LT(waits("quad"), waits("tile"));
}

TEST(ShaderInterlock, EveryQuadThatEntersLeaves) {
    const Replay replay = overlapping(16);
    for (const char* ordered : {"true", "false"}) {
        const RunResult run = replay.run("interlock", {fmt::format("interlock.ordered={}", ordered)});
        EXPECT_EQ(counter(run.stages, "lock_table/counters/requests"),
                  counter(run.stages, "lock_table/counters/released"));
        EXPECT_EQ(counter(run.stages, "lock_table/counters/requests"), counter(run.stages, "rop/counters/quads"));
    }
}

TEST(FramebufferFetch, TouchesMemoryAtTheEndOnly) {
    const Replay replay("gen:quads?n=16", {.width = 64, .height = 64});
    const RunResult run = replay.run("framebuffer-fetch");
    EXPECT_EQ(run.wrong_pixels, 0U);
    EXPECT_FALSE(run.bytes->contains("dram_kbuffer_read"));
    EXPECT_FALSE(run.bytes->contains("dram_tile_read"));
    // Each tile is stored once, whatever the depth complexity.
    EXPECT_EQ(counter(run.bytes, "dram_tile_write/bytes"), 64U * 64 * 64);
}

TEST(FramebufferFetch, RefusesProgramsThatDoNotFitIntoTileMemory) {
    const Replay sixteen("gen:stack?n=2", {8, 8, "transparency", "auto", {"k=16"}});
    EXPECT_THROW(sixteen.run("framebuffer-fetch"), sim::InputError);
    EXPECT_EQ(sixteen.run("framebuffer-fetch", {"framebuffer-fetch.bytes_per_pixel=256"}).wrong_pixels, 0U);
}

TEST(Detect, SeesEveryHazardThatItsNumbersCanTell) {
    const Replay mesh("gen:blob?triangles=20000", {.width = 128, .height = 128});
    const RunResult plain = mesh.run("existing");
    const auto of = [&](int bits, const char* name) {
        const RunResult run = mesh.run("detect", {fmt::format("detect.version_bits={}", bits)});
        EXPECT_EQ(run.cycles, plain.cycles); // it prevents nothing and costs no time
        EXPECT_EQ(run.hazards.total(), plain.hazards.total());
        return counter(run.stages, std::string("rop/counters/") + name);
    };
    ASSERT_GT(plain.hazards.total(), 0U);
    EXPECT_EQ(of(31, "hazards_detected"), plain.hazards.total());
    EXPECT_EQ(of(31, "hazards_overlooked"), 0U);
    EXPECT_EQ(of(1, "hazards_detected") + of(1, "hazards_overlooked"), plain.hazards.total());
    EXPECT_GT(of(1, "hazards_overlooked"), 0U);
}

} // namespace designs_interlocks_test
