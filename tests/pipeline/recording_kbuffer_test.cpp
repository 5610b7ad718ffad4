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

} // namespace recording_kbuffer_test
