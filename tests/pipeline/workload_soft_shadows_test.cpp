// Soft shadows as a frame: the light's view in a k-buffer of its own size, the eye's view, full-screen passes with
// their time (specification 004, section 2.6; check S5).
#include "pipeline/functional/surface_values.hpp"
#include "tests/support/replay.hpp"
#include "traces/shadows/shadow_kernel.hpp"
#include "traces/view_rays.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace workload_soft_shadows_test {

using support::counter;
using support::Replay;

constexpr const char* scene = "gen:blob?triangles=5000+ground";
constexpr const char* camera = "2.5,2,3.5,0,-0.3,0,45";

Replay shadows(std::vector<std::string> knobs, std::uint32_t width = 96, std::uint32_t height = 72) {
    return Replay(
        scene,
        {.width = width, .height = height, .workload = "soft-shadows", .camera = camera, .knobs = std::move(knobs)});
}

std::size_t passes_with(const pipeline::RunResult& run, const std::string& part) {
    return static_cast<std::size_t>(std::count_if(run.passes.begin(), run.passes.end(), [&](const auto& pass) {
        return pass.name.find(part) != std::string::npos;
    }));
}

std::uint64_t texture_lookups(const pipeline::RunResult& run, const std::string& pass) {
    const auto& counters = support::pass_named(run, pass).counters;
    return counter(counters, "fragment/l1/texture_hits") + counter(counters, "fragment/l1/texture_misses");
}

float visible(const Replay& replay, std::size_t pixel) { return replay.reference.picture[4 * pixel + 3]; }

TEST(SoftShadows, LightAndEyeSeeTheSceneOnSurfacesOfTheirOwnSizes) {
    const Replay replay = shadows({"map_size=128"});
    ASSERT_TRUE(replay.frame.kbuffer_seen_from_elsewhere());
    EXPECT_EQ(replay.frame.view_of_kbuffer().width, 128U);
    EXPECT_EQ(replay.reference.kbuffer.size(), 128U * 128U * 4U);
    EXPECT_EQ(replay.reference.depth.size(), 96U * 72U);
    EXPECT_EQ(replay.reference.picture.size(), 96U * 72U * 4U);
    for (const char* design : {"existing", "blender", "multipass", "linked-list"}) {
        const pipeline::RunResult run = replay.run(design);
        EXPECT_EQ(run.wrong_mask.size(), 128U * 128U) << design;
        EXPECT_EQ(run.unexplained_pixels(), 0U) << design;
        EXPECT_EQ(run.depth, replay.reference.depth) << design;
        if (run.wrong_pixels == 0) {
            EXPECT_EQ(run.colour, replay.reference.picture) << design;
        }
        EXPECT_EQ(run.wrong_pixels == 0, std::string(design) != "existing") << design;
        for (const pipeline::PassJudgement& judgement : run.judgements) // what is wrong in the picture was read there
            EXPECT_TRUE(judgement.wrong_places == 0 || judgement.surface == "kbuffer") << judgement.surface;
    }
}

// The picture follows from the k-buffer and the eye's depths by the formulas, on the map as a whole.
TEST(SoftShadows, ShadersComputeWhatTheFormulasSay) {
    struct Setting {
        std::vector<std::string> knobs;
        traces::ShadowMapOptions map;
        traces::ShadowKernelOptions kernel;
    };
    using traces::ShadowFormat;
    const std::vector<Setting> settings{
        {{"map_size=128"}, {.resolution = 128}, {}},
        {{"map_size=64", "format=rgba32f", "gap_filling=true", "gscale=2", "k=6", "layers=5"},
         {.resolution = 64, .captured = 6, .layers = 5, .format = ShadowFormat::rgba32f, .gscale = 2},
         {.gap_filling = true}},
        {{"map_size=256", "jittered=true", "samples=49", "iterations=3", "offset=exact"},
         {.resolution = 256},
         {.most_samples = 49, .iterations = 3, .offset = traces::SampleOffset::exact, .jittered = true}},
        {{"map_size=64", "method=pcf", "iterations=0", "gscale=1", "gmax=0.2"},
         {.resolution = 64, .gscale = 1, .gmax = 0.2F, .hierarchy = false},
         {.method = traces::ShadowMethod::pcf, .iterations = 0}},
    };
    const traces::AreaLight light = make_area_light(traces::load_scene(scene), "auto", 0.15, "");
    for (const Setting& setting : settings) {
        const Replay replay = shadows(setting.knobs, 47, 35);
        SCOPED_TRACE(setting.knobs.front());
        const traces::ShadowMap map(light, replay.reference.kbuffer, replay.frame.program->floats_per_pixel(),
                                    setting.map);
        const traces::ShadowKernel kernel(map, setting.kernel);
        const pipeline::View& eye = replay.frame.view;
        const traces::ViewRays rays(eye);
        const glm::dmat4 to_world = glm::inverse(glm::dmat4(eye.view));
        for (std::uint32_t pixel = 0; pixel < eye.pixels(); ++pixel) {
            const float depth = replay.reference.depth[pixel];
            if (depth == 1.0F) continue;
            const std::uint32_t x = pixel % eye.width, y = pixel / eye.width;
            const glm::vec3 at(to_world * glm::dvec4(rays.place(x, y, rays.distance(depth)), 1.0));
            glm::dvec3 rounded;
            for (int i = 0; i < 3; ++i) rounded[i] = through_shadow_format(setting.map.format, at[i]);
            ASSERT_EQ(visible(replay, pixel), kernel.visibility(kernel.region(rounded), pixel)) << pixel;
        }
        const pipeline::SurfaceStore& shown = replay.reference.shown;
        for (pipeline::SurfaceId id = 0; id < shown.count(); ++id) {
            if (shown.info(id).name != "bias") continue;
            const std::vector<float> bias = channel_of(shown, id, 0);
            for (std::size_t i = 0; i < bias.size(); ++i) {
                const int x = static_cast<int>(i % map.options().resolution),
                          y = static_cast<int>(i / map.options().resolution);
                ASSERT_EQ(bias[i], map.empty(0, x, y) ? 0.0F : map.bias(0, x, y)) << i;
            }
        }
    }
}

TEST(SoftShadows, ShowsWhatLiesOnTheWayToThePicture) {
    const Replay replay = shadows({"map_size=32", "k=5", "layers=2"}, 24, 18);
    for (const pipeline::SurfaceStore& shown : {replay.reference.shown, replay.run("blender").shown}) {
        std::set<std::string> names;
        for (pipeline::SurfaceId id = 0; id < shown.count(); ++id)
            for (const pipeline::SurfacePicture& picture : shown.info(id).shown) {
                names.insert(picture.name);
                const std::vector<float> values = channel_of(shown, id, picture.channel);
                EXPECT_GT(*std::max_element(values.begin(), values.end()), picture.low) << picture.name;
                for (std::size_t pixel = 0; picture.name == "visibility" && pixel < values.size(); ++pixel)
                    EXPECT_EQ(values[pixel], visible(replay, pixel));
                if (picture.name == "samples") {
                    EXPECT_LE(*std::max_element(values.begin(), values.end()), picture.high);
                }
            }
        EXPECT_EQ(names, (std::set<std::string>{"visibility", "bias", "samples", "light_layer0", "light_layer1",
                                                "light_layer2", "light_layer3", "light_layer4"}));
    }
    const pipeline::RunResult run = replay.run("blender");
    for (const char* untimed : {"bias", "samples"}) EXPECT_EQ(passes_with(run, untimed), 0U);
}

TEST(SoftShadows, SomePointsAreLitSomeAreNotAndSomeLieBetween) {
    const Replay replay = shadows({"map_size=256"});
    std::array<std::size_t, 3> points{};
    for (std::size_t pixel = 0; pixel < 96U * 72U; ++pixel) {
        const float seen = visible(replay, pixel);
        ASSERT_TRUE(seen >= 0.0F && seen <= 1.0F);
        if (replay.reference.depth[pixel] == 1.0F) {
            EXPECT_EQ(seen, 1.0F); // the background
            continue;
        }
        ++points[seen == 0.0F ? 0 : seen == 1.0F ? 2 : 1];
    }
    for (const std::size_t count : points) EXPECT_GT(count, 50U);
}

TEST(SoftShadows, APassThatNobodyReadsIsNotThere) {
    const pipeline::RunResult usual = shadows({"map_size=64"}).run("blender");
    EXPECT_EQ(passes_with(usual, "least depths"), 6U); // 32^2 to 1^2
    EXPECT_EQ(passes_with(usual, "slopes"), 0U);
    const pipeline::RunResult wide = shadows({"map_size=64", "iterations=0"}).run("blender");
    EXPECT_EQ(passes_with(wide, "least depths"), 0U);
    const pipeline::RunResult steep = shadows({"map_size=64", "gscale=2"}).run("blender");
    EXPECT_EQ(passes_with(steep, "slopes"), 1U);
    EXPECT_GT(texture_lookups(steep, "shadow kernel"), texture_lookups(usual, "shadow kernel"));
    const auto says = [](const pipeline::RunResult& run, const std::string& unit) {
        return std::any_of(run.left_out.begin(), run.left_out.end(), [&](const auto& item) {
            return item.first == unit && item.second.find("bytes of memory traffic") != std::string::npos;
        });
    };
    EXPECT_TRUE(says(usual, "pass slopes"));
    EXPECT_TRUE(says(wide, "pass least depths"));
    EXPECT_FALSE(says(steep, "pass slopes"));
}

TEST(SoftShadows, LightPassesFetchPositionsOnly) {
    const pipeline::RunResult run = shadows({"map_size=64"}).run("blender");
    const auto bytes = [&](std::size_t draw) { return run.draw_counter(draw, "vertex_bytes"); };
    ASSERT_EQ(run.draws.size(), 5U); // blob and ground, the same from the light, the screen
    EXPECT_EQ(run.draws[2].name, run.draws[0].name + " (light)");
    EXPECT_LT(bytes(2), bytes(0));
    EXPECT_GT(bytes(2), 0U);
    EXPECT_EQ(counter(support::pass_named(run, "light").counters, "fragment/l1/texture_misses"), 0U);
}

// Black pixels and the background leave the kernel after one fetch.
TEST(SoftShadows, KernelSkipsWhatNoLightCanChange) {
    const Replay replay = shadows({"map_size=2", "samples=1", "iterations=0"}, 64, 64); // the map is half a line
    std::size_t quads = 0, lit_quads = 0;
    for (std::size_t y = 0; y < 64; y += 2)
        for (std::size_t x = 0; x < 64; x += 2) {
            bool any = false;
            for (const std::size_t at : {y * 64 + x, y * 64 + x + 1, (y + 1) * 64 + x, (y + 1) * 64 + x + 1})
                any |= replay.reference.depth[at] < 1.0F;
            ++quads;
            lit_quads += any ? 1 : 0;
        }
    ASSERT_GT(quads, lit_quads);
    // One fetch for quads of the background, else colour, position and the one sample.
    EXPECT_EQ(texture_lookups(replay.run("blender"), "shadow kernel"), (quads - lit_quads) + 3 * lit_quads);
}

// 17 x 17 against 33 x 33 samples, where every point takes as many as it may.
TEST(SoftShadowsS5Long, TimeGrowsWithSamplesAlmostLinearly) {
    std::array<double, 2> cycles{};
    for (const std::size_t i : {0U, 1U}) {
        const Replay replay = shadows({"map_size=1024", "light_size=1", i == 0 ? "samples=289" : "samples=1089"});
        cycles[i] = static_cast<double>(
            support::pass_named(replay.run("multipass", {"rop.fast_clear=true"}), "shadow kernel").cycles);
    }
    const double ratio = cycles[1] / cycles[0];
    EXPECT_GE(ratio, 3.3);
    EXPECT_LE(ratio, 3.8);
}

TEST(SoftShadows, HardShadowsHaveNoPenumbra) {
    const Replay hard = shadows({"map_size=256", "method=hard"}), point = shadows({"map_size=256", "light_size=0"});
    for (std::size_t pixel = 0; pixel < 96U * 72U; ++pixel) {
        EXPECT_TRUE(visible(hard, pixel) == 0.0F || visible(hard, pixel) == 1.0F);
        EXPECT_EQ(visible(point, pixel), visible(hard, pixel));
    }
    const Replay filtered = shadows({"map_size=256", "method=pcf"});
    std::size_t between = 0;
    for (std::size_t pixel = 0; pixel < 96U * 72U; ++pixel)
        between += visible(filtered, pixel) > 0.0F && visible(filtered, pixel) < 1.0F ? 1 : 0;
    EXPECT_GT(between, 50U);
}

TEST(SoftShadows, BadParametersAreNamed) {
    const auto complaint = [](std::vector<std::string> knobs) -> std::string {
        try {
            shadows(std::move(knobs));
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(complaint({"map_size=100"}), "workload soft-shadows: map_size: expected a power of two, got 100");
    EXPECT_EQ(complaint({"k=2"}), "workload soft-shadows: layers: expected at most k = 2, got 3");
    EXPECT_NE(complaint({"light=0"}).find("expected a number below 0"), std::string::npos);
    EXPECT_NE(complaint({"light=above"}).find("expected auto, the number of a spot light, or px,py,pz,tx,ty,tz"),
              std::string::npos);
    EXPECT_NE(complaint({"light=1,2,3,1,2,3"}).find("expected a target that is not the light's place"),
              std::string::npos);
}

// Section 6.2, items 1, 4 and 12, through the whole program: the light among the triangles, scenes of any scale.
TEST(SoftShadows, ExtremesGiveNumbers) {
    for (const char* light : {"0,0,0,0,1,0", "0,1.2,0,0,0,0", "0,-5,0,0,0,0", "1000,1000,1000,0,0,0"})
        for (const char* format : {"rgba16f", "rgba32f"})
            for (const char* size : {"0", "0.15", "10"}) {
                const Replay replay =
                    shadows({"map_size=32", std::string("light=") + light, std::string("format=") + format,
                             std::string("light_size=") + size, "samples=49", "gscale=1"},
                            24, 18);
                for (const float value : replay.reference.picture) ASSERT_TRUE(std::isfinite(value)) << light;
                for (std::size_t pixel = 0; pixel < 24U * 18U; ++pixel)
                    ASSERT_TRUE(visible(replay, pixel) >= 0.0F && visible(replay, pixel) <= 1.0F) << light;
            }
    EXPECT_EQ(shadows({"map_size=1"}, 8, 8).run("blender").wrong_pixels, 0U);
}

} // namespace workload_soft_shadows_test
