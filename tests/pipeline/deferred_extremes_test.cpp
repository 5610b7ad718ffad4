// Deferred shading at its limits (specification 003, section 4, whose items tests are named after): rows, opacities and
// refraction, each below, at and above the limit, beside numbers computed by hand.
#include "pipeline/functional/number_formats.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "tests/support/frame_surfaces.hpp"
#include "tests/support/stage.hpp"
#include "traces/deferred/shaders.hpp"
#include "traces/generators/solids.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace deferred_extremes_test {

using support::codes_at;
using support::Replay;
using support::Stage;
using support::surfaces_of;
using Settings = std::vector<std::string>;
using Rows = std::set<std::uint32_t>;

constexpr std::array methods{"method=pm", "method=dp", "method=fwd", "method=fw"};
constexpr std::array interlaced_methods{"method=pm", "method=fwd", "method=fw"};

/// Surfaces in their own colours: all light is ambient.
Replay unlit(const Stage& stage, Settings settings) {
    settings.insert(settings.end(), {"lights=0", "ambient=1"});
    return stage.replay("deferred", settings);
}

glm::ivec3 pixel(const Replay& replay, std::size_t x, std::size_t y) {
    return codes_at(replay.reference.colour, replay.frame.view.width, x, y);
}

constexpr glm::vec4 green{0, 1, 0, 1}, red_glass{1, 0, 0, 0.4F};
const glm::ivec3 bare(0, 255, 0), through_glass(102, 153, 0); // 0.4 * 255, 0.6 * 255

/// Rows whose pixels all are of that colour.
Rows rows_of(const Replay& replay, const glm::ivec3& colour) {
    Rows rows;
    for (std::uint32_t y = 0; y < replay.frame.view.height; ++y) {
        std::uint32_t same = 0;
        for (std::uint32_t x = 0; x < replay.frame.view.width; ++x) same += pixel(replay, x, y) == colour ? 1 : 0;
        if (same == replay.frame.view.width) rows.insert(y);
    }
    return rows;
}

// A pane that is seen in place of its odd rows, and in the even rows below them, where they are above a row.
Rows seen_of(const Rows& covered, std::uint32_t height) {
    Rows seen;
    for (const std::uint32_t row : covered) {
        if (row % 2 == 0) continue;
        seen.insert(row);
        if (row + 1 < height) seen.insert(row + 1);
    }
    return seen;
}

Rows all_but(const Rows& rows, std::uint32_t height) {
    Rows others;
    for (std::uint32_t y = 0; y < height; ++y)
        if (!rows.contains(y)) others.insert(y);
    return others;
}

// Pixels that are bluer than without refraction.
std::size_t leaks(const Replay& refracting, const Replay& plain) {
    std::size_t count = 0;
    for (std::size_t i = 2; i < plain.reference.colour.size(); i += 4)
        count += refracting.reference.colour[i] > plain.reference.colour[i] ? 1 : 0;
    return count;
}

TEST(DeferredExtremes, S003_D13_NothingInFrontOfAPaneIsSeenThroughIt) {
    Stage stage(64, 64);
    stage.add_whole(3.0, glm::vec4(1.0F), {0, 0, 1}, true); // no blue
    stage.add_whole(2.0, {0, 0, 0, 0.5F}, glm::normalize(glm::vec3(0.6F, 0.6F, 0.8F)));
    traces::add_object(stage.scene, traces::sphere_mesh({0.0, 0.0, -1.5}, 0.4, 24), "ball", {0, 0, 1, 1}, "stage");
    for (const std::string method : methods) {
        const Replay refracting = unlit(stage, {method, "refraction_coefficient=0.125"});
        const Replay plain = unlit(stage, {method, "refraction=false"});
        EXPECT_NE(refracting.reference.colour, plain.reference.colour) << method;
        if (method == "method=fw")
            EXPECT_GT(leaks(refracting, plain), 0U);
        else
            EXPECT_EQ(leaks(refracting, plain), 0U) << method;
    }
}

// The pane covers columns and rows 16 to 47 and shows the wall 8 columns to the right: of its last 8 columns a wall
// that no pane covers. Interlaced, it is seen in rows 17 to 48.
TEST(DeferredExtremes, S003_D13_AWallThatNoPaneCoversIsSeenThroughOne) {
    Stage stage(64, 64);
    stage.add_whole(2.0, glm::vec4(1.0F), {0, 0, 1}, true);
    stage.add({16, 16, 48, 48, 1.0, {0, 0, 0, 0.5F}, {1, 0, 0}});
    const auto behind_pane = [](std::size_t column) { // ramp, and what a pane of 128/255 leaves of it
        const double wall = std::round(255.0 * (static_cast<double>(column) + 0.5) / 64.0);
        return static_cast<int>(std::lround(wall * 127.0 / 255.0));
    };
    for (const std::string method : methods) {
        const Replay replay = unlit(stage, {method, "refraction_coefficient=0.125"});
        const std::size_t first = method == "method=dp" ? 16 : 17;
        std::size_t refracted = 0, rejected = 0;
        for (std::size_t y = first; y < first + 32; ++y)
            for (std::size_t x = 16; x < 48; ++x) {
                refracted += pixel(replay, x, y).r == behind_pane(x + 8) ? 1 : 0;
                rejected += pixel(replay, x, y).r == behind_pane(x) ? 1 : 0;
            }
        const std::size_t wrongly = method == "method=fw" ? 32 * 8 : 0;
        EXPECT_EQ(rejected, wrongly) << method;
        EXPECT_EQ(refracted, 32 * 32 - wrongly) << method;
    }
}

TEST(DeferredExtremes, S003_E1_APaneOfOneRowIsSeenInItsOddRowAndTheOneBelow) {
    for (const std::uint32_t row : {6U, 7U, 14U, 15U})
        for (const std::uint32_t rows : {1U, 2U}) {
            if (row + rows > 16) continue;
            Stage stage(16, 16);
            stage.add_whole(2.0, green);
            stage.add({0, 1.0 * row, 16, 1.0 * row + rows, 1.0, red_glass});
            const Rows covered = rows == 1 ? Rows{row} : Rows{row, row + 1};
            for (const char* method : interlaced_methods)
                for (const char* refraction : {"refraction=true", "refraction=false"}) {
                    const Replay replay = unlit(stage, {method, refraction});
                    EXPECT_EQ(rows_of(replay, through_glass), seen_of(covered, 16)) << method << ' ' << row;
                    EXPECT_EQ(rows_of(replay, bare), all_but(seen_of(covered, 16), 16)) << method << ' ' << row;
                }
            EXPECT_EQ(rows_of(unlit(stage, {"method=dp"}), through_glass), covered);
        }
}

TEST(DeferredExtremes, S003_E2_OfTwoPanesTheNearerOneIsSeenAlone) {
    Stage stage(8, 8);
    stage.add_whole(3.0, green);
    stage.add_whole(2.0, {0, 0, 1, 0.4F});
    stage.add_whole(1.0, red_glass);
    for (const char* method : methods) EXPECT_EQ(pixel(unlit(stage, {method}), 4, 3), through_glass) << method;
}

// With a cleared opacity of 0 an empty row is the clearer of two: the pane above it becomes what is opaque.
TEST(DeferredExtremes, S003_E3_WhereNothingIsDrawnIsOpaque) {
    Stage stage(4, 4);
    stage.add_whole(1.0, red_glass);
    for (const char* method : interlaced_methods) {
        Replay replay = unlit(stage, {method, "refraction=false"});
        EXPECT_EQ(rows_of(replay, {102, 0, 0}), (Rows{1, 2, 3})) << method;
        EXPECT_EQ(rows_of(replay, {0, 0, 0}), (Rows{0})) << method;
        for (pipeline::SurfaceInfo& surface : replay.frame.surfaces)
            if (surface.name == "colours") pack_colour(surface.format, glm::vec4(0.0F), surface.cleared.data());
        replay.reference.colour = support::colours_named(replay, surfaces_of(replay), "picture");
        EXPECT_EQ(rows_of(replay, {255, 0, 0}), (Rows{1, 2, 3})) << method;
    }
}

TEST(DeferredExtremes, S003_E5_TheFirstAndTheLastRowOfPicturesOfAnyHeight) {
    for (const std::uint32_t height : {1U, 2U, 3U, 15U, 16U}) {
        Stage stage(4, height);
        stage.add_whole(2.0, green);
        stage.add_whole(1.0, red_glass);
        for (const char* method : methods)
            for (const char* refraction : {"refraction=true", "refraction=false"}) {
                const Replay replay = unlit(stage, {method, refraction});
                const Rows bare_rows = method == std::string("method=dp") ? Rows{} : Rows{0};
                EXPECT_EQ(rows_of(replay, bare), bare_rows) << method << ' ' << height;
                EXPECT_EQ(rows_of(replay, through_glass), all_but(bare_rows, height)) << method << ' ' << height;
            }
    }
}

// A top edge owns the centres on it, a bottom edge does not: a pane of one row's height covers `row` until it is moved
// by more than none. Half a row up changes nothing, one unit of 1/256 down swaps what vanishes and what stays.
TEST(DeferredExtremes, S003_E6_HalfATexelDecidesWhichRowsAre) {
    for (const std::uint32_t row : {6U, 7U})
        for (const int shift : {-128, -1, 0, 1, 128}) {
            Stage stage(16, 16);
            stage.add_whole(2.0, green);
            const double top = row + 0.5 + shift / 256.0;
            stage.add({0, top, 16, top + 1.0, 1.0, red_glass});
            const Rows covered{shift > 0 ? row + 1 : row};
            EXPECT_EQ(rows_of(unlit(stage, {"method=dp"}), through_glass), covered) << row << ' ' << shift;
            for (const char* method : interlaced_methods)
                EXPECT_EQ(rows_of(unlit(stage, {method}), through_glass), seen_of(covered, 16)) << row << ' ' << shift;
        }
}

// Two rows of one column, in the light of 1, through the shader of the composition.
glm::vec4 lower_of(const glm::vec4& upper, const glm::vec4& lower) {
    std::vector<pipeline::SurfaceInfo> infos(2);
    for (pipeline::SurfaceInfo& info : infos) info.height = 2;
    pipeline::SurfaceStore surfaces(infos);
    for (const std::uint32_t row : {0U, 1U}) {
        pack_colour(pipeline::SurfaceFormat::rgba8, row == 0 ? upper : lower, surfaces.written(0, {0, row}));
        pack_colour(pipeline::SurfaceFormat::rgba8, glm::vec4(1, 1, 1, 0), surfaces.written(1, {0, row}));
    }
    pipeline::View eye;
    eye.width = 1;
    eye.height = 2;
    const std::vector<pipeline::SurfaceId> slots{0, 1};
    pipeline::SurfaceAccess access(surfaces, slots);
    pipeline::ShaderInput input;
    input.pixels = 0b0101;
    pipeline::ShaderOutput output;
    output.alive = input.pixels;
    traces::interlaced_composition(eye, {.refraction = false})->shade(input, access, output);
    EXPECT_EQ(output.colours[0][0], glm::vec4(glm::vec3(upper), 1.0F)); // nothing is above it
    return output.colours[0][2];
}

TEST(DeferredExtremes, S003_E4_OpacitiesThatAreEqualAndOneCodeApart) {
    const auto red = [](int code) { return glm::vec4(1, 0, 0, static_cast<float>(code) / 255.0F); };
    const auto blue = [](int code) { return glm::vec4(0, 0, 1, static_cast<float>(code) / 255.0F); };
    EXPECT_EQ(lower_of(red(255), blue(255)), glm::vec4(0, 0, 1, 1)); // opaque rows do not move
    EXPECT_EQ(lower_of(red(102), blue(102)), glm::vec4(0, 0, 1, 1)); // nor do panes
    EXPECT_EQ(lower_of(red(0), blue(0)), glm::vec4(0, 0, 1, 1));
    const auto expect_blend = [](const glm::vec4& colour, float more) {
        EXPECT_FLOAT_EQ(colour.r, more);
        EXPECT_NEAR(colour.b, 1.0F - more, 1e-6F);
    };
    expect_blend(lower_of(red(255), blue(254)), 1.0F / 255.0F);
    expect_blend(lower_of(red(254), blue(255)), 254.0F / 255.0F);
    expect_blend(lower_of(red(0), blue(1)), 0.0F);
    EXPECT_FLOAT_EQ(lower_of(red(102), blue(103)).r, 102.0F / 255.0F); // the clearer one is in front,
    EXPECT_FLOAT_EQ(lower_of(red(102), blue(103)).b, 153.0F / 255.0F); // whatever lies below it
}

// Opaque is what eight bits keep as opaque, or a row of opaque surfaces would hold a pane of 254/255.
TEST(DeferredExtremes, S003_E4_AnOpacityBetweenTheTwoHighestCodes) {
    const float middle = 254.5F / 255.0F;
    std::vector<float> opacities{254.4F / 255.0F, 254.6F / 255.0F, middle};
    for (float below = middle, above = middle; opacities.size() < 19;) {
        opacities.push_back(below = std::nextafter(below, 0.0F));
        opacities.push_back(above = std::nextafter(above, 1.0F));
    }
    std::set<int> codes;
    for (const float opacity : opacities) {
        Stage stage(4, 4);
        stage.add_whole(2.0, green);
        stage.add_whole(1.0, {1, 0, 0, opacity});
        const int code = pipeline::float_to_unorm8(opacity);
        codes.insert(code);
        for (const char* method : interlaced_methods) {
            const Replay replay = unlit(stage, {method, "refraction=false"});
            const auto colours = support::colours_named(replay, surfaces_of(replay), "colours");
            EXPECT_EQ(codes_at(colours, 4, 1, 1).a, code) << method;
            EXPECT_EQ(codes_at(colours, 4, 1, 2).a, 255) << method << ' ' << opacity; // the wall or the sheet
            EXPECT_EQ(codes_at(colours, 4, 1, 2).r, code == 255 ? 255 : 0) << method << ' ' << opacity;
        }
    }
    EXPECT_EQ(codes, (std::set{254, 255}));
}

// Behind an opaque row a pane sees the same row: one that does not bend changes nothing.
TEST(DeferredExtremes, S003_E18_APaneThatDoesNotBendShowsWhatIsRightBehind) {
    for (const auto& [normal, coefficient] : {std::pair{glm::vec3(0, 0, 1), "refraction_coefficient=1"},
                                              std::pair{glm::vec3(0, 1, 0), "refraction_coefficient=0"}}) {
        Stage stage(16, 15);
        stage.add_whole(2.0, glm::vec4(1.0F), {0, 0, 1}, true);
        stage.add_whole(1.0, {0, 0, 0, 0.5F}, normal);
        for (const char* method : methods)
            EXPECT_EQ(unlit(stage, {method, coefficient}).reference.colour,
                      unlit(stage, {method, "refraction=false"}).reference.colour)
                << method << ' ' << coefficient;
    }
}

// Offsets of 8 pixels in each direction: the last of them that lands on the edge, and those beyond, which stop there.
TEST(DeferredExtremes, S003_E18_WhatLiesBesideThePictureIsItsEdge) {
    const auto ramp = [](int at) { return std::round(255.0 * (at + 0.5) / 64.0); };
    const auto behind_pane = [](double wall) { return static_cast<int>(std::lround(wall * 127.0 / 255.0)); };
    for (const glm::ivec2& offset : {glm::ivec2(8, 0), glm::ivec2(-8, 0), glm::ivec2(0, 8), glm::ivec2(0, -8)}) {
        Stage stage(64, 64);
        stage.add_whole(2.0, glm::vec4(1.0F), {0, 0, 1}, true);
        stage.add_whole(1.0, {0, 0, 0, 0.5F}, {offset.x / 8, -offset.y / 8, 0}); // rows go down
        for (const std::string method : {"method=pm", "method=dp", "method=fwd"}) {
            const Replay replay = unlit(stage, {method, "refraction_coefficient=0.125"});
            const bool interlaced = method != "method=dp";
            for (int y = interlaced ? 1 : 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x) {
                    const int column = std::clamp(x + offset.x, 0, 63), row = std::clamp(y + offset.y, 0, 63);
                    const int opaque_row = interlaced && row % 2 == 1 ? row - 1 : row;
                    const glm::ivec3 seen(behind_pane(ramp(column)), behind_pane(ramp(opaque_row)), 0);
                    ASSERT_EQ(pixel(replay, static_cast<std::size_t>(x), static_cast<std::size_t>(y)), seen)
                        << method << ' ' << x << ' ' << y << ' ' << offset.x;
                }
        }
    }
}

} // namespace deferred_extremes_test
