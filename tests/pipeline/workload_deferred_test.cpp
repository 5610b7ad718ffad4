// Deferred shading of one transparent layer (specification 003): passes, surfaces, rows, equations, methods against
// each other, and that no design has anything to break.
#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "tests/support/frame_surfaces.hpp"
#include "traces/deferred/shadow_filter.hpp"
#include "traces/deferred/spot_lights.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace workload_deferred_test {

using pipeline::Frame;
using pipeline::Pass;
using pipeline::SurfaceFormat;
using Settings = std::vector<std::string>;
using support::colours_named;
using support::Replay;
using support::surfaces_of;

constexpr const char* showroom = "gen:showroom?triangles=9000&transparent=3000";
constexpr std::uint32_t width = 96, height = 72;

Replay deferred(Settings settings, const std::string& scene = showroom, const char* map = "map_size=64") {
    support::ReplayOptions options;
    options.width = width;
    options.height = height;
    options.workload = "deferred";
    settings.emplace_back(map);
    options.knobs = std::move(settings);
    return Replay(scene, options);
}

Frame frame_of(const Settings& settings, std::uint32_t columns = 1920, std::uint32_t rows = 1080) {
    static const traces::Scene scene = traces::load_scene(showroom);
    return traces::build_frame(scene, traces::make_view(scene, "auto", columns, rows), "deferred",
                               traces::WorkloadOptions::of(settings));
}

std::size_t passes_named(const Frame& frame, const std::string& begin) {
    return static_cast<std::size_t>(std::count_if(frame.passes.begin(), frame.passes.end(), [&](const Pass& pass) {
        return pass.rasterizes() && pass.name.starts_with(begin);
    }));
}

TEST(Deferred, S003_D1_PassesOfAFrame) {
    for (const std::uint32_t lights : {0U, 1U, 3U, 64U}) {
        const std::string count = "lights=" + std::to_string(lights);
        const Frame pm = frame_of({count}, 64, 48), dp = frame_of({count, "method=dp"}, 64, 48);
        EXPECT_EQ(passes_named(pm, "G-buffer") + passes_named(pm, "shadow"), 1 + lights);
        EXPECT_EQ(passes_named(dp, "G-buffer") + passes_named(dp, "shadow"), 2 + lights);
        EXPECT_EQ(passes_named(pm, "light"), lights);
        EXPECT_EQ(passes_named(dp, "light"), 2 * lights);
        for (const char* method : {"method=fw", "method=fwd"}) {
            const Frame frame = frame_of({count, method}, 64, 48); // all surfaces again for each light
            EXPECT_EQ(passes_named(frame, "ambient") + passes_named(frame, "shadow") + passes_named(frame, "light"),
                      1 + 2 * lights);
        }
    }
}

// G-buffer, twice for each light, picture: specification 003, section 6.2.
TEST(Deferred, RenderTargetsAreSwitched) {
    const std::vector<std::pair<const char*, std::uint64_t>> switches{
        {"method=pm", 2 * 3 + 2}, {"method=dp", 3 * 3 + 3}, {"method=fw", 2 * 3 + 2}};
    for (const auto& [method, expected] : switches) {
        const Replay replay = deferred({"lights=3", method});
        const pipeline::RunResult run = replay.run("existing"),
                                  slow = replay.run("existing",
                                                    {"geometry.command_processor.target_switch_cycles=100000"});
        EXPECT_EQ(support::counter(run.stages, "command_processor/counters/target_switches"), expected) << method;
        EXPECT_GT(slow.cycles, run.cycles + (expected - 1) * 100000U);
    }
}

TEST(Deferred, PassesThatDrawAlikeShareTheirFragments) {
    const Replay replay = deferred({"lights=2", "method=fw"});
    const auto& streams = replay.streams; // ambient, shadow, light, shadow, light, composition
    ASSERT_EQ(streams.size(), 6U);
    for (const std::size_t light : {2U, 4U}) {
        EXPECT_TRUE(streams[0].triangles.shares(streams[light].triangles));
        EXPECT_TRUE(streams[0].depths.shares(streams[light].depths));
    }
    EXPECT_FALSE(streams[1].triangles.shares(streams[3].triangles)); // seen from two lights
}

TEST(Deferred, S003_D2_RenderTargets) {
    const auto targets = [](const Settings& settings) {
        std::pair<std::uint32_t, double> sum{0, 0.0}; // number, MB
        for (const pipeline::SurfaceInfo& surface : frame_of(settings).surfaces) {
            const bool shadow = surface.name.starts_with("shadow");
            if (shadow || surface.name == "picture" || has_depth(surface.format)) continue;
            ++sum.first;
            sum.second += static_cast<double>(surface.nominal_bytes()) / 1e6;
        }
        return sum;
    };
    EXPECT_EQ(targets({}).first, 5U);
    EXPECT_NEAR(targets({}).second, 41.5, 0.05);
    EXPECT_EQ(targets({"method=dp"}).first, 10U);
    EXPECT_NEAR(targets({"method=dp"}).second, 82.9, 0.05);
    EXPECT_EQ(targets({"method=fwd"}).first, 3U);
    EXPECT_NEAR(targets({"method=fwd"}).second, 24.9, 0.05);
    EXPECT_EQ(targets({"method=fw"}).first, 2U);
    EXPECT_NEAR(targets({"method=fw"}).second, 16.6, 0.05);
}

TEST(Deferred, S003_D9_NoTransparentTexelOnAnEvenRow) {
    const Replay replay = deferred({"lights=1"});
    const pipeline::SurfaceStore surfaces = surfaces_of(replay);
    for (const char* name : {"colours", "shadow colours"}) {
        const std::vector<float> texels = colours_named(replay, surfaces, name);
        const std::size_t row = std::string(name) == "colours" ? width : 64;
        std::size_t transparent = 0;
        for (std::size_t i = 0; i < texels.size() / 4; ++i) {
            if (texels[i * 4 + 3] == 1.0F) continue;
            ++transparent;
            EXPECT_EQ(i / row % 2, 1U) << name << ' ' << i;
        }
        EXPECT_GT(transparent, 50U) << name;
    }
}

TEST(Deferred, S003_D10_OpaqueScenesAreThoseOfPlainDeferredShading) {
    const std::string opaque = "gen:showroom?triangles=4000&transparent=0";
    for (const char* refraction : {"refraction=true", "refraction=false"}) {
        const Settings common{"lights=3", "shadows=none", refraction};
        Settings peeled = common;
        peeled.emplace_back("method=dp");
        EXPECT_EQ(deferred(common, opaque).reference.colour, deferred(peeled, opaque).reference.colour);
    }
}

TEST(Deferred, S003_D11_Equation31) {
    const glm::vec3 light(1.0F);
    const traces::ShadowTexel pane{0.3F, {0.2F, 0.8F, 1.0F, 0.5F}}, wall{0.6F, {0.0F, 0.0F, 0.0F, 1.0F}};
    const auto filtered = [&](float depth) {
        EXPECT_EQ(light_through(pane, wall, depth, light), light_through(wall, pane, depth, light)) << depth;
        return light_through(pane, wall, depth, light);
    };
    EXPECT_EQ(filtered(0.2F), light);
    EXPECT_EQ(filtered(0.3F), light);
    EXPECT_EQ(filtered(0.5F), glm::vec3(0.1F, 0.4F, 0.5F));
    EXPECT_EQ(filtered(0.6F), glm::vec3(0.1F, 0.4F, 0.5F));
    EXPECT_EQ(filtered(0.7F), glm::vec3(0.0F));
    // Two opaque texels: full shadow behind either, which widens shadows by a row (section 4.1, 4).
    EXPECT_EQ(light_through<float>({0.3F, {1, 1, 1, 1}}, wall, 0.5F, light), glm::vec3(0.0F));
}

TEST(Deferred, S003_D12_Equation33) {
    EXPECT_FLOAT_EQ(traces::laid_over(glm::vec3(0.8F), glm::vec3(0.2F), 0.25F).r, 0.65F);
}

// A pixel that differs has a pane in the full picture, or lies below or above one.
TEST(Deferred, S003_D15_InterlacingChangesTransparentPixelsAndTheirBordersOnly) {
    const Settings common{"lights=2", "shadows=none", "refraction=false"};
    Settings whole = common;
    whole.emplace_back("method=dp");
    const Replay pm = deferred(common), dp = deferred(whole);
    const std::vector<float> nearest = colours_named(dp, surfaces_of(dp), "colours");
    const auto pane = [&](std::size_t x, std::size_t y) { return nearest[(y * width + x) * 4 + 3] < 1.0F; };
    std::size_t differing = 0, equal_panes = 0;
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t at = (y * width + x) * 4;
            const bool same =
                std::equal(&pm.reference.colour[at], &pm.reference.colour[at + 4], &dp.reference.colour[at]);
            equal_panes += same && pane(x, y) ? 1 : 0;
            if (same) continue;
            ++differing;
            EXPECT_TRUE(pane(x, y) || (y > 0 && pane(x, y - 1)) || (y + 1 < height && pane(x, y + 1))) << x << ' ' << y;
        }
    EXPECT_GT(differing, 100U);
    EXPECT_GT(equal_panes, 20U); // those on odd rows before a smooth background
}

TEST(Deferred, S003_D16_NothingToBreak) {
    for (const char* method : {"method=pm", "method=dp", "method=fwd", "method=fw"}) {
        const Replay replay = deferred({"lights=2", method});
        for (const char* design : {"existing", "blender"}) {
            const pipeline::RunResult run = replay.run(design);
            EXPECT_EQ(run.hazards.total(), 0U);
            EXPECT_EQ(run.wrong_pixels, 0U);
            EXPECT_GE(run.judgements.size(), 4U);
            for (const pipeline::PassJudgement& judgement : run.judgements)
                EXPECT_EQ(judgement.wrong_places, 0U) << judgement.pass << ' ' << judgement.surface;
        }
    }
}

TEST(Deferred, S003_D17_AnAccumulatorOfEightBits) {
    const auto sum = [](std::uint32_t lights, float each) {
        glm::vec4 texel(0.0F);
        for (std::uint32_t i = 0; i < lights; ++i)
            texel = write_colour(SurfaceFormat::rgba8, pipeline::blends::of(pipeline::blends::sum), 15, glm::vec4(each),
                                 texel);
        return texel.r;
    };
    EXPECT_EQ(sum(254, 1.0F / 255.0F), 254.0F / 255.0F);
    EXPECT_EQ(sum(255, 1.0F / 255.0F), 1.0F);
    EXPECT_EQ(sum(256, 1.0F / 255.0F), 1.0F); // clamped
    EXPECT_EQ(sum(512, 0.4F / 255.0F), 0.0F);
    EXPECT_EQ(sum(64, 0.6F / 255.0F), 64.0F / 255.0F); // rounded up, each
}

TEST(Deferred, ShadowsOfGlassAreColouredAndThoseOfBallsAreBlack) {
    const auto lit = [](const char* shadows) {
        const Replay replay = deferred({"lights=1", "ambient=0", "bias=0.01", shadows}, showroom, "map_size=1024");
        double sum = 0.0;
        for (std::size_t i = 0; i < replay.reference.colour.size(); ++i)
            if (i % 4 != 3) sum += static_cast<double>(replay.reference.colour[i]);
        return sum;
    };
    const double none = lit("shadows=none"), opaque = lit("shadows=opaque"), transparent = lit("shadows=transparent");
    EXPECT_LT(transparent, 0.95 * none);
    EXPECT_LT(opaque, 0.95 * transparent); // glass lets some of it through
}

// What differs is rounded elsewhere: a G-buffer keeps colours in 8 bits and normals in 10, forward light is rounded in
// the colour of the surface.
TEST(Deferred, ForwardRenderingGivesTheSamePictureButForRounding) {
    const Settings common{"lights=2", "bias=0.01", "refraction=false"};
    const std::vector<float> deferred_picture = deferred(common).reference.colour;
    for (const char* method : {"method=fwd", "method=fw"}) {
        Settings settings = common;
        settings.emplace_back(method);
        const std::vector<float> picture = deferred(settings).reference.colour;
        double sum = 0.0;
        for (std::size_t i = 0; i < picture.size(); ++i)
            sum += std::abs(static_cast<double>(picture[i]) - static_cast<double>(deferred_picture[i]));
        EXPECT_LT(sum / static_cast<double>(picture.size()), 1.0 / 255.0) << method;
        EXPECT_NE(picture, std::vector<float>(picture.size())) << method;
    }
}

TEST(Deferred, WithoutLightsOnlyTheAmbientIsLeft) {
    const Replay replay = deferred({"lights=0", "ambient=0.5", "refraction=false"}, "gen:showroom?transparent=0");
    const std::vector<float> surface = colours_named(replay, surfaces_of(replay), "colours");
    for (std::size_t i = 0; i < surface.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(replay.reference.colour[i + c], surface[i + c] * 128.0F / 255.0F, 0.5F / 255.0F);
}

TEST(Deferred, LightsOfTheSceneThatDoNotShineAreTold) {
    traces::Scene scene = traces::load_scene(showroom);
    const auto notes_with = [&scene](const char* lights) {
        return traces::build_frame(scene, traces::make_view(scene, "auto", 16, 12), "deferred",
                                   traces::WorkloadOptions::of({lights}))
            .notes;
    };
    EXPECT_TRUE(notes_with("lights=2").empty());
    traces::Light sun, spot;
    sun.kind = traces::LightKind::directional;
    spot.kind = traces::LightKind::spot;
    spot.outer_cone = 0.5F;
    scene.lights = {sun, spot, spot};
    const std::string told = " of the scene's 3 lights shine: spots only, and as many as asked for";
    EXPECT_EQ(notes_with("lights=1"), std::vector<std::string>{"1" + told});
    EXPECT_EQ(notes_with("lights=4"), std::vector<std::string>{"2" + told});
}

TEST(Deferred, AVolumeHoldsAllThatItsLightReaches) {
    traces::SpotLight light;
    light.place = {1.0, 2.0, 3.0};
    light.direction = glm::normalize(glm::dvec3(1.0, -2.0, 0.5));
    light.range = 5.0;
    const glm::dmat4 to_cone = glm::inverse(light.volume());
    std::size_t lit = 0;
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 at = light.place + glm::dvec3(i % 20 - 10, i / 20 % 20 - 10, i / 400 - 5) * 0.5;
        const glm::dvec3 inside(to_cone * glm::dvec4(at, 1.0));
        const bool within = inside.z <= 0.0 && inside.z >= -1.0 && std::hypot(inside.x, inside.y) <= -inside.z + 1e-12;
        if (light.arrives(at) == 0.0) continue;
        ++lit;
        EXPECT_TRUE(within) << i;
        EXPECT_TRUE(light.touches(at, 0.0)) << i;
    }
    EXPECT_GT(lit, 20U);
    EXPECT_EQ(light.arrives(light.place + light.direction * 5.0), 0.0);
    EXPECT_GT(light.arrives(light.place + light.direction * 4.999), 0.0);
}

// Within, the back faces are drawn; right outside, the front ones. The picture changes by no more than the step does.
TEST(Deferred, TheEyeMayLieWithinTheVolumeOfALight) {
    for (const char* camera : {"0,1.2,0,0.5,0,-1,60", "0,0.5,4,0,0.4,0,60"}) {
        support::ReplayOptions options;
        options.width = 64;
        options.height = 48;
        options.workload = "deferred";
        options.camera = camera;
        options.knobs = {"lights=8", "shadows=none", "ambient=0"};
        const Replay replay(showroom, options);
        std::size_t lit = 0;
        for (const float value : replay.reference.colour) lit += value > 0.05F ? 1 : 0;
        EXPECT_GT(lit, replay.reference.colour.size() / 4 + 64U * 48 / 4)
            << camera; // alpha, and a quarter of the pixels
    }
}

/// What a limit in bytes says to the fragments of a frame; empty: nothing.
std::string refusal_of(const Frame& frame, std::uint64_t bytes) {
    try {
        rasterize_frame(frame, {}, {bytes, "the test allows"});
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

// Of the pass that goes beyond the limit, before it has room made for its fragments.
TEST(Deferred, FragmentsThatDoNotFitIntoMemoryAreRefused) {
    const Frame frame = frame_of({"lights=1", "map_size=32"}, 24, 18);
    const std::string first = refusal_of(frame, 1);
    EXPECT_TRUE(first.starts_with("pass G-buffer: 24x18 pixels: with its ")) << first;
    EXPECT_NE(first.find(" quads the fragments of the frame need at least "), std::string::npos) << first;
    EXPECT_NE(first.find(" MiB of memory, the test allows 0 MiB"), std::string::npos) << first;
    std::uint64_t refused = 1, enough = std::uint64_t{1} << 25U;
    EXPECT_EQ(refusal_of(frame, enough), "");
    while (enough - refused > 4096) {
        const std::uint64_t middle = refused + (enough - refused) / 2;
        (refusal_of(frame, middle).empty() ? enough : refused) = middle;
    }
    // The last pass that draws is the light, whose shader waits for surfaces: its outputs come later.
    EXPECT_TRUE(refusal_of(frame, refused).starts_with("pass light 0: ")) << refusal_of(frame, refused);
    const auto streams = rasterize_frame(frame);
    std::uint64_t held = 0;
    for (const pipeline::FragmentStream& stream : streams) held += stream.quads.size() * 28;
    EXPECT_GT(enough, held);
    EXPECT_EQ(streams.size(), rasterize_frame(frame, {}, {enough, "the test allows"}).size());
}

TEST(Deferred, ShadowMapsThatTakeMuchMemoryAreTold) {
    EXPECT_TRUE(frame_of({"map_size=2048"}, 16, 12).notes.empty());
    EXPECT_EQ(
        frame_of({"map_size=8192"}, 16, 12).notes,
        std::vector<std::string>{"shadow maps of 8192x8192 texels: the fragments of each light take up to 3520 MiB "
                                 "of memory for every layer of surfaces in its map"});
    EXPECT_TRUE(frame_of({"map_size=8192", "shadows=none"}, 16, 12).notes.empty());
    EXPECT_TRUE(frame_of({"map_size=8192", "lights=0"}, 16, 12).notes.size() == 1); // there are no lights
}

std::string error_of(const Settings& settings, const std::string& scene = "gen:slabs", std::uint32_t samples = 1) {
    try {
        support::ReplayOptions options;
        options.workload = "deferred";
        options.knobs = settings;
        options.samples = samples;
        const Replay replay(scene, options);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(Deferred, BadInputIsToldInOneLine) {
    EXPECT_EQ(error_of({"lights=65"}), "workload deferred: lights: expected whole number 0 to 64, got 65");
    EXPECT_EQ(error_of({"lights=-1"}), "workload deferred: lights: expected whole number 0 to 64, got -1");
    EXPECT_EQ(error_of({"method=pn"}),
              R"(workload deferred: method: expected one of pm | dp | fwd | fw | kg, got "pn"; did you mean 'pm'?)");
    EXPECT_EQ(error_of({}, "gen:stack"),
              "workload deferred: expected a scene with places in a world, those of gen:stack are on the screen");
    EXPECT_EQ(error_of({}, "gen:slabs", 4),
              "--samples: expected 1 with workload deferred, whose rows are told apart by number, got 4");
}

} // namespace workload_deferred_test
