// Quads in flight follow from the registers of the shader, the entries of a pixel included where it holds them.
#include "pipeline/functional/shader.hpp"
#include "tests/support/replay.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

using support::counter;
using support::Replay;

constexpr std::uint32_t registers = 1024;

std::uint32_t shader_registers(const pipeline::Frame& frame) {
    std::uint32_t most = 1;
    for (const pipeline::Draw& draw : frame.draws)
        most = std::max(most, pipeline::shader_cost(frame.resources->materials[draw.material],
                                                    frame.resources->geometries[draw.geometry], frame.needs)
                                  .registers);
    return most;
}

std::uint64_t in_flight(const Replay& replay, const std::string& design, const std::string& pass) {
    const auto run = replay.run(design, {"fragment.pipes=1", fmt::format("fragment.registers={}", registers),
                                         "framebuffer-fetch.bytes_per_pixel=1024"});
    return counter(support::pass_named(run, pass).counters, "fragment/in_flight_max");
}

} // namespace

// As with the side buffer of the scoreboard: more quads in flight between two visits of a tile.
TEST(Occupancy, PHY_S6_MoreQuadsInFlightLoseWhatTheTileCachesCannotHold) {
    const Replay replay("gen:discs?n=150&overlap=8&width=128&height=128", {.width = 128, .height = 128});
    const auto run = [&](int quads, const char* tiles) {
        return replay.run("rov",
                          {fmt::format("fragment.quads_in_flight={}", quads), "fragment.registers=65536", tiles});
    };
    const auto misses = [](const auto& run) { return counter(run.stages, "rop/counters/kbuffer_tiles/misses"); };
    const auto few = run(64, "rop.kbuffer_cache_bytes=131072"), many = run(2048, "rop.kbuffer_cache_bytes=131072");
    EXPECT_GT(misses(many), misses(few) * 3 / 2);
    EXPECT_GT(many.cycles, few.cycles);
    const auto few_on_chip = run(64, "rop.kbuffer_cache_bytes=1048576"),
               many_on_chip = run(2048, "rop.kbuffer_cache_bytes=1048576");
    EXPECT_EQ(misses(many_on_chip), misses(few_on_chip));
    EXPECT_LE(static_cast<double>(many_on_chip.cycles), 1.02 * static_cast<double>(few_on_chip.cycles));
}

TEST(Occupancy, ShadersThatHoldTheEntriesNeedARegisterForEachTarget) {
    for (const std::uint32_t k : {4U, 16U, 64U}) {
        const Replay replay("gen:quads?n=4", {64, 64, "transparency", "auto", {fmt::format("k={}", k)}});
        const std::uint32_t own = shader_registers(replay.frame);
        ASSERT_EQ(replay.frame.program->targets(), k); // four floats an entry
        for (const char* design : {"existing", "scoreboard", "detect", "interlock", "rov", "framebuffer-fetch"})
            EXPECT_EQ(in_flight(replay, design, "geometry"), std::min(256U, registers / (own + k))) << design << k;
    }
}
