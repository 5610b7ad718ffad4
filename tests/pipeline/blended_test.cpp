// Fixed-function blending: the ROP's own read-modify-write, in primitive order.
#include "tests/support/replay.hpp"

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

} // namespace blended_test
