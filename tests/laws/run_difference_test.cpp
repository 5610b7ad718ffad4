// The comparison of two runs that the laws rest on notices every difference but that of the host.
#include "tests/support/replay.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using pipeline::RunResult;
using support::Replay;

TEST(Laws, ComparisonOfRunsSeesEveryDifference) {
    const RunResult run = Replay("gen:blob?triangles=3000", {.width = 48, .height = 48}).run("existing");
    ASSERT_FALSE(run.pairs.empty());
    const auto changed = [&](auto change) {
        RunResult other = run;
        change(other);
        return support::difference(run, other);
    };
    EXPECT_EQ(changed([](RunResult& r) { r.host_seconds += 1, ++r.host_ticks; }), "");
    EXPECT_NE(changed([](RunResult& r) { ++r.cycles; }), "");
    EXPECT_NE(changed([](RunResult& r) { r.kbuffer[5] += 1.0F; }), "");
    EXPECT_NE(changed([](RunResult& r) { ++r.pairs.back().read; }), "");
    EXPECT_NE(changed([](RunResult& r) { ++r.layers.back().missing; }), "");
    EXPECT_NE(changed([](RunResult& r) { r.stages["rop"]["counters"]["quads"] = 0; }), "");
    EXPECT_NE(changed([](RunResult& r) { r.passes.back().counters["rop"]["quads"] = 0; }), "");
    EXPECT_NE(changed([](RunResult& r) { r.draws.back().counters.at(0) = 7; }), "");
    EXPECT_NE(changed([](RunResult& r) { r.area["added_state_bits"] = 1; }), "");
}
