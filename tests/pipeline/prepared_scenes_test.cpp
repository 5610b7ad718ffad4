// Prepared scenes through the whole machine: the same pictures, and the counts that were measured without time.
#include "tests/support/preparation_kit.hpp"
#include "tests/support/replay.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace prepared_scenes_test {

using support::Replay;
using traces::Scene;

Scene hill() {
    Scene scene = tests::scene_of({tests::hill_mesh(40, 40, 1)}, traces::VertexLayout::interleaved);
    return tests::prepared(scene, "shuffle").scene;
}

support::ReplayOptions opaque() {
    support::ReplayOptions options;
    options.workload = "opaque";
    return options;
}

/// Pixels of which some channel differs by more than `tolerance`.
std::size_t different_pixels(const std::vector<float>& a, const std::vector<float>& b, float tolerance) {
    EXPECT_EQ(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i + 3 < std::min(a.size(), b.size()); i += 4) {
        float worst = 0.0F;
        for (std::size_t c = i; c < i + 4; ++c) worst = std::max(worst, std::fabs(a[c] - b[c]));
        count += worst > tolerance ? 1 : 0;
    }
    return count;
}

TEST(PreparedScenes, WhatKeepsOrderAndFormatsDrawsTheSameBits) {
    const Replay given(hill(), opaque());
    for (const char* spec : {"batch?vertices=100", "interleave?layout=separate", "weld"}) {
        const Replay after(tests::prepared(hill(), spec).scene, opaque());
        EXPECT_EQ(after.reference.colour, given.reference.colour) << spec;
        EXPECT_EQ(after.reference.depth, given.reference.depth) << spec;
    }
}

TEST(PreparedScenes, OtherOrdersAndFormatsDrawTheSamePicture) {
    const Replay given(hill(), opaque());
    ASSERT_GT(*std::max_element(given.reference.colour.begin(), given.reference.colour.end()), 0.1F);
    for (const char* spec :
         {"reorder", "reorder?algorithm=pca&patch=64", "strips", "strips?stitch=restart", "recommended"}) {
        const Replay after(tests::prepared(hill(), spec).scene, opaque());
        EXPECT_EQ(different_pixels(after.reference.colour, given.reference.colour, 0.01F), 0U) << spec;
    }
    // Moved by up to half a step, an edge may take a pixel's centre along.
    const Replay moved(tests::prepared(hill(), "quantise").scene, opaque());
    EXPECT_LE(different_pixels(moved.reference.colour, given.reference.colour, 0.02F),
              given.frame.view.width * given.frame.view.height / 1000);
}

TEST(PreparedScenes, MachineShadesAndFetchesWhatWasMeasured) {
    const pipeline::GpuParams defaults;
    for (const char* spec : {"interleave", "reorder", "reorder?algorithm=cache", "strips", "quantise", "recommended",
                             "interleave?layout=separate"}) {
        SCOPED_TRACE(spec);
        const Scene scene = tests::prepared(hill(), spec).scene;
        ASSERT_EQ(scene.draws.size(), 1U); // the machine's caches stay warm between draws
        const auto measure =
            traces::measure_meshes(scene, defaults.geometry.vertex_reuse, defaults.geometry.vertex_fetch.cache);
        const pipeline::RunResult run = Replay(scene, opaque()).run("existing");
        EXPECT_EQ(support::counter(run.stages, "vertex_shader/counters/vertices"), measure.vertex_shader_runs);
        EXPECT_EQ(support::counter(run.stages, "vertex_fetch/counters/cache/misses"), measure.lines_fetched);
        EXPECT_EQ(run.wrong_pixels, 0U);
    }
}

} // namespace prepared_scenes_test
