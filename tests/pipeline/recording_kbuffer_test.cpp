// Draws of recordings that go through a k-buffer in place of their blending, and machines that draw recordings.
#include "sim/check.hpp"
#include "tests/support/drawn_recording.hpp"
#include "tests/support/replay.hpp"

#include <gtest/gtest.h>

namespace recording_kbuffer_test {

using namespace drawn_recording;
using tests::RecordedFrames;
using Shade = RecordedFrames::Shade;

/// Three layers in an order that is not that of their depths.
RecordedFrames layers(const RasterState& state) {
    RecordedFrames frames(width, height);
    const std::uint32_t number = frames.add_state(state);
    frames.clear({0.2F, 0.4F, 0.6F, 1});
    frames.draw(RecordedFrames::everything({1, 0, 0, 0.5F}, 0.5F), Shade::colour, number);
    frames.draw(RecordedFrames::everything({0, 1, 0, 0.25F}, 0.25F), Shade::colour, number);
    frames.draw(RecordedFrames::everything({0, 0, 1, 0.75F}, 0.75F), Shade::colour, number);
    return frames;
}

LowerOptions with_kbuffer(const std::string& draws, std::uint32_t k) {
    LowerOptions options;
    options.kbuffer = traces::KBufferChoice::of(draws, k);
    return options;
}

void expect_near(const glm::vec4& a, const glm::vec4& b) {
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(a[channel], b[channel], 1.01F / 255);
}

TEST(RecordingKBuffer, AKBufferSortsWhatBlendingDoesNot) {
    const auto lay = [](const glm::vec4& over, const glm::vec4& under) {
        return glm::vec4(glm::vec3(over) * over.a + glm::vec3(under) * (1 - over.a), 1);
    };
    const glm::vec4 behind(0.2F, 0.4F, 0.6F, 1), far(0, 0, 1, 0.75F), middle(1, 0, 0, 0.5F), near(0, 1, 0, 0.25F);
    const RecordedFrames frames = layers(over());
    expect_near(Drawn(frames.recording).at(4, 4), lay(far, lay(near, lay(middle, behind))));
    for (const char* draws : {"blended", "draws=0:3", "pass=0"}) {
        SCOPED_TRACE(draws);
        const Drawn kept(frames.recording, with_kbuffer(draws, 3));
        ASSERT_NE(kept.frame.program, nullptr);
        expect_near(kept.at(4, 4), lay(near, lay(middle, lay(far, behind))));
        EXPECT_EQ(kept.frame.program->k(), 3U);
    }
    // One draw alone is where it was: nothing is sorted.
    expect_near(Drawn(frames.recording, with_kbuffer("draws=1", 3)).at(4, 4), lay(far, lay(near, lay(middle, behind))));
}

// Menus: letters have the depth of the panel that they are written on, and came later.
TEST(RecordingKBuffer, OfEqualDepthsTheLaterDrawIsInFront) {
    RecordedFrames frames(width, height);
    const std::uint32_t state = frames.add_state(over());
    frames.clear({0.2F, 0.4F, 0.6F, 1});
    for (const glm::vec4& colour : {glm::vec4(1, 0, 0, 0.5F), glm::vec4(0, 1, 0, 0.25F), glm::vec4(0, 0, 1, 0.75F)})
        frames.draw(RecordedFrames::everything(colour, 0.5F), Shade::colour, state);
    const glm::vec4 expected = Drawn(frames.recording).at(4, 4);
    for (std::uint32_t k = 1; k <= 4; ++k)
        expect_near(Drawn(frames.recording, with_kbuffer("blended", k)).at(4, 4), expected);
    const Drawn kept(frames.recording, with_kbuffer("blended", 4));
    for (const char* design : {"scoreboard", "blender", "linked-list"}) {
        const pipeline::RunResult result = run(kept, design);
        EXPECT_EQ(result.wrong_pixels, 0U) << design;
        EXPECT_EQ(result.colour, kept.image.colour) << design;
    }
}

TEST(RecordingKBuffer, AFrameWithoutDrawsForItSaysWhy) {
    const auto refusal = [](const RasterState& state) -> std::string {
        try {
            const Drawn kept(layers(state).recording, with_kbuffer("blended", 3));
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_TRUE(refusal(depth_tested()).ends_with("expected a draw that can go through it, found none that blends"))
        << refusal(depth_tested());
    RasterState writes = over();
    writes.depth.test = writes.depth.write = true;
    EXPECT_TRUE(refusal(writes).ends_with("found none (not kept in the k-buffer: 3 blended draws: it writes depth)"))
        << refusal(writes);
}

// Sums do not depend on the order.
TEST(RecordingKBuffer, AKBufferKeepsWhatSumsGive) {
    for (const BlendFactor source : {BlendFactor::one, BlendFactor::source_alpha}) {
        const RecordedFrames frames = layers(blended(source, BlendFactor::one));
        const Drawn blended_draws(frames.recording), kept(frames.recording, with_kbuffer("blended", 3));
        for (std::uint32_t x = 0; x < width; x += 5) expect_near(kept.at(x, 4), blended_draws.at(x, 4));
    }
}

TEST(RecordingKBuffer, WhatNoKBufferKeepsStaysOrIsNamed) {
    RecordedFrames frames = layers(over());
    RasterState writes = over();
    writes.depth.test = writes.depth.write = true;
    frames.draw(RecordedFrames::everything(red), Shade::colour, frames.add_state(writes));
    const Drawn kept(frames.recording, with_kbuffer("blended", 3));
    ASSERT_EQ(kept.frame.notes.size(), 1U);
    EXPECT_EQ(kept.frame.notes[0], "not kept in the k-buffer: 1 blended draw: it writes depth");
    EXPECT_THROW(traces::lower(frames.recording, with_kbuffer("draws=2:4", 3), "test"), sim::InputError);
    EXPECT_THROW(traces::lower(frames.recording, with_kbuffer("draws=7", 3), "test"), sim::InputError);
    for (const char* wrong : {"", "all", "draws=", "draws=3:1", "draws=1:1", "draws=1:", "pass=a", "pass=1:2:3"})
        EXPECT_THROW(traces::KBufferChoice::of(wrong, 3), sim::InputError) << wrong;
    EXPECT_THROW(traces::KBufferChoice::of("blended", 0), sim::InputError);
    EXPECT_THROW(traces::KBufferChoice::of("blended", 52), sim::InputError);
}

// Every design that protects its pixels gives the reference; the others' wrong pixels have recorded hazards.
TEST(RecordingKBuffer, MachinesDrawTheReference) {
    RecordedFrames frames = layers(over());
    const std::uint32_t targets = frames.add_texture_target(8, 8);
    frames.draw(RecordedFrames::everything(red), Shade::places, 0, targets);
    frames.draw(RecordedFrames::rectangle({-1, -1}, {0.3F, 0.3F}, {0.5F, 0.5F, 0, 1}), Shade::textured).bindings =
        frames.bind(2);
    for (const bool kbuffer : {false, true}) {
        const Drawn drawn(frames.recording, kbuffer ? with_kbuffer("blended", 4) : LowerOptions());
        for (const char* design : {"existing", "scoreboard", "blender", "sorted", "batched", "linked-list"}) {
            const pipeline::RunResult result = run(drawn, design);
            if (!kbuffer || (support::protects(design) && support::keeps_submission(design))) {
                EXPECT_EQ(result.wrong_pixels, 0U) << design;
                EXPECT_EQ(result.colour, drawn.image.colour) << design;
            }
            EXPECT_GT(result.cycles, 100U);
        }
    }
}

// Entries that are read through the texture caches are lines there, and push texels out: 4 nodes of 96 quads take 5
// lines each, a pipe's cache holds 64, the picture takes 16.
TEST(RecordingKBuffer, EntriesPushTexelsOutOfTheTextureCaches) {
    RecordedFrames frames(width, height);
    frames.add_texture(16, 16, std::vector<std::uint32_t>(256, 0x33669980U));
    const std::uint32_t state = frames.add_state(over()), bound = frames.bind(2);
    frames.clear(black);
    std::vector<RecordedFrames::Triangle> layer = RecordedFrames::everything(black);
    for (auto& triangle : layer)
        for (auto& corner : triangle) corner.colour = {(corner.position.x + 1) / 2, (corner.position.y + 1) / 2, 0, 1};
    for (int i = 0; i < 8; ++i) frames.draw(layer, Shade::textured, state).bindings = bound;
    const Drawn drawn(frames.recording, with_kbuffer("blended", 4));
    const auto texel_bytes = [&drawn](const char* setting) {
        sim::Config config;
        config.set(setting);
        const auto design = models::make_design("existing", config);
        pipeline::Machine machine({}, drawn.frame, drawn.streams, *design);
        const pipeline::RunResult result = machine.run(drawn.image);
        std::uint64_t bytes = 0; // without those of the pass that lays the nodes
        for (std::size_t draw = 0; draw < result.draws.size(); ++draw)
            if (result.draws[draw].name == "draw") bytes += result.draw_counter(draw, "dram_texture_bytes");
        return bytes;
    };
    const std::uint64_t through = texel_bytes("existing.bypass_l1=false"),
                        past = texel_bytes("existing.bypass_l1=true");
    EXPECT_LE(past, 16 * 64 * pipeline::GpuParams().fragment.pipes); // each texel once a pipe
    EXPECT_GT(through, 2 * past);
}

} // namespace recording_kbuffer_test
