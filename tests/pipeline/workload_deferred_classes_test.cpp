// Deferred shading whose G-buffer or shadow map is a k-buffer of two classes (specification 003, section 5: KG and KS).
#include "tests/support/replay.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace workload_deferred_classes_test {

using Settings = std::vector<std::string>;
using support::Replay;

constexpr const char* showroom = "gen:showroom?triangles=9000&transparent=3000";
constexpr std::uint32_t width = 96, height = 72;

Replay deferred(Settings settings, const std::string& scene = showroom, std::uint32_t scale = 1) {
    support::ReplayOptions options;
    options.width = width * scale;
    options.height = height * scale;
    options.workload = "deferred";
    settings.emplace_back("map_size=64");
    options.knobs = std::move(settings);
    return Replay(scene, options);
}

std::size_t differing_pixels(const Replay& a, const Replay& b) {
    std::size_t differing = 0;
    for (std::size_t at = 0; at < a.reference.colour.size(); at += 4)
        differing += std::equal(&a.reference.colour[at], &a.reference.colour[at] + 4, &b.reference.colour[at]) ? 0 : 1;
    return differing;
}

std::uint64_t nominal_bytes(const Replay& replay) {
    std::uint64_t bytes = 0;
    for (const pipeline::SurfaceInfo& surface : replay.frame.surfaces)
        if (!surface.name.starts_with("shadow") && surface.name != "picture") bytes += surface.nominal_bytes();
    return bytes;
}

// One geometry pass keeps what peeling keeps in two, bit for bit, but for surfaces that a depth buffer of 24 bits takes
// for one.
TEST(DeferredClasses, AKBufferKeepsWhatPeelingKeeps) {
    for (const char* refraction : {"refraction=true", "refraction=false"}) {
        const Settings common{"lights=2", refraction};
        Settings kg = common, dp = common;
        kg.emplace_back("method=kg");
        dp.emplace_back("method=dp");
        EXPECT_LE(differing_pixels(deferred(kg), deferred(dp)), 2U);
    }
    const auto geometry = [](const Replay& replay) {
        return std::count_if(replay.frame.passes.begin(), replay.frame.passes.end(),
                             [](const pipeline::Pass& pass) { return pass.name.starts_with("G-buffer"); });
    };
    const Replay kg = deferred({"method=kg"}), dp = deferred({"method=dp"});
    EXPECT_EQ(geometry(kg), 1);
    EXPECT_EQ(geometry(dp), 2);
    // Two entries of 16 bytes and two accumulators; peeled, both G-buffers have a depth buffer to share.
    EXPECT_EQ(nominal_bytes(kg), std::uint64_t{width} * height * (2 * 16 + 2 * 4));
    EXPECT_EQ(nominal_bytes(dp), std::uint64_t{width} * height * (2 * (16 + 4) + 4));
}

TEST(DeferredClasses, S003_D16_AKBufferBreaksWithoutProtectionAndOnlyThere) {
    const Replay replay = deferred({"method=kg", "lights=2"});
    for (const std::string& design : replay.designs()) {
        const pipeline::RunResult run = replay.run(design);
        EXPECT_EQ(run.unexplained_pixels(), 0U) << design;
        if (support::protects(design)) {
            EXPECT_EQ(run.hazards.total(), 0U) << design;
            EXPECT_TRUE(run.colour == replay.reference.colour || !support::holds_everything(design)) << design;
        }
        for (const pipeline::PassJudgement& judgement : run.judgements)
            EXPECT_TRUE(judgement.wrong_places == 0 || judgement.surface == "kbuffer")
                << design << ' ' << judgement.pass;
    }
    const pipeline::RunResult broken = replay.run("existing");
    EXPECT_GT(broken.hazards.total(), 20U);
    EXPECT_GT(broken.wrong_pixels, 20U);
}

// Refraction looks aside, and light comes through shadow maps: a pixel without hazard shows what another place has
// lost.
TEST(DeferredClasses, APassThatReadsWhatAnotherBrokeIsNotToBlame) {
    const auto run = [](Settings settings) {
        return deferred(std::move(settings), "gen:showroom?triangles=20000&transparent=8000", 2).run("existing");
    };
    const pipeline::RunResult aside = run({"method=kg", "lights=0", "refraction_coefficient=0.1"}),
                              straight = run({"method=kg", "lights=0", "refraction=false"}),
                              shadows = run({"method=pm", "lights=1", "shadow_maps=two-class"});
    EXPECT_GT(aside.wrong_because.inputs, 0U);
    EXPECT_EQ(straight.wrong_because.inputs, 0U);
    EXPECT_GT(shadows.wrong_because.inputs, 20U);
    for (const pipeline::RunResult& result : {aside, straight, shadows})
        EXPECT_EQ(result.wrong_pixels, result.wrong_because.hazard + result.wrong_because.inputs);
}

// Every light clears the one k-buffer and fills it anew: what it held, and who stored it last, is forgotten.
TEST(DeferredClasses, OneShadowMapServesAllLights) {
    const Replay replay = deferred({"method=pm", "lights=3", "shadow_maps=two-class"});
    for (const std::string& design : replay.designs()) {
        const pipeline::RunResult run = replay.run(design);
        EXPECT_EQ(run.unexplained_pixels(), 0U) << design;
        std::size_t maps = 0;
        for (const pipeline::PassJudgement& judgement : run.judgements) {
            const bool map = judgement.surface == "kbuffer";
            maps += map ? 1 : 0;
            const bool may_be_wrong = map && !(support::protects(design) && support::holds_everything(design));
            EXPECT_TRUE(judgement.wrong_places == 0 || may_be_wrong) << design << ' ' << judgement.pass;
        }
        EXPECT_EQ(maps, 3U) << design;
        EXPECT_TRUE(run.hazards.total() == 0 || !support::protects(design)) << design;
    }
}

// Two opaque rows of an interlaced map throw a shadow that is a row wider than either. The map of one plain depth
// throws the shadow that a k-buffer throws, where 24 bits of depth tell surfaces apart.
TEST(DeferredClasses, S003_D10_ShadowsOfAKBufferAreNoRowWider) {
    const std::string opaque = "gen:showroom?triangles=4000&transparent=0";
    const Replay plain = deferred({"lights=2", "shadows=opaque"}, opaque);
    const Replay rows = deferred({"lights=2"}, opaque);
    const Replay classes = deferred({"lights=2", "shadow_maps=two-class"}, opaque);
    EXPECT_LE(differing_pixels(plain, classes), 2U);
    EXPECT_GT(differing_pixels(plain, rows), 20U);
    double darker = 0.0;
    for (std::size_t i = 0; i < plain.reference.colour.size(); ++i)
        darker += static_cast<double>(plain.reference.colour[i]) - static_cast<double>(rows.reference.colour[i]);
    EXPECT_GT(darker, 0.0);
}

TEST(DeferredClasses, AFrameHasOneKBuffer) {
    try {
        deferred({"method=kg", "shadow_maps=two-class"});
        FAIL();
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(),
                     "workload deferred: shadow_maps: expected rows with method kg, whose G-buffer is the "
                     "frame's k-buffer, got two-class");
    }
    deferred({"method=kg", "shadow_maps=two-class", "shadows=opaque"}); // has no use for it
}

} // namespace workload_deferred_classes_test
