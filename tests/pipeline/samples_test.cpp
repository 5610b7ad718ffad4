// Pixels of several samples: designs that protect the pixel give the reference at every sample; a unit behind the
// shader leaves the shading as it is, a shader that updates pixels shades every sample. Source: specification 004,
// sections 4.3.1, 6.1 (8), 7.3 and check K3.
#include "pipeline/functional/sample_pattern.hpp"
#include "tests/support/replay.hpp"
#include "tests/support/screen_scene.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>

namespace samples_test {

using pipeline::RunResult;
using support::counter;
using support::Replay;
using support::ReplayOptions;

const std::vector<std::string> scenes{
    "gen:stack?n=30&x=3&y=5&w=16&h=9&order=back-to-front",
    "gen:random-quads?n=600&area=1024",
    "gen:discs?n=60&overlap=8&width=32&height=32",
    "gen:blob?triangles=800&order=random",
    "gen:grass?blades=150",
};

/// Layers that cover the whole view and far more: no edge within it.
Replay layers(std::uint32_t samples, std::uint32_t n = 6, std::vector<std::string> knobs = {}) {
    std::vector<support::ScreenTriangle> triangles;
    for (std::uint32_t i = 0; i < n; ++i) {
        const float depth = 0.9F - 0.1F * static_cast<float>(i);
        triangles.push_back({{-40, -40, depth}, {200, -40, depth}, {-40, 200, depth}});
    }
    return Replay(support::screen_scene(triangles),
                  {.width = 32, .height = 32, .knobs = std::move(knobs), .samples = samples});
}

bool works_per_sample(const std::string& design) {
    sim::Config config;
    const Replay any = layers(1, 1);
    return models::make_design(design, config)->plan(*any.frame.program, any.frame.view).works_per_sample();
}

std::uint64_t shaded_quads(const RunResult& run) { return counter(run.stages, "fragment_pipeline/counters/quads"); }

TEST(Sampled, K3_ProtectedDesignsGiveTheReferenceAtEverySample) {
    for (const std::uint32_t samples : {4U, 8U})
        for (const std::string& scene : scenes) {
            const Replay replay(scene, {.width = 27, .height = 22, .knobs = {"k=3"}, .samples = samples});
            for (const std::string& design : replay.designs()) {
                if (!support::protects(design) || !support::holds_everything(design)) continue;
                SCOPED_TRACE(fmt::format("{} on {} with {} samples", design, scene, samples));
                const RunResult run = replay.run(design);
                EXPECT_EQ(run.hazards.total(), 0U);
                EXPECT_EQ(run.wrong_pixels, 0U);
                EXPECT_EQ(run.lost_fragments, 0U);
                EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer);
            }
        }
}

TEST(Sampled, K3_ForTheOptionsOfProtectedDesigns) {
    const Replay replay("gen:discs?n=60&overlap=8&width=32&height=32", {.width = 32, .height = 32, .samples = 4});
    const std::vector<std::pair<std::string, std::string>> options{{"scoreboard", "scoreboard.granularity=tile16"},
                                                                   {"scoreboard", "scoreboard.granularity=pixel"},
                                                                   {"scoreboard", "scoreboard.entries=17"},
                                                                   {"blender", "blender.interlock=forward"},
                                                                   {"blender", "rop.kbuffer_cache_bytes=1024"},
                                                                   {"multipass", "rop.depth_cache_bytes=256"},
                                                                   {"peel-rop", "peel-rop.early_reject=pixel"},
                                                                   {"interlock", "interlock.area=tile"},
                                                                   {"hashed", "hashed.counters=2"},
                                                                   {"blender", "rop.units=12"}};
    for (const auto& [design, setting] : options) {
        SCOPED_TRACE(design + " " + setting);
        const RunResult run = replay.run(design, {setting});
        EXPECT_EQ(run.hazards.total(), 0U);
        EXPECT_EQ(run.wrong_pixels, 0U);
        EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer);
    }
}

TEST(Sampled, WrongSamplesOfUnprotectedDesignsAreExplainedByHazards) {
    std::uint64_t wrong = 0;
    for (const std::uint32_t samples : {4U, 8U})
        for (const std::string& scene : scenes) {
            const Replay replay(scene, {.width = 32, .height = 32, .samples = samples});
            for (const auto& [design, setting] :
                 std::map<std::string, std::string>{{"existing", "existing.visibility=writeback"},
                                                    {"detect", "detect.version_bits=31"},
                                                    {"blender", "blender.interlock=none"}}) {
                SCOPED_TRACE(fmt::format("{} on {} with {} samples", design, scene, samples));
                const RunResult run = replay.run(design, {setting, "blender.latency=300"});
                EXPECT_EQ(run.unexplained_pixels(), 0U);
                EXPECT_LE(run.wrong_pixels, run.hazards.pixels);
                EXPECT_LE(run.hazards.pixels, 32U * 32U);
                for (const pipeline::HazardPair& pair : run.pairs) EXPECT_LT(pair.y, 32U);
                wrong += run.wrong_pixels;
            }
        }
    EXPECT_GT(wrong, 0U);
}

TEST(Sampled, AUnitBehindTheShaderLeavesTheShadingAsItIs) {
    const Replay one = layers(1);
    for (const std::uint32_t samples : {4U, 8U}) {
        const Replay many = layers(samples);
        EXPECT_EQ(many.streams[0].groups, one.streams[0].quads.size());
        EXPECT_EQ(many.streams[0].quads.size(), samples * one.streams[0].quads.size());
        std::uint32_t per_sample = 0, supersampling = 0;
        for (const std::string& design : many.designs()) {
            if (!support::keeps_submission(design)) continue;
            SCOPED_TRACE(fmt::format("{} with {} samples", design, samples));
            const RunResult before = one.run(design), after = many.run(design);
            const bool once = works_per_sample(design);
            ++(once ? per_sample : supersampling);
            const std::uint64_t factor = once ? 1 : samples;
            // What is rejected before shading depends on time.
            const bool rejects = counter(after.stages, "fragment_scheduler/counters/quads") !=
                                 counter(after.stages, "rasterizer/counters/quads");
            if (!rejects) {
                EXPECT_EQ(shaded_quads(after), factor * shaded_quads(before));
                EXPECT_EQ(counter(after.stages, "fragment_pipeline/counters/issue_cycles"),
                          factor * counter(before.stages, "fragment_pipeline/counters/issue_cycles"));
                EXPECT_EQ(after.fragments, samples * before.fragments);
            }
            EXPECT_EQ(counter(after.stages, "rasterizer/counters/quads"),
                      factor * counter(before.stages, "rasterizer/counters/quads"));
        }
        EXPECT_GE(per_sample, 7U);
        EXPECT_GE(supersampling, 7U);
    }
}

TEST(Sampled, ABlenderWorksAtEverySample) {
    const Replay one = layers(1), four = layers(4);
    const RunResult before = one.run("blender"), after = four.run("blender");
    for (const char* path : {"rop/counters/program_runs", "rop/counters/quads", "rop/counters/kbuffer_tiles/accesses"})
        EXPECT_EQ(counter(after.stages, path), 4 * counter(before.stages, path)) << path;
    EXPECT_GE(after.cycles, 3 * before.cycles); // bound by the blenders
    // A pixel's colour crosses once, a depth for each sample.
    const std::uint64_t pixels = one.streams[0].fragments;
    EXPECT_EQ(counter(before.stages, "crossbar/counters/bytes"), pixels * 16);
    EXPECT_EQ(counter(after.stages, "crossbar/counters/bytes"), pixels * (12 + 4 * 4));
    EXPECT_EQ(counter(four.run("scoreboard").stages, "crossbar/counters/bytes"),
              4 * counter(one.run("scoreboard").stages, "crossbar/counters/bytes"));
}

TEST(Sampled, PeelingReadsTheLayerBeforeAtEverySample) {
    const Replay one = layers(1, 6, {"k=3"}), four = layers(4, 6, {"k=3"});
    const RunResult before = one.run("multipass"), after = four.run("multipass");
    const auto fetches = [](const RunResult& run) { return counter(run.caches, "texture_l1/accesses"); };
    EXPECT_EQ(fetches(after), 4 * fetches(before));
    EXPECT_EQ(after.wrong_pixels, 0U);
}

TEST(Sampled, WithoutEdgesThePictureIsThatOfOneSample) {
    EXPECT_EQ(layers(1).reference.picture, layers(4).reference.picture);
    EXPECT_EQ(layers(1).reference.picture, layers(8).reference.picture);
}

TEST(Sampled, ThePictureIsTheMeanOfThoseSeenThroughTheSamples) {
    // Corners on the sub-pixel grid and one colour for each triangle: moving the view is exact.
    std::vector<support::ScreenTriangle> triangles;
    for (std::uint32_t i = 0; i < 12; ++i) {
        const float shift = static_cast<float>(i) * 2.25F, depth = 0.875F - 0.0625F * static_cast<float>(i);
        triangles.push_back({{shift, 1.5F, depth}, {30.25F, shift + 0.75F, depth}, {shift / 2, 31.125F, depth}});
    }
    const traces::Scene scene = support::screen_scene(triangles);
    const Replay replay(scene, {.width = 32, .height = 32, .samples = 8});
    const auto picture_of = [&scene](pipeline::View view) {
        view.samples = 1;
        const pipeline::Frame frame = traces::build_frame(scene, view, "transparency");
        return pipeline::run_reference(frame, pipeline::rasterize_frame(frame)).picture;
    };
    std::vector<double> sum(replay.reference.picture.size());
    for (std::uint32_t sample = 0; sample < 8; ++sample) {
        const std::vector<float> picture = picture_of(pipeline::view_of_sample(replay.frame.view, sample));
        ASSERT_EQ(picture.size(), sum.size());
        for (std::size_t at = 0; at < sum.size(); ++at) sum[at] += static_cast<double>(picture[at]) / 8;
    }
    const std::vector<float> single = picture_of(replay.frame.view);
    std::size_t smoothed = 0;
    for (std::size_t at = 0; at < sum.size(); ++at) {
        EXPECT_NEAR(replay.reference.picture[at], sum[at], 1e-6);
        smoothed += std::abs(replay.reference.picture[at] - single[at]) > 1e-3F ? 1 : 0;
    }
    EXPECT_GT(smoothed, 100U);
}

TEST(Sampled, AnOpaquePassIsMultisampledInEveryDesign) {
    const Replay many("gen:blob?triangles=800", {.width = 24, .height = 24, .workload = "opaque", .samples = 4});
    for (const char* design : {"existing", "scoreboard", "blender"}) {
        SCOPED_TRACE(design);
        const RunResult run = many.run(design);
        EXPECT_EQ(shaded_quads(run), many.streams[0].groups);
        EXPECT_LT(shaded_quads(run), many.streams[0].quads.size());
        EXPECT_EQ(run.wrong_pixels, 0U);
        EXPECT_EQ(run.colour, many.reference.colour);
    }
}

TEST(Sampled, FurtherMethodsGiveTheReference) {
    struct Method {
        const char *scene, *workload;
        std::vector<std::string> knobs;
    };
    for (const Method& method :
         {Method{"gen:csg", "csg", {}}, Method{"gen:slabs", "translucency", {}},
          Method{"gen:tetrahedra?n=3", "isosurface", {}}, Method{"gen:tetrahedra?n=3", "volume", {}},
          Method{"gen:planes", "depth-of-field", {}}, Method{"gen:particles?n=60", "particles", {}},
          Method{"gen:discs?n=40", "transparency", {"program=mlab"}},
          Method{"gen:discs?n=40", "transparency", {"program=order-and-blend"}},
          Method{"gen:discs?n=40", "blended", {}}}) {
        const Replay replay(
            method.scene,
            {.width = 24, .height = 20, .workload = method.workload, .knobs = method.knobs, .samples = 4});
        EXPECT_EQ(replay.reference.picture.size(), replay.frame.program ? 24U * 20U * 4U : 0U) << method.workload;
        for (const char* design : {"blender", "scoreboard", "interlock"}) {
            const auto able = replay.designs();
            if (std::find(able.begin(), able.end(), design) == able.end()) continue;
            SCOPED_TRACE(fmt::format("{} with {}", method.workload, design));
            const RunResult run = replay.run(design);
            EXPECT_EQ(run.hazards.total(), 0U);
            EXPECT_EQ(run.wrong_pixels, 0U);
            EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer);
            EXPECT_TRUE(run.colour == replay.reference.colour);
        }
    }
}

TEST(Sampled, HardwareGrowsWithTheSamplesWhereItKnowsEveryOne) {
    const Replay one = layers(1), four = layers(4);
    const auto area = [](const Replay& replay, const char* design, const char* what) {
        return counter(replay.run(design).area, what);
    };
    EXPECT_EQ(area(four, "scoreboard", "added/scoreboard"), 4 * area(one, "scoreboard", "added/scoreboard"));
    EXPECT_EQ(area(four, "peel-rop", "added/early_reject_bounds"),
              4 * area(one, "peel-rop", "added/early_reject_bounds"));
    EXPECT_EQ(area(four, "blender", "added_bytes"), area(one, "blender", "added_bytes"));
    EXPECT_EQ(area(four, "framebuffer-fetch", "added/tile_memory"),
              4 * area(one, "framebuffer-fetch", "added/tile_memory"));
}

} // namespace samples_test
