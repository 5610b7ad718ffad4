// Fixed-function blending: the ROP's own read-modify-write, in primitive order.
#include "pipeline/functional/shader.hpp"
#include "reports/comparison.hpp"
#include "sim/counted.hpp"
#include "tests/support/replay.hpp"

#include <algorithm>
#include <bit>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace blended_test {

support::ReplayOptions blended(std::vector<std::string> knobs) {
    support::ReplayOptions options;
    options.width = options.height = 96;
    options.workload = "blended";
    options.knobs = std::move(knobs);
    return options;
}

TEST(Blended, EveryModeAndFormatEqualsTheReferenceBitForBit) {
    for (const char* mode : {"replace", "over", "add", "least", "greatest"})
        for (const char* format : {"rgba8", "rgba16f", "rgba32f"}) {
            const support::Replay replay(
                "gen:discs?n=200", blended({std::string("mode=") + mode, std::string("colour_format=") + format}));
            const pipeline::RunResult result = replay.run("existing");
            EXPECT_EQ(result.wrong_pixels, 0U) << mode << ' ' << format;
            EXPECT_EQ(result.colour, replay.reference.colour) << mode << ' ' << format;
        }
}

TEST(Blended, BlendingReadsTheColourTilesAndReplacingDoesNot) {
    const support::Replay over("gen:discs?n=200", blended({"mode=over"}));
    const support::Replay replace("gen:discs?n=200", blended({"mode=replace"}));
    EXPECT_TRUE(over.run("existing").bytes->contains("dram_tile_read"));
    EXPECT_FALSE(replace.run("existing").bytes->contains("dram_tile_read"));
}

TEST(Blended, OneFragmentOverTheBackgroundIsTheClosedForm) {
    const support::Replay replay("gen:quads?n=1",
                                 blended({"colour_format=rgba32f", "opacity=0.25", "background=[0.5,0.5,0.5]"}));
    const auto& colours = replay.streams[0].colours.at(0)[0];
    const pipeline::RunResult result = replay.run("existing");
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_FLOAT_EQ(result.colour.at(static_cast<std::size_t>(channel)), colours[channel] * 0.25F + 0.5F * 0.75F);
}

TEST(Blended, OpacityScalesTheAlphaThatTheFragmentsCarry) {
    const auto alphas = [](const char* mode, const char* opacity) {
        const support::Replay replay("gen:quads?n=1", blended({std::string("mode=") + mode, opacity}));
        return replay.streams[0].colours.at(0)[0].a;
    };
    EXPECT_EQ(alphas("over", "opacity=0.25"), 0.25F);
    EXPECT_EQ(alphas("add", "opacity=0.75"), 0.75F);
    EXPECT_EQ(alphas("replace", "opacity=0.25"), 1.0F);
}

// One instruction for the result's move, which multiplies: an opacity costs nothing.
TEST(Blended, OpacityTakesNoTime) {
    const support::Replay half("gen:discs?n=200", blended({"opacity=0.5"})),
        whole("gen:discs?n=200", blended({"opacity=1"}));
    const pipeline::RunResult a = half.run("existing", {"fragment.alu_per_clk=1"}),
                              b = whole.run("existing", {"fragment.alu_per_clk=1"});
    EXPECT_EQ(a.cycles, b.cycles);
    EXPECT_NE(a.colour, b.colour);
    const auto cost = [](const support::Replay& replay) {
        const pipeline::Frame& frame = replay.frame;
        const pipeline::Draw& draw = frame.draws[0];
        return pipeline::shader_cost(frame.resources->materials[draw.material],
                                     frame.resources->geometries[draw.geometry], frame.needs_of(frame.passes.back()))
            .alu;
    };
    EXPECT_EQ(support::counter(a.stages, "fragment_pipeline/counters/issue_cycles"),
              cost(half) * support::counter(a.stages, "fragment_pipeline/counters/quads"));
}

// What came of colours beyond 16-bit floats stands in the result.
TEST(Blended, ChannelsBeyondHalvesAreNoted) {
    const auto notes = [](float brightness, const char* overflow) {
        reports::ComparisonRequest request;
        request.scene = "gen:quads?n=1";
        request.width = request.height = 32;
        request.workload = "blended";
        request.workload_settings = {"mode=replace", "colour_format=rgba16f"};
        request.gpu_settings = {std::string("rop.fp16_overflow=") + overflow};
        request.designs = {"existing"};
        reports::ComparisonInput input = reports::prepare(request);
        std::uint64_t fragments = 0;
        for (std::size_t quad = 0; quad < input.streams[0].quads.size(); ++quad) {
            fragments += static_cast<std::uint64_t>(std::popcount(unsigned{input.streams[0].quads[quad].alive}));
            input.streams[0].colours[quad].fill(glm::vec4(brightness, 1.0F, -brightness, 1.0F));
        }
        input.reference =
            pipeline::run_reference(*input.frame, input.streams, 1, 1, input.designs[0].gpu.rop.fp16_overflow);
        const reports::Comparison comparison = reports::compare(std::move(input));
        EXPECT_EQ(comparison.runs[0].wrong_pixels, 0U);
        EXPECT_EQ(support::counter(comparison.runs[0].stages, "rop/counters/fp16_overflows"),
                  brightness < 65520.0F ? 0U : 2 * fragments);
        EXPECT_GT(fragments, 0U);
        const auto& all = comparison.scene.notes;
        return std::count_if(all.begin(), all.end(), [&](const std::string& note) {
            return note == sim::counted(2 * fragments, "stored colour channel") +
                               " left the range of 16-bit floats and " +
                               (overflow == std::string("saturate") ? "were saturated" : "became infinite") +
                               " (rop.fp16_overflow)";
        });
    };
    for (const char* overflow : {"saturate", "infinity"}) {
        EXPECT_EQ(notes(65504.0F, overflow), 0);
        EXPECT_EQ(notes(65520.0F, overflow), 1);
    }
}

} // namespace blended_test
