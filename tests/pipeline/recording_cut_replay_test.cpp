// Parts of recordings, replayed: which counters of a draw are those of the whole, and which may not be.
#include "tests/support/drawn_recording.hpp"
#include "traces/recording/cut.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace recording_cut_replay_test {

using namespace drawn_recording;
using pipeline::RunResult;
using tests::RecordedFrames;
using traces::CutRange;
using traces::Recording;
using Shade = RecordedFrames::Shade;

/// What follows from the draw alone: its vertices, its state, and what its shader discards.
constexpr std::array of_the_draw{
    "primitives", "vertices_referenced", "vertex_shader_runs", "culled", "degenerate", "clipped", "triangles", "quads",
    "fragments"};
/// And from what the surfaces held before.
constexpr std::array of_its_surfaces{"samples_passed"};

template <std::size_t size>
using Counters = std::array<std::uint64_t, size>;

/// Counters of the draws by name, of each pass that adds any.
template <std::size_t size>
std::map<std::string, std::vector<Counters<size>>> counted(const RunResult& run,
                                                           const std::array<const char*, size>& names) {
    std::map<std::string, std::vector<Counters<size>>> of_draws;
    for (const pipeline::PassDrawResult& part : run.pass_draws) {
        Counters<size> counters{};
        for (std::size_t i = 0; i < size; ++i) {
            const auto name = std::find(run.draw_counters.begin(), run.draw_counters.end(), names[i]);
            counters[i] = part.counters.at(static_cast<std::size_t>(name - run.draw_counters.begin()));
        }
        of_draws[run.draws.at(part.draw).name].push_back(counters);
    }
    return of_draws;
}

std::uint64_t total(const RunResult& run, const std::string& draw, const char* counter) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < run.draws.size(); ++i)
        if (run.draws[i].name == draw) sum += run.draw_counter(i, counter);
    return sum;
}

/// Frame 0 draws "map" to a texture and "early" to the window. Frame 1 has these draws, and a clear of a part of the
/// window behind the first two.
const std::vector<std::string> drawn{"near", "far", "glass", "leaf", "use", "back", "hidden", "late"};

Recording two_frames() {
    RecordedFrames frames(width, height);
    const auto rectangle = &RecordedFrames::rectangle;
    const std::uint32_t tested = frames.add_state(depth_tested());
    const std::uint32_t glass =
        frames.add_state(blended(BlendFactor::source_alpha, BlendFactor::one_minus_source_alpha, /*depth_test=*/true));
    RasterState back = depth_tested();
    back.culling = pipeline::FaceCulling::front;
    const std::uint32_t culled = frames.add_state(back);
    const std::uint32_t map = frames.add_texture_target(8, 8), bound = frames.bind(2);
    frames.clear(black, map);
    frames.draw(rectangle({-1, -1}, {0.5F, 1}, {0.5F, 1, 0, 1}, 0.5F), Shade::colour, 0, map).name = "map";
    frames.clear(blue);
    frames.draw(rectangle({-1, -1}, {0.3F, 1}, red, 0.1F), Shade::colour, tested).name = "early";

    frames.next_frame();
    frames.clear(blue);
    frames.draw(rectangle({-1, -1}, {0, 1}, red, 0.25F), Shade::colour, tested).name = "near";
    frames.draw(RecordedFrames::everything(green, 0.5F), Shade::colour, tested).name = "far";
    auto& part = frames.clear(black);
    part.name = "part";
    part.scissor = pipeline::PixelRectangle{2, 3, 9, 5};
    frames.draw(rectangle({-0.5F, -0.5F}, {1, 1}, {0, 0, 1, 0.5F}, 0.4F), Shade::colour, glass).name = "glass";
    auto& leaf = frames.draw(
        {{{{{-1, -1, -0.5F, 1}, {1, 0, 0, 0}}, {{3, -1, -0.5F, 1}, {1, 0, 0, 2}}, {{-1, 3, -0.5F, 1}, {1, 0, 0, 0}}}}},
        Shade::colour, tested);
    leaf.name = "leaf";
    leaf.alpha_test = pipeline::Compare::greater;
    leaf.alpha_reference = 0.5F;
    std::vector<RecordedFrames::Triangle> through_the_near_plane = rectangle({-1, 0}, {1, 1}, {0.2F, 0.2F, 0, 1}, 0.2F);
    for (auto& triangle : through_the_near_plane)
        for (auto& corner : triangle)
            if (corner.position.x > 0 && corner.position.y > 0) corner.position.z = -3;
    auto& use = frames.draw(through_the_near_plane, Shade::textured, tested);
    use.name = "use";
    use.bindings = bound;
    frames.draw(RecordedFrames::everything(red, 0), Shade::colour, culled).name = "back";
    frames.draw(rectangle({-1, -1}, {0.7F, 0.2F}, red, 0.9F), Shade::colour, tested).name = "hidden";
    frames.draw(rectangle({-0.1F, -1}, {0.7F, 0.2F}, {1, 1, 0, 0.25F}, 0.05F), Shade::colour, glass).name = "late";
    return frames.recording;
}

Recording frame_of(const Recording& recording, std::uint32_t number) {
    return traces::cut(recording, {CutRange{number, number + 1}, std::nullopt});
}
Recording draws_of(const Recording& recording, std::uint32_t first, std::uint32_t end) {
    return traces::cut(recording, {CutRange{1, 2}, CutRange{first, end}});
}

LowerOptions last_frame(const Recording& recording, bool kbuffer) {
    LowerOptions options;
    options.first_frame = options.last_frame = static_cast<std::uint32_t>(recording.frames.size() - 1);
    if (kbuffer) options.kbuffer = traces::KBufferChoice::of("blended", 2);
    return options;
}

RunResult replayed(const Recording& recording, const char* design = "existing", bool kbuffer = false) {
    return run(Drawn(recording, last_frame(recording, kbuffer)), design);
}

/// Of the draws with these names, which both have.
template <std::size_t size>
void expect_equal(const RunResult& part, const RunResult& whole, const std::array<const char*, size>& names,
                  std::span<const std::string> draws) {
    const auto of_part = counted(part, names), of_whole = counted(whole, names);
    for (const std::string& draw : draws) {
        SCOPED_TRACE(draw);
        ASSERT_TRUE(of_part.contains(draw) && of_whole.contains(draw));
        EXPECT_EQ(of_part.at(draw), of_whole.at(draw));
    }
}

// Whatever earlier frames did that this one sees comes with it.
TEST(RecordingCutReplay, AFrameHasItsCountersAndItsPicture) {
    const Recording whole = two_frames(), cut = frame_of(whole, 1);
    ASSERT_EQ(cut.frames.size(), 1U);
    std::vector<std::string> draws = drawn;
    draws.emplace_back("map"); // "use" reads it
    for (const bool kbuffer : {false, true})
        for (const char* design : {"existing", "scoreboard", "blender"}) {
            SCOPED_TRACE(design);
            const RunResult part = replayed(cut, design, kbuffer), all = replayed(whole, design, kbuffer);
            expect_equal(part, all, of_the_draw, draws);
            expect_equal(part, all, of_its_surfaces, draws);
            EXPECT_EQ(total(part, "early", "fragments"), 0U);
            EXPECT_EQ(total(all, "early", "fragments"), 0U); // of frames before only what is kept
            ASSERT_FALSE(all.colour.empty());
            if (!kbuffer || std::string_view(design) != "existing") { // which has hazards there
                EXPECT_EQ(part.colour, all.colour);
            }
        }
    // The frame has something of everything that is compared.
    const RunResult all = replayed(whole);
    EXPECT_LT(total(all, "hidden", "samples_passed"), total(all, "hidden", "fragments"));
    EXPECT_EQ(total(all, "leaf", "fragments"), width * height / 2);
    EXPECT_EQ(total(all, "back", "culled"), 2U);
    EXPECT_GT(total(all, "use", "clipped"), 0U);
}

// What lies before a draw is all there, so depths are, too.
TEST(RecordingCutReplay, FirstDrawsHaveTheirCounters) {
    const Recording whole = two_frames();
    const std::span<const std::string> names(drawn);
    for (const bool kbuffer : {false, true}) {
        const RunResult all = replayed(whole, "scoreboard", kbuffer);
        for (std::uint32_t end = kbuffer ? 3 : 1; end <= drawn.size(); ++end) { // up to a blended draw at least
            SCOPED_TRACE(end);
            const RunResult part = replayed(draws_of(whole, 0, end), "scoreboard", kbuffer);
            expect_equal(part, all, of_the_draw, names.first(end));
            expect_equal(part, all, of_its_surfaces, names.first(end));
            for (const std::string& later : names.subspan(end)) EXPECT_EQ(total(part, later, "primitives"), 0U);
        }
    }
}

// Draws that are left out have left no depths, so that more samples pass; nothing else of a draw tells.
TEST(RecordingCutReplay, LaterDrawsDifferInWhatEarlierOnesWouldHaveHidden) {
    const Recording whole = two_frames();
    const RunResult all = replayed(whole);
    const std::span<const std::string> names(drawn);
    for (std::uint32_t first = 1; first < drawn.size(); ++first) {
        SCOPED_TRACE(first);
        const auto rest = names.subspan(first);
        const RunResult part = replayed(draws_of(whole, first, static_cast<std::uint32_t>(drawn.size())));
        expect_equal(part, all, of_the_draw, rest);
        for (const std::string& draw : rest)
            EXPECT_GE(total(part, draw, "samples_passed"), total(all, draw, "samples_passed")) << draw;
        EXPECT_EQ(total(part, rest.front(), "samples_passed"), total(part, rest.front(), "fragments"));
    }
    EXPECT_LT(total(all, "far", "samples_passed"), total(all, "far", "fragments"));
}

// What was fetched for a draw that is left out is not in the caches.
TEST(RecordingCutReplay, CachesAreColdWhereACutBegins) {
    RecordedFrames frames(width, height);
    frames.add_texture(8, 8, std::vector<std::uint32_t>(64, 0x336699FFU));
    std::vector<RecordedFrames::Triangle> whole = RecordedFrames::everything(black);
    for (auto& triangle : whole)
        for (auto& corner : triangle) corner.colour = {(corner.position.x + 1) / 2, (corner.position.y + 1) / 2, 0, 1};
    for (const char* name : {"first", "second"}) {
        traces::RecordedDraw& draw = frames.draw(whole, Shade::textured);
        draw.name = name;
        draw.bindings = frames.bind(2);
    }
    const RunResult all = replayed(frames.recording),
                    part = replayed(traces::cut(frames.recording, {std::nullopt, CutRange{1, 2}}));
    const std::array<std::string, 1> second{"second"};
    expect_equal(part, all, of_the_draw, second);
    expect_equal(part, all, of_its_surfaces, second);
    EXPECT_GT(total(part, "second", "dram_texture_bytes"), total(all, "second", "dram_texture_bytes"));
    EXPECT_LT(total(part, "second", "first_cycle"), total(all, "second", "first_cycle"));
}

} // namespace recording_cut_replay_test
