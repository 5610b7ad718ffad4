// Lights of deferred shading at their limits (specification 003, section 4, whose items tests are named after): sums in
// eight bits, rows of shadow maps, volumes around the eye, each below, at and above the limit.
#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "tests/support/frame_surfaces.hpp"
#include "tests/support/stage.hpp"
#include "traces/deferred/shaders.hpp"
#include "traces/generators/solids.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>
#include <string_view>

namespace deferred_lights_test {

using pipeline::SurfaceFormat;
using support::codes_at;
using support::colours_named;
using support::Replay;
using support::Stage;
using support::surfaces_of;
using Settings = std::vector<std::string>;

constexpr std::array methods{"method=pm", "method=dp", "method=fwd", "method=fw"};

// A white wall at distance 1 before lights with a range of 2: a quarter of each arrives in the middle, head-on.
TEST(DeferredLights, S003_E9_LightsAddUpInEightBits) {
    struct Sum {
        std::uint32_t lights;
        double each; ///< codes
        int sum;
    };
    for (const Sum& sum : {Sum{2, 127, 254}, Sum{3, 85, 255}, Sum{2, 128, 255}, Sum{64, 3, 192}, Sum{64, 128, 255},
                           Sum{64, 0.4, 0}, Sum{64, 0.499, 0}, Sum{64, 0.501, 64}, Sum{64, 0.6, 64}}) {
        Stage stage(3, 3);
        stage.add_whole(1.0, glm::vec4(1.0F));
        for (std::uint32_t i = 0; i < sum.lights; ++i) stage.add_light(glm::vec3(0.0F), 2.0F);
        for (const char* method : methods) {
            const Replay replay =
                stage.replay("deferred", {method, fmt::format("lights={}", sum.lights), "ambient=0", "specular=0",
                                          "shadows=none", fmt::format("intensity={:.9f}", 4.0 * sum.each / 255.0)});
            EXPECT_EQ(codes_at(replay.reference.colour, 3, 1, 1), glm::ivec4(sum.sum, sum.sum, sum.sum, 255))
                << method << ' ' << sum.lights << " of " << sum.each;
        }
    }
}

// Two sheets in one place: the ambient pass keeps the first one, whose depth both have. Each fragment of it is blended
// (specification 003, section 1.7), unless a stencil lets each light come once to a pixel.
TEST(DeferredLights, OfSurfacesInOnePlaceForwardRenderingLightsEach) {
    for (const std::uint32_t lights : {1U, 2U}) {
        Stage stage(3, 3);
        stage.add_whole(1.0, {1, 0, 0, 1});
        stage.add_whole(1.0, {0, 1, 0, 1});
        for (std::uint32_t i = 0; i < lights; ++i) stage.add_light(glm::vec3(0.0F), 2.0F);
        const auto picture = [&](const char* method, const char* once) {
            return codes_at(
                stage
                    .replay("deferred", {method, once, fmt::format("lights={}", lights), "ambient=0", "specular=0",
                                         "shadows=none", fmt::format("intensity={:.9f}", 4.0 * 100.0 / 255.0)})
                    .reference.colour,
                3, 1, 1);
        };
        const int each = static_cast<int>(100 * lights);
        for (const char* method : methods) {
            const bool forward = std::string_view(method).starts_with("method=fw");
            EXPECT_EQ(picture(method, "lit_once=true"), glm::ivec4(each, 0, 0, 255)) << method << ' ' << lights;
            EXPECT_EQ(picture(method, "lit_once=false"), glm::ivec4(each, forward ? each : 0, 0, 255))
                << method << ' ' << lights;
        }
    }
}

// Where no two surfaces are in one place a stencil changes no pixel, with panes on odd rows alone, too.
TEST(DeferredLights, AStencilChangesNothingElse) {
    Stage stage(16, 16);
    stage.add_whole(3.0, {0.2F, 0.9F, 0.4F, 1.0F});
    stage.add({4, 3, 12, 13, 1.5, {0.9F, 0.3F, 0.1F, 0.4F}});
    stage.add({0, 0, 7, 9, 2.0, {0.1F, 0.3F, 0.8F, 1.0F}});
    for (int i = 0; i < 3; ++i) stage.add_light(glm::vec3(0.1F * static_cast<float>(i), 0.0F, 0.0F), 6.0F);
    for (const char* method : {"method=fwd", "method=fw"}) {
        const Replay without = stage.replay("deferred", {method, "lights=3", "map_size=16"}),
                     with = stage.replay("deferred", {method, "lights=3", "map_size=16", "lit_once=true"});
        EXPECT_EQ(with.reference.colour, without.reference.colour) << method;
        EXPECT_EQ(with.run("existing").wrong_pixels, 0U) << method;
    }
}

// No float is 0.5/255: the one below it is nothing, 64 times, the one above is a code each.
TEST(DeferredLights, S003_E9_HalfACodeLiesBetweenTwoFloats) {
    const auto sum = [](float each) {
        glm::vec4 texel(0.0F);
        for (int i = 0; i < 64; ++i)
            texel = write_colour(SurfaceFormat::rgba8, pipeline::blends::of(pipeline::blends::sum), 15, glm::vec4(each),
                                 texel);
        return static_cast<int>(std::lround(texel.r * 255.0F));
    };
    float below = 0.5F / 255.0F;
    if (static_cast<double>(below) * 255.0 > 0.5) below = std::nextafter(below, 0.0F);
    const float above = std::nextafter(below, 1.0F);
    ASSERT_LT(static_cast<double>(below) * 255.0, 0.5);
    ASSERT_GT(static_cast<double>(above) * 255.0, 0.5);
    EXPECT_EQ(sum(below), 0);
    EXPECT_EQ(sum(above), 64);
}

/// How a wall behind something is lit in the rows of a picture whose eye and light are one, and whose shadow map has as
/// many texels as it has pixels: '.' as without shadows, 'g' through the glass below, '#' not at all, '?' otherwise.
std::string shadow_rows(const Stage& stage, const char* shadows = "shadows=transparent") {
    const auto light = [&](const char* which) {
        const Replay replay =
            stage.replay("deferred", {"method=dp", "lights=1", "ambient=0", "specular=0", "intensity=1.5", which,
                                      fmt::format("map_size={}", stage.width)});
        const pipeline::SurfaceStore surfaces = surfaces_of(replay);
        std::vector<float> wall = colours_named(replay, surfaces, "light");
        const std::vector<float> behind = colours_named(replay, surfaces, "light behind"),
                                 depths = colours_named(replay, surfaces, "depths behind");
        for (std::size_t i = 0; i < wall.size(); ++i)
            if (depths[i / 4 * 4] < 1.0F) wall[i] = behind[i]; // something is before the wall
        return wall;
    };
    const std::vector<float> free = light("shadows=none"), shadowed = light(shadows);
    std::string rows;
    for (std::size_t y = 0; y < stage.height; ++y) {
        const glm::ivec4 before = codes_at(free, stage.width, stage.width / 2, y),
                         after = codes_at(shadowed, stage.width, stage.width / 2, y);
        EXPECT_GT(before.r, 100) << y;
        const glm::vec3 difference = glm::vec3(before) * glm::vec3(0.6F, 0.3F, 0.15F) - glm::vec3(after);
        const bool filtered =
            std::max({std::abs(difference.r), std::abs(difference.g), std::abs(difference.b)}) <= 1.0F;
        rows += after == before ? '.' : filtered ? 'g' : glm::ivec3(after) == glm::ivec3(0) ? '#' : '?';
    }
    return rows;
}

/// Rows of the map covered by glass that lets (1, 0.5, 0.25) * 0.6 pass, or by something opaque.
Stage shaded_stage(std::uint32_t size, double top, double bottom, bool glass = true) {
    Stage stage(size, size);
    stage.add_whole(2.0, glm::vec4(1.0F));
    stage.add({0.0, top, 1.0 * size, bottom, 1.0, {1.0F, 0.5F, 0.25F, glass ? 0.4F : 1.0F}});
    stage.add_light(glm::vec3(0.0F), 8.0F);
    return stage;
}

// A receiver asks its row and the one below: glass of one odd row filters two, that of an even row is not there.
TEST(DeferredLights, S003_E1_ShadowsOfGlassThatIsOneRowHigh) {
    EXPECT_EQ(shadow_rows(shaded_stage(16, 6, 7)), "................");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 7, 8)), "......gg........");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 6, 8)), "......gg........");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 7, 9)), "......gg........");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 0, 1)), "................");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 1, 2)), "gg..............");
}

TEST(DeferredLights, S003_E4_OpaqueShadowsAreARowHigherOnlyWhereTwoRowsAreAsked) {
    EXPECT_EQ(shadow_rows(shaded_stage(16, 7, 8, false)), "......##........");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 8, 9, false)), ".......##.......");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 7, 8, false), "shadows=opaque"), ".......#........");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 8, 9, false), "shadows=opaque"), "........#.......");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 0, 1, false)), "#...............");
}

// In the last row the neighbour is the row above, be that row odd or even.
TEST(DeferredLights, S003_E5_TheLastRowOfAShadowMapAsksTheRowAbove) {
    for (const std::uint32_t size : {2U, 3U, 15U, 16U})
        EXPECT_EQ(shadow_rows(shaded_stage(size, 0, size)), std::string(size, 'g')) << size;
    EXPECT_EQ(shadow_rows(shaded_stage(16, 15, 16)), "..............gg");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 14, 15)), "................");
    EXPECT_EQ(shadow_rows(shaded_stage(15, 13, 14)), "............ggg");
    EXPECT_EQ(shadow_rows(shaded_stage(15, 14, 15)), "...............");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 15, 16, false)), "..............##");
    EXPECT_EQ(shadow_rows(shaded_stage(16, 14, 15, false)), ".............###");
}

TEST(DeferredLights, S003_E6_HalfATexelDecidesWhichRowsOfAShadowMapAre) {
    for (const double shift : {-128.0, -1.0, 0.0, 1.0, 128.0}) {
        const double odd = 7.5 + shift / 256.0, even = 6.5 + shift / 256.0;
        EXPECT_EQ(shadow_rows(shaded_stage(16, odd, odd + 1)), shift > 0 ? "................" : "......gg........");
        EXPECT_EQ(shadow_rows(shaded_stage(16, even, even + 1)), shift > 0 ? "......gg........" : "................");
    }
}

// Two panes and nothing else, the light behind them: of the map's even rows nothing is known. Cleared to opaque they
// are far away; cleared to clear they make the nearer pane the opaque one of two.
TEST(DeferredLights, S003_E3_AnEmptyRowOfAShadowMapLetsGlassFilter) {
    Stage stage(16, 16);
    stage.add_whole(1.0, {1, 1, 1, 0.5F}, {0, 0, -1});
    stage.add_whole(2.0, {1.0F, 0.5F, 0.25F, 0.4F}, {0, 0, -1});
    stage.add_light({0, 0, -3}, 8.0F, true);
    const auto lit = [&](const char* shadows, float cleared) {
        Replay replay = stage.replay("deferred", {"lights=1", "ambient=0", "specular=0", shadows, "map_size=16"});
        for (pipeline::SurfaceInfo& surface : replay.frame.surfaces)
            if (surface.name == "shadow colours")
                pack_colour(surface.format, glm::vec4(0, 0, 0, cleared), surface.cleared.data());
        return codes_at(colours_named(replay, surfaces_of(replay), "light"), 16, 8, 7);
    };
    const glm::ivec4 free = lit("shadows=none", 1.0F), filtered = lit("shadows=transparent", 1.0F);
    EXPECT_NEAR(free.r, 255.0 * (1.0 - 2.0 / 8.0) * (1.0 - 2.0 / 8.0), 1.5);
    EXPECT_NEAR(filtered.r, free.r * 0.6, 1.0);
    EXPECT_NEAR(filtered.g, free.g * 0.3, 1.0);
    EXPECT_NEAR(filtered.b, free.b * 0.15, 1.0);
    EXPECT_EQ(glm::ivec3(lit("shadows=transparent", 0.0F)), glm::ivec3(0));
}

/// What the light's shader adds to each pixel of a cleared picture, asked once at all of them.
std::vector<float> lit_once(const Replay& replay, const traces::SpotLight& light, double intensity,
                            const pipeline::SurfaceStore& surfaces) {
    std::vector<pipeline::SurfaceId> slots;
    for (const char* name : {"normals", "specular", "depths"})
        for (pipeline::SurfaceId i = 0; i < surfaces.count(); ++i)
            if (surfaces.info(i).name == name) slots.push_back(i);
    const pipeline::View& view = replay.frame.view;
    const auto shader = traces::light_shader(view, light, {.shadows = traces::Shadows::none, .intensity = intensity});
    pipeline::SurfaceAccess access(surfaces, slots);
    std::vector<float> picture(view.pixels() * 4);
    pipeline::ShaderInput input;
    for (input.y = 0; input.y < view.height; input.y += 2)
        for (input.x = 0; input.x < view.width; input.x += 2) {
            pipeline::ShaderOutput output;
            shader->shade(input, access, output);
            for (std::size_t i = 0; i < 4; ++i) {
                const glm::vec4 colour = through_format(SurfaceFormat::rgba8, output.colours[0][i]);
                for (std::size_t c = 0; c < 4; ++c)
                    picture[((input.y + i / 2) * view.width + input.x + i % 2) * 4 + c] = colour[static_cast<int>(c)];
            }
        }
    return picture;
}

// A cone of 1.5 about its axis where the eye stands, its apex, its sides and its base: a pixel that was drawn twice, or
// not at all, differs. The near plane, a thousandth of the far one, cuts the volume where the eye stands right outside.
TEST(DeferredLights, S003_E13_EachPixelIsLitOnceWhereverTheEyeIs) {
    Stage stage(64, 48);
    traces::add_object(stage.scene, traces::box_mesh({-2, -2, -2}, {2, 2, 2}), "room", glm::vec4(1.0F), "stage");
    traces::add_object(stage.scene, traces::box_mesh({0.1, -2, -0.6}, {2, 2, -0.5}), "screen", glm::vec4(1.0F),
                       "stage"); // across the sides of the cone
    for (const double x : {-0.4, 0.5})
        traces::add_object(stage.scene, traces::sphere_mesh({x, 0.1, -0.8}, 0.4, 24), "ball", glm::vec4(1.0F), "stage");
    stage.add_light({0, 0, 1.5F}, 3.4F);
    stage.scene.lights[0].outer_cone = 0.5F;
    stage.scene.lights[0].inner_cone = 0.5F; // lit up to its sides
    const traces::SpotLight light = traces::spot_lights(stage.scene, 1).front();
    const double corner = std::tan(light.outer) / std::cos(std::numbers::pi / 16.0); // of its 16 sides, at distance 1
    std::vector<std::string> cameras{"0,0,0,0,0,-1,60",  "0,0,1,0.3,0.2,-1,90",   "0,0,1.9,0,0,0,60",
                                     "1.9,0,0,0,0,0,60", "-1.9,1.9,1.9,0,0,0,60", "0,0,-1.5,0,0.1,1,120",
                                     "1.9,0,0,3,0,0,60"};
    for (const double off : {-0.1, -1e-3, -1e-7, 0.0, 1e-7, 1e-3, 0.1}) {
        cameras.push_back(fmt::format("0,0,{:.9f},0,0,-1,90", 1.5 + off));
        cameras.push_back(fmt::format("0,0,{:.9f},0.2,0.1,9,90", 1.5 + off));
        for (const char* target : {"0,0,-0.5", "0,0,1.5", "1.9,0.3,-1.9", "0.9,1.5,0"}) {
            cameras.push_back(fmt::format("{:.9f},0,0,{},90", 1.5 * corner + off, target));
            cameras.push_back(fmt::format("0,{:.9f},0,{},90", -1.5 * corner - off, target));
        }
        cameras.push_back(fmt::format("0.2,0.1,{:.9f},0.2,0,0,90", -1.9 - off));
        cameras.push_back(fmt::format("0.2,0.1,{:.9f},0.9,0,-1.9,90", -1.9 - off));
    }
    const auto seen_from = [&](const std::string& camera) {
        return stage.replay("deferred", {"lights=1", "ambient=0", "shadows=none", "intensity=2", "refraction=false"},
                            camera);
    };
    std::size_t lit = 0;
    for (const std::string& camera : cameras) {
        const Replay replay = seen_from(camera);
        const pipeline::SurfaceStore surfaces = surfaces_of(replay);
        const std::vector<float> light_drawn = colours_named(replay, surfaces, "light"),
                                 once = lit_once(replay, light, 2.0, surfaces);
        std::size_t different = 0;
        for (std::size_t i = 0; i < once.size(); i += 4) {
            different += std::equal(&once[i], &once[i] + 4, &light_drawn[i]) ? 0 : 1;
            lit += once[i] > 0.05F ? 1 : 0;
        }
        EXPECT_EQ(different, 0U) << camera;
    }
    EXPECT_GT(lit, cameras.size() * 64 * 48 / 20);

    Replay within = seen_from(cameras.front()); // faces towards the eye, of which there are none
    for (pipeline::Pass& pass : within.frame.passes)
        if (pass.name == "light 0") pass.states[0].culling = pipeline::FaceCulling::back;
    within.streams = pipeline::rasterize_frame(within.frame);
    const std::vector<float> dark = colours_named(within, surfaces_of(within), "light");
    EXPECT_EQ(dark, std::vector<float>(dark.size()));
}

// Where nothing is, the depth is 1: with an infinite far plane that place has no numbers.
TEST(DeferredLights, S003_E3_NothingIsLitWhereNothingIs) {
    Stage stage(16, 16);
    stage.add({4, 4, 12, 12, 1.0});
    stage.add_light(glm::vec3(0.0F), 100.0F);
    for (const char* projection : {"1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-0.2,0", "1,0,0,0,0,1,0,0,0,0,-1.02,-1,0,0,-0.202,0"})
        for (const char* method : methods) {
            const Replay replay = stage.replay("deferred", {method, "lights=1", "ambient=0.5", "map_size=16"},
                                               std::string("1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1,") + projection);
            for (std::size_t y = 0; y < 16; ++y)
                for (std::size_t x = 0; x < 16; ++x) {
                    const glm::ivec3 seen = codes_at(replay.reference.colour, 16, x, y);
                    const bool sheet = x >= 4 && x < 12 && y >= 4 && y < 12;
                    EXPECT_EQ(seen != glm::ivec3(0), sheet) << method << ' ' << x << ' ' << y;
                    EXPECT_EQ(seen.r > 200, sheet) << method << ' ' << x << ' ' << y; // not the ambient light alone
                }
        }
}

TEST(DeferredLights, S003_D16_PicturesOfFewAndOfOddlyManyPixelsAreThoseOfTheReference) {
    for (const auto& [width, height] : {std::pair{1U, 1U}, {1U, 2U}, {2U, 1U}, {3U, 3U}, {17U, 15U}})
        for (const char* method : methods) {
            Stage stage(width, height);
            stage.add_whole(2.0, glm::vec4(1.0F), {0, 0, 1}, true);
            stage.add_whole(1.0, {1.0F, 0.5F, 0.25F, 0.4F}, glm::normalize(glm::vec3(1, 1, 1)));
            stage.add_light(glm::vec3(0.0F), 8.0F);
            const Replay replay =
                stage.replay("deferred", {method, "lights=1", "map_size=3", "refraction_coefficient=0.5"});
            for (const char* design : {"existing", "blender"})
                for (const pipeline::PassJudgement& judgement : replay.run(design).judgements)
                    EXPECT_EQ(judgement.wrong_places, 0U)
                        << method << ' ' << judgement.pass << ' ' << judgement.surface;
        }
}

} // namespace deferred_lights_test
