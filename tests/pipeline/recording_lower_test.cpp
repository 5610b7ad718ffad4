// Recordings as frames: what is drawn where, orientation, clears of parts, copies, frames in a row, caches, errors.
#include "sim/check.hpp"
#include "tests/support/drawn_recording.hpp"

#include <gtest/gtest.h>

namespace recording_lower_test {

using namespace drawn_recording;
using tests::RecordedFrames;
using Shade = RecordedFrames::Shade;

TEST(RecordingLower, DrawsWithClearAndDepthTest) {
    RecordedFrames frames(width, height);
    const std::uint32_t tested = frames.add_state(depth_tested());
    frames.clear(blue);
    frames.draw(RecordedFrames::rectangle({-1, -1}, {0, 1}, red, 0.25F), Shade::colour, tested);
    frames.draw(RecordedFrames::everything(green, 0.5F), Shade::colour, tested);
    frames.draw(RecordedFrames::rectangle({0, 0}, {1, 1}, black, 0.75F), Shade::colour, tested); // behind
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.frame.passes.size(), 2U); // the clear, and all draws
    EXPECT_EQ(drawn.frame.passes[1].draws.size(), 3U);
    EXPECT_EQ(drawn.at(2, 3), red);
    EXPECT_EQ(drawn.at(20, 3), green);
    EXPECT_EQ(drawn.at(20, 12), green);
}

// The upper right quarter of clip space is the upper right one of the window.
TEST(RecordingLower, RowZeroOfAWindowIsItsTop) {
    RecordedFrames frames(width, height);
    frames.clear(black);
    frames.draw(RecordedFrames::rectangle({0, 0}, {1, 1}, red));
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(20, 2), red);
    EXPECT_EQ(drawn.at(20, 12), black);
    EXPECT_EQ(drawn.at(2, 2), black);
}

// ... and of a texture that is drawn to the last rows, so that it lies where its coordinates are large.
TEST(RecordingLower, RowZeroOfATextureIsItsBottom) {
    RecordedFrames frames(width, height);
    const std::uint32_t targets = frames.add_texture_target(8, 8);
    frames.clear(blue, targets);
    frames.draw(RecordedFrames::rectangle({0, 0}, {1, 1}, red), Shade::colour, 0, targets);
    frames.clear(black);
    // Red and green of the corners are coordinates: those of the texture that lie there when it fills the window.
    std::vector<RecordedFrames::Triangle> whole = RecordedFrames::everything(black);
    for (auto& triangle : whole)
        for (auto& corner : triangle) corner.colour = {(corner.position.x + 1) / 2, (corner.position.y + 1) / 2, 0, 1};
    frames.draw(whole, Shade::textured).bindings = frames.bind(2);
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(20, 2), red); // as it was drawn: above, to the right
    EXPECT_EQ(drawn.at(20, 12), blue);
    EXPECT_EQ(drawn.at(2, 2), blue);
}

TEST(RecordingLower, WindowCoordinatesCountFromTheBottom) {
    RecordedFrames frames(width, height);
    const std::uint32_t targets = frames.add_texture_target(8, 8);
    frames.recording.surfaces[2].format = frames.recording.surfaces[0].format = pipeline::SurfaceFormat::rgba32f;
    frames.draw(RecordedFrames::everything(red, 0.25F), Shade::places, 0, targets);
    frames.recording.frames[0].shown = targets;
    const Drawn texture(frames.recording);
    EXPECT_EQ(texture.at(3, 1), glm::vec4(3.5F / 256, 1.5F / 256, 0.75F, 1)); // row 1 is the second from the bottom
    frames.draw(RecordedFrames::everything(red, 0.25F), Shade::places);
    frames.recording.frames[0].shown = 0;
    const Drawn window(frames.recording);
    EXPECT_EQ(window.at(3, 1), glm::vec4(3.5F / 256, (height - 1.5F) / 256, 0.75F, 1));
}

// A triangle that runs counter-clockwise with y up shows its front, whichever way rows run.
TEST(RecordingLower, FrontsDoNotDependOnTheOrderOfRows) {
    const auto facing = [](std::uint32_t to_texture, bool clockwise, pipeline::FaceCulling culling) {
        RecordedFrames frames(width, height);
        const std::uint32_t targets = to_texture != 0 ? frames.add_texture_target(width, height) : 0;
        RasterState state;
        state.front_is_clockwise = clockwise;
        state.culling = culling;
        frames.clear({0, 1, 0, 0}, targets);
        frames.draw(RecordedFrames::everything(red), Shade::facing, frames.add_state(state), targets);
        frames.recording.frames[0].shown = targets;
        return Drawn(frames.recording).at(5, 5);
    };
    for (const std::uint32_t texture : {0U, 1U}) {
        EXPECT_EQ(facing(texture, false, pipeline::FaceCulling::none), glm::vec4(1));
        EXPECT_EQ(facing(texture, true, pipeline::FaceCulling::none), black);
        EXPECT_EQ(facing(texture, false, pipeline::FaceCulling::back), glm::vec4(1));
        EXPECT_EQ(facing(texture, false, pipeline::FaceCulling::front), glm::vec4(0, 1, 0, 0));
        EXPECT_EQ(facing(texture, true, pipeline::FaceCulling::back), glm::vec4(0, 1, 0, 0));
    }
}

TEST(RecordingLower, ClearsOfPartsLeaveTheRest) {
    RecordedFrames frames(width, height);
    frames.clear(blue);
    auto& part = frames.clear(red);
    part.scissor = pipeline::PixelRectangle{4, 2, 8, 5};
    part.write_mask[0] = 5; // red and blue
    part.depth = 0.25F;
    part.stencil = 0xF3;
    part.stencil_mask = 0x0F;
    RasterState state = depth_tested(false);
    state.stencil.test = true;
    state.stencil.front.compare = state.stencil.back.compare = pipeline::Compare::equal;
    state.stencil.front.reference = state.stencil.back.reference = 3;
    frames.draw(RecordedFrames::everything(green, 0.2F), Shade::colour, frames.add_state(state));
    frames.draw(RecordedFrames::rectangle({-1, -1}, {1, 1}, glm::vec4(1), 0.3F), Shade::colour,
                frames.add_state(depth_tested()));
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(4, 2), green);         // its stencil is 3, its depth 0.25
    EXPECT_EQ(drawn.at(11, 6), green);        // the last pixel of the rectangle
    EXPECT_EQ(drawn.at(12, 6), glm::vec4(1)); // beside: farthest depth
    EXPECT_EQ(drawn.at(4, 1), glm::vec4(1));
}

TEST(RecordingLower, ASecondClearMayHaveAnotherValue) {
    RecordedFrames frames(width, height);
    frames.clear(blue);
    frames.draw(RecordedFrames::rectangle({-1, -1}, {0, 0}, red));
    frames.clear(green).depth.reset();
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(2, 12), green);
    EXPECT_EQ(drawn.at(20, 2), green);
}

TEST(RecordingLower, WhatNobodyClearedHoldsItsContents) {
    RecordedFrames frames(width, height);
    frames.recording.surfaces[0].levels[0] = std::vector(width * height * 4, std::byte{0x33});
    frames.draw(RecordedFrames::rectangle({-1, -1}, {0, 1}, red));
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(2, 2), red);
    EXPECT_EQ(drawn.at(20, 2), glm::vec4(0.2F));
}

TEST(RecordingLower, TheAlphaTestDiscards) {
    RecordedFrames frames(width, height);
    frames.clear(blue);
    auto& draw =
        frames.draw({{{{{-1, -1, 0, 1}, {1, 0, 0, 0}}, {{3, -1, 0, 1}, {1, 0, 0, 2}}, {{-1, 3, 0, 1}, {1, 0, 0, 0}}}}});
    draw.alpha_test = pipeline::Compare::greater;
    draw.alpha_reference = 0.5F; // alpha is x + 1 over 2, from left to right
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(width / 2 - 1, 5), blue);
    EXPECT_EQ(drawn.at(width / 2, 5).r, 1.0F);
}

TEST(RecordingLower, CopiesMoveAndMirrorTexels) {
    for (const bool mirrored : {false, true}) {
        RecordedFrames frames(width, height);
        frames.add_texture(2, 3, {0xFF0000FF, 0x00FF00FF, 0x0000FFFF, 0xFFFFFFFF, 0x333333FF, 0x666666FF});
        frames.clear(black);
        traces::RecordedCopy copy;
        copy.name = "copy";
        copy.from = {2, 0, 0};
        copy.to = {0, 0, 0};
        copy.rectangle = {0, 1, 2, 2};
        copy.to_x = 7;
        copy.to_y = 5;
        copy.mirrored = mirrored;
        frames.recording.frames[0].commands.emplace_back(copy);
        const Drawn drawn(frames.recording);
        EXPECT_EQ(drawn.at(7, mirrored ? 6 : 5), blue);
        EXPECT_EQ(drawn.at(8, mirrored ? 6 : 5), glm::vec4(1));
        EXPECT_EQ(drawn.at(7, mirrored ? 5 : 6), glm::vec4(0.2F, 0.2F, 0.2F, 1));
        EXPECT_EQ(drawn.at(9, 5), black);
        EXPECT_EQ(drawn.at(7, 4), black);
        EXPECT_EQ(drawn.at(7, 7), black);
    }
}

TEST(RecordingLower, DepthsAreCopied) {
    RecordedFrames frames(width, height);
    frames.recording.surfaces.push_back(
        {.name = "other", .format = pipeline::SurfaceFormat::d24s8, .width = width, .height = height});
    traces::TargetSet other;
    other.depth = traces::TargetSet::Target{2, 0, 0};
    other.width = width;
    other.height = height;
    frames.recording.targets.push_back(other);
    const std::uint32_t tested = frames.add_state(depth_tested());
    frames.clear(blue);
    frames.clear(black, 1).colours = 0;
    frames.draw(RecordedFrames::rectangle({-1, -1}, {0, 1}, black, 0.3F), Shade::colour, tested, 1);
    traces::RecordedCopy copy;
    copy.name = "copy";
    copy.from = {2, 0, 0};
    copy.to = {1, 0, 0};
    copy.rectangle = {0, 0, width, height};
    frames.recording.frames[0].commands.emplace_back(copy);
    RasterState equal = depth_tested(false);
    equal.depth.compare = pipeline::Compare::equal;
    frames.draw(RecordedFrames::everything(green, 0.3F), Shade::colour, frames.add_state(equal));
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(2, 4), green); // bit for bit
    EXPECT_EQ(drawn.at(20, 4), blue);
}

TEST(RecordingLower, OfFramesBeforeOnlyWhatIsKeptIsDrawn) {
    RecordedFrames frames(width, height);
    const std::uint32_t targets = frames.add_texture_target(8, 8);
    frames.clear(blue, targets);
    frames.draw(RecordedFrames::everything(red), Shade::colour, 0, targets);
    frames.clear(black);
    frames.draw(RecordedFrames::everything(green));
    frames.next_frame();
    frames.clear(black);
    frames.draw(RecordedFrames::everything({0.5F, 0.5F, 0, 1}), Shade::textured).bindings = frames.bind(2);
    const Drawn second(frames.recording, {.first_frame = 1, .last_frame = 1});
    EXPECT_EQ(second.at(3, 3), red);
    EXPECT_NE(second.pass("frame 0 pass 0"), nullptr);
    EXPECT_EQ(second.pass("frame 0 pass 1"), nullptr); // the window was cleared since
    const Drawn both(frames.recording, {.first_frame = 0, .last_frame = 1});
    EXPECT_NE(both.pass("frame 0 pass 1"), nullptr);
    EXPECT_THROW(traces::lower(frames.recording, {.first_frame = 0, .last_frame = 2}, "test"), sim::InputError);
}

// The texture of 64 bytes a tile fits into the cache: a second frame misses nothing, or all of it again.
TEST(RecordingLower, CachesStayWarmOrAreColdWhenAFrameBegins) {
    RecordedFrames frames(width, height);
    frames.add_texture(8, 8, std::vector<std::uint32_t>(64, 0x336699FFU));
    std::vector<RecordedFrames::Triangle> whole = RecordedFrames::everything(black);
    for (auto& triangle : whole)
        for (auto& corner : triangle) corner.colour = {(corner.position.x + 1) / 2, (corner.position.y + 1) / 2, 0, 1};
    for (int frame = 0; frame < 2; ++frame) {
        if (frame == 1) frames.next_frame();
        frames.draw(whole, Shade::textured).bindings = frames.bind(2);
    }
    const auto misses = [&frames](bool cold) {
        const Drawn drawn(frames.recording, {.first_frame = 0, .last_frame = 1, .kbuffer = {}, .cold = cold});
        const pipeline::RunResult result = run(drawn, "existing");
        std::vector<std::uint64_t> of_passes;
        for (const pipeline::PassResult& pass : result.passes)
            of_passes.push_back(pass.counters->at("fragment")["l1"]["texture_misses"].get<std::uint64_t>());
        return of_passes;
    };
    const auto warm = misses(false), cold = misses(true);
    ASSERT_EQ(warm.size(), 2U);
    EXPECT_GE(warm[0], 4U); // tiles
    EXPECT_EQ(warm[1], 0U);
    EXPECT_EQ(cold[0], warm[0]);
    EXPECT_EQ(cold[1], cold[0]);
}

TEST(RecordingLower, ErrorsNameTheirPlace) {
    RecordedFrames frames(width, height);
    frames.draw(RecordedFrames::everything(red));
    traces::Recording broken = frames.recording;
    broken.programs[0].fragment.resize(20);
    broken.programs[0].name = "sky";
    try {
        traces::lower(broken, {}, "x.rtrace");
        FAIL();
    } catch (const sim::InputError& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("x.rtrace: program \"sky\": fragment shader: SPIR-V"))
            << error.what();
    }
    broken = frames.recording;
    broken.programs[0].vertex = broken.programs[0].fragment;
    EXPECT_THROW(traces::lower(broken, {}, "x.rtrace"), sim::InputError);
}

} // namespace recording_lower_test
