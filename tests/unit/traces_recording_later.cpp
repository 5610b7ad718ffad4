// What recorded traces say beside what all of them have: depth ranges of states, and blits.
#include "sim/check.hpp"
#include "tests/support/recorded_file.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/trace_files.hpp"
#include "traces/recording/recording_check.hpp"
#include "traces/rtrace/chunk.hpp"
#include "traces/rtrace/little_endian.hpp"
#include "traces/trace_text.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace recording_later_test {

using support::Chunk;
using traces::Recording;
namespace chunk = traces::rtrace::chunk;

class RecordedLater : public support::RecordedFile {};

traces::RecordedBlit some_blit() {
    traces::RecordedBlit blit;
    blit.name = "blit";
    blit.from = {0, 0, 0};
    blit.to = {2, 1, 0};
    blit.source = {-3, 2, 10, 12};
    blit.destination = {1, -4, 65536, 5};
    blit.mirrored_x = blit.linear = true;
    blit.scissor = pipeline::PixelRectangle{0, 0, 2, 1};
    return blit;
}

/// Two more states with a depth range each, and a blit.
Recording ranges_and_a_blit() {
    Recording recording = support::quad_recording();
    recording.states.resize(3);
    recording.states[1].depth.range_near = 0.25F;
    recording.states[2].depth.range_near = 1.0F;
    recording.states[2].depth.range_far = 0.0F;
    recording.frames[0].commands.emplace_back(some_blit());
    return recording;
}

TEST_F(RecordedLater, HasDepthRangesWhereThereAreAny) {
    const auto has_ranges = [](const std::filesystem::path& file) {
        const std::vector<Chunk> chunks = support::chunks_in(file);
        return std::any_of(chunks.begin(), chunks.end(),
                           [](const Chunk& one) { return one.type == chunk::depth_ranges; });
    };
    EXPECT_FALSE(has_ranges(write(support::rich_recording())));
    const Recording recording = ranges_and_a_blit();
    const auto file = write(recording);
    EXPECT_TRUE(has_ranges(file));
    const traces::Trace trace = traces::read_trace(file);
    EXPECT_EQ(trace.recording->states, recording.states);
    EXPECT_EQ(trace.recording->frames, recording.frames);
    EXPECT_EQ(support::bytes_in(write(*trace.recording, "y.rtrace")), support::bytes_in(file));
    const std::string text = dump(file);
    for (const char* line : {"\ndepth range 0: state=1 near=0.25 far=1\n", "\ndepth range 1: state=2 near=1 far=0\n",
                             "\nframe 0 command 2: kind=blit name=\"blit\" from surface=0 ",
                             " source x=-3 source y=2 source width=10 source height=12 ",
                             " mirrored x=yes mirrored y=no linear=yes scissor=yes scissor x=0 "})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\nin\n" << text;
}

TEST_F(RecordedLater, DepthRangesAreOfStatesThatThereAre) {
    std::vector<Chunk> chunks = support::chunks_in(write(ranges_and_a_blit()));
    const auto ranges =
        std::find_if(chunks.begin(), chunks.end(), [](const Chunk& one) { return one.type == chunk::depth_ranges; });
    ASSERT_NE(ranges, chunks.end());
    traces::rtrace::put_little<std::uint32_t>(&ranges->content[4], 3); // a count, a state
    EXPECT_NE(support::refusal_of(support::file_of(chunks)).find("depth range 0 state: expected"), std::string::npos)
        << support::refusal_of(support::file_of(chunks));
    traces::rtrace::put_little<std::uint32_t>(&ranges->content[4], 1);
    const Chunk first = *ranges;
    chunks.erase(ranges);
    chunks.insert(chunks.begin(), first); // before the states
    EXPECT_NE(support::refusal_of(support::file_of(chunks)).find("chunk DRNG"), std::string::npos)
        << support::refusal_of(support::file_of(chunks));
}

void expect_refused(const std::string& expected, void (*spoil)(traces::RecordedBlit&)) {
    Recording recording = ranges_and_a_blit();
    spoil(std::get<traces::RecordedBlit>(recording.frames[0].commands.back()));
    try {
        traces::check_recording(recording, "x");
        ADD_FAILURE() << "accepted: " << expected;
    } catch (const sim::InputError& error) {
        EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
}

TEST_F(RecordedLater, BlitsHaveBoundsAndFormats) {
    EXPECT_NO_THROW(traces::check_recording(ranges_and_a_blit(), "x"));
    expect_refused("rectangles of 1 to 65536 texels a side, at most 65536 away, got 10 x 0 at (-3, 2)",
                   [](traces::RecordedBlit& blit) { blit.source.height = 0; });
    expect_refused("got 65537 x 5 at (1, -4)", [](traces::RecordedBlit& blit) { blit.destination.width = 65537; });
    expect_refused("got 10 x 12 at (-65537, 2)", [](traces::RecordedBlit& blit) { blit.source.x = -65537; });
    expect_refused("colours to colours, or unfiltered depths to depths, got rgba8 to d24s8",
                   [](traces::RecordedBlit& blit) {
                       blit.to = {1, 0, 0};
                   });
    expect_refused("colours to colours, or unfiltered depths to depths, got d24s8 to d24s8",
                   [](traces::RecordedBlit& blit) {
                       blit.from = blit.to = {1, 0, 0};
                   });
    expect_refused("one of 3 levels, got 3", [](traces::RecordedBlit& blit) { blit.to.level = 3; });
}

} // namespace recording_later_test
