// D4: sorting and batching on unprotected hardware. Source: specification 004, sections 3.2 (A8, A9) and 7.5, check K6.
#include "tests/support/replay.hpp"
#include "traces/submission.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace designs_heuristics_test {

using pipeline::RunResult;
using support::counter;
using support::Replay;

const Replay& mesh() {
    static const Replay replay("gen:blob?triangles=20000", {.width = 96, .height = 96});
    return replay;
}

double hazards(const char* design) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
        sum += static_cast<double>(
            mesh().run(design, {"memory.controller.jitter_cycles=100"}, {.seed = seed}).hazards.total());
    return sum / 4;
}

TEST(Heuristics, K6_SortingAndBatchingBothReduceHazards) {
    const double existing = hazards("existing"), sorted = hazards("sorted"), batched = hazards("batched"),
                 both = hazards("sorted-batched");
    EXPECT_LT(sorted, existing);
    EXPECT_LE(both, batched);
    RecordProperty("hazards", fmt::format("{} {} {} {}", existing, sorted, batched, both));
}

TEST(Heuristics, K6_BatchesOfOneTriangleHaveNoHazard) {
    const Replay replay("gen:blob?triangles=400", {.width = 32, .height = 32});
    const RunResult run = replay.run("sorted-batched", {"sorted-batched.batches.batch=1"});
    EXPECT_EQ(run.hazards.total(), 0U);
    EXPECT_EQ(run.wrong_pixels, 0U);
    EXPECT_GT(replay.run("existing").hazards.total(), 0U);
}

TEST(Heuristics, K6_HazardsThatAreLeftLieWithinOneBatch) {
    const pipeline::SubmissionPlan plan{true, 32, true, 0};
    const pipeline::Frame frame = traces::submitted(mesh().frame, plan);
    const auto streams = pipeline::rasterize_frame(frame);
    const RunResult run = mesh().run("sorted-batched");
    const auto part_of = [&stream = streams[0]](pipeline::QuadId quad) {
        return stream.range_of(stream.triangles[stream.quads[quad].triangle].primitive);
    };
    for (const pipeline::HazardPair& pair : run.pairs) EXPECT_EQ(part_of(pair.victim), part_of(pair.aggressor));
    EXPECT_EQ(run.unexplained_pixels(), 0U);
}

TEST(Heuristics, TrianglesAreSortedFromTheFrontAndNoneIsLost) {
    const pipeline::Frame frame = traces::submitted(mesh().frame, {.sort_by_centroid = true});
    const auto streams = pipeline::rasterize_frame(frame);
    EXPECT_EQ(streams[0].primitives.size(), mesh().streams[0].primitives.size());
    EXPECT_EQ(streams[0].fragments, mesh().streams[0].fragments);
    // The picture does not depend on the order where no two depths are equal.
    EXPECT_EQ(pipeline::run_reference(frame, streams).kbuffer, mesh().reference.kbuffer);
    // Mean window depth of each thousandth of the stream grows.
    const auto& depths = streams[0].depths;
    const std::size_t part = depths.size() / 20;
    double before = 0;
    for (std::size_t at = 0; at + part <= depths.size(); at += part) {
        double mean = 0;
        for (std::size_t i = at; i < at + part; ++i)
            mean += static_cast<double>(depths[i][0]) / static_cast<double>(part);
        EXPECT_GT(mean, before);
        before = mean;
    }
}

TEST(Heuristics, BatchesAreDrawsOfAtMostThatManyTrianglesEachWithAFlush) {
    const pipeline::Frame frame = traces::submitted(mesh().frame, {.batch_triangles = 32, .flush_draws = true});
    const pipeline::Pass& pass =
        frame.passes.back().kind == pipeline::PassKind::draw ? frame.passes.back() : frame.passes[1];
    EXPECT_EQ(pass.parts.size(), 2 * ((20000U + 31) / 32));
    std::uint64_t triangles = 0;
    for (std::size_t i = 0; i < pass.parts.size(); ++i) {
        const pipeline::DrawPart& part = pass.parts[i];
        EXPECT_EQ(frame.draws[part.draw].name == "flush", i % 2 == 1);
        if (i % 2 == 1) continue;
        EXPECT_LE(part.triangles, 32U);
        EXPECT_EQ(part.first_triangle, triangles);
        triangles += part.triangles;
    }
    EXPECT_EQ(triangles, 20000U);
    frame.resources->validate("the resubmitted frame");
}

TEST(Heuristics, SortingLosesVertexReuse) {
    const auto misses = [](const char* design) { return counter(mesh().run(design).caches, "post_transform/misses"); };
    EXPECT_GT(misses("sorted"), 2 * misses("existing"));
    EXPECT_GT(static_cast<double>(misses("sorted")), 2.0 * 20000); // ACMR tends to 3
}

TEST(Heuristics, ABatchTakesTheTimeOfTheFlushingQuad) {
    // The masked quad covers 96 x 96 pixels: at one pixel a cycle, each flush takes 4608 cycles more than at two.
    const auto cycles = [](int rate) {
        const RunResult run =
            mesh().run("sorted-batched", {fmt::format("sorted-batched.batches.flush_quad_px_per_clk={}", rate)});
        EXPECT_GT(counter(run.stages, "fragment_scheduler/counters/flushes"), 300U);
        return static_cast<double>(run.cycles) /
               static_cast<double>(counter(run.stages, "fragment_scheduler/counters/flushes"));
    };
    EXPECT_NEAR(cycles(1) - cycles(2), 4608, 0.02 * 4608);
}

} // namespace designs_heuristics_test
