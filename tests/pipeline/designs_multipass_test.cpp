// Design `multipass` in time: passes, rejected fragments and copies of traditional depth peeling.
// Source: specification 004, section 7.6.
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace designs_multipass_test {

using pipeline::RunResult;
using support::counter;
using support::Replay;

const Replay& layers(std::uint32_t k) {
    static std::map<std::uint32_t, Replay> made;
    const auto found = made.find(k);
    if (found != made.end()) return found->second;
    return made
        .emplace(k, Replay("gen:quads?n=6&order=random", {64, 64, "transparency", "auto", {fmt::format("k={}", k)}}))
        .first->second;
}

TEST(MultipassDesign, ExecutesOnePassPerLayerWithTheWholeGeometry) {
    for (const std::uint32_t k : {1U, 4U, 6U, 9U}) {
        const RunResult run = layers(k).run("multipass");
        std::size_t passes = 0;
        for (const pipeline::PassResult& pass : run.passes) {
            if (!pass.name.starts_with("geometry layer")) continue;
            ++passes;
            EXPECT_EQ(counter(pass.counters, "raster/triangles"), 12U);
            EXPECT_EQ(counter(pass.counters, "raster/fragments"), 6U * 4096U);
        }
        EXPECT_EQ(passes, k);
        EXPECT_EQ(run.wrong_pixels, 0U);
    }
}

TEST(MultipassDesign, LayerIShadesOnlyWhatIsBehindTheLayerBefore) {
    const RunResult run = layers(6).run("multipass");
    for (std::uint32_t layer = 0; layer < 6; ++layer) {
        const auto& counters = support::pass_named(run, fmt::format("geometry layer {}", layer)).counters;
        EXPECT_EQ(counter(counters, "fragment/peel_rejects"), std::uint64_t{layer} * 4096) << layer;
        EXPECT_EQ(counter(counters, "rop/fragments"), std::uint64_t{6 - layer} * 4096) << layer;
    }
}

TEST(MultipassDesign, CopiesTheDepthOfEveryLayerButTheLast) {
    for (const std::uint32_t k : {1U, 4U}) {
        const RunResult run = layers(k).run("multipass");
        EXPECT_EQ(counter(run.stages, "rop/counters/copies"),
                  std::uint64_t{2} * (k - 1) * 4096 * 4); // read and written
    }
}

TEST(MultipassDesign, PassesCostTheSameEachWhereGeometryBinds) {
    const Replay one("gen:blob?triangles=60000", {64, 64, "transparency", "auto", {"k=1", "entry=z"}});
    const Replay four("gen:blob?triangles=60000", {64, 64, "transparency", "auto", {"k=4", "entry=z"}});
    const double ratio =
        static_cast<double>(four.run("multipass").cycles) / static_cast<double>(one.run("multipass").cycles);
    EXPECT_NEAR(ratio, 4.0, 0.12);
}

} // namespace designs_multipass_test
