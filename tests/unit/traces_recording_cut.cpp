// Parts of recordings: what stays, what goes, and that what stays says the same under other numbers.
#include "sim/check.hpp"
#include "tests/support/recordings.hpp"
#include "traces/recording/cut.hpp"
#include "traces/recording/recording_check.hpp"

#include <gtest/gtest.h>

namespace recording_cut_test {

using traces::Cut;
using traces::CutRange;
using traces::RecordedClear;
using traces::RecordedCopy;
using traces::RecordedDraw;
using traces::Recording;

std::vector<std::string> names_of(const traces::RecordedFrame& frame) {
    std::vector<std::string> names;
    for (const traces::RecordedCommand& command : frame.commands)
        names.push_back(std::visit([](const auto& one) { return one.name; }, command));
    return names;
}

/// Three frames (4, 5, 6): in the first one "map" is drawn to a texture, which "use" of the last one samples.
class RecordingCut : public ::testing::Test {
  protected:
    RecordingCut() {
        recording_ = support::quad_recording();
        traces::RecordedSurface map = recording_.surfaces[0];
        map.name = "map";
        recording_.surfaces.push_back(map);
        traces::TargetSet to_map = recording_.targets[0];
        to_map.colours[0]->surface = 3;
        to_map.depth.reset();
        recording_.targets.push_back(to_map);
        recording_.bindings.push_back({{"image", 0, 3, 0}});
        clear_ = std::get<RecordedClear>(recording_.frames[0].commands[0]);
        draw_ = std::get<RecordedDraw>(recording_.frames[0].commands[1]);
        recording_.frames = {{4, 0, {map_clear(), draw("map", 1, 0), clear_, draw("seen", 0, 0)}},
                             {5, 0, {clear_, draw("one", 0, 0), draw("two", 0, 0)}},
                             {6, 0, {clear_, draw("a", 0, 0), draw("use", 0, 1), draw("c", 0, 0), clear_}}};
        traces::check_recording(recording_, "x");
    }

    RecordedDraw draw(const std::string& name, std::uint32_t targets, std::uint32_t bindings) const {
        RecordedDraw draw = draw_;
        draw.name = name;
        draw.targets = targets;
        draw.bindings = bindings;
        return draw;
    }
    RecordedClear map_clear() const {
        RecordedClear clear = clear_;
        clear.name = "clear map";
        clear.targets = 1;
        clear.depth.reset();
        clear.stencil.reset();
        return clear;
    }
    Recording frames(std::uint32_t first, std::uint32_t end) const {
        return good({CutRange{first, end}, std::nullopt});
    }
    Recording good(const Cut& what) const {
        Recording result = traces::cut(recording_, what);
        traces::check_recording(result, "x");
        return result;
    }
    std::string refusal(const Cut& what) const {
        try {
            traces::cut(recording_, what);
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return "";
    }

    Recording recording_;
    RecordedClear clear_;
    RecordedDraw draw_;
};

using Names = std::vector<std::string>;

TEST_F(RecordingCut, FramesStandAloneWhenTheyClearWhatTheyDrawTo) {
    const Recording middle = frames(5, 6);
    ASSERT_EQ(middle.frames.size(), 1U);
    EXPECT_EQ(middle.frames[0].number, 5U);
    EXPECT_EQ(names_of(middle.frames[0]), (Names{"all", "one", "two"}));
    EXPECT_EQ(middle.surfaces.size(), 3U); // without the map
    EXPECT_EQ(middle.bindings.size(), 1U);
    EXPECT_EQ(middle.targets.size(), 1U);
    EXPECT_EQ(middle.surfaces[2], recording_.surfaces[2]);
    EXPECT_EQ(frames(0, 100).frames, recording_.frames);
    EXPECT_EQ(frames(5, 7).frames.size(), 2U);
}

TEST_F(RecordingCut, WhatEarlierFramesDrewToATextureStays) {
    const Recording last = frames(6, 7);
    EXPECT_EQ(names_of(last.frames.at(0)), (Names{"clear map", "map", "all", "a", "use", "c", "all"}));
    EXPECT_EQ(last.surfaces.size(), 4U);
    EXPECT_EQ(names_of(frames(5, 7).frames.at(0)), (Names{"clear map", "map", "all", "one", "two"}));
}

TEST_F(RecordingCut, AClearOfPartsDoesNotSetAll) {
    const auto with = [&](void (*change)(RecordedClear&)) {
        change(std::get<RecordedClear>(recording_.frames[2].commands[0]));
        return names_of(frames(6, 7).frames.at(0)).size();
    };
    EXPECT_EQ(with([](RecordedClear&) {}), 2U + 5U);
    // The window of both earlier frames stays: the clear of frame 5 sets it, so that frame 4 does not matter.
    EXPECT_EQ(with([](RecordedClear& one) { one.scissor = pipeline::PixelRectangle{0, 0, 16, 11}; }), 2U + 3U + 5U);
    EXPECT_EQ(with([](RecordedClear& one) { one.scissor = pipeline::PixelRectangle{-1, 0, 17, 12}; }), 2U + 5U);
    EXPECT_EQ(with([](RecordedClear& one) { one.write_mask[0] = 7; }), 2U + 3U + 5U);
    EXPECT_EQ(with([](RecordedClear& one) {
                  one.write_mask[0] = 15;
                  one.stencil_mask = 0x7F;
              }),
              2U + 3U + 5U);
    EXPECT_EQ(with([](RecordedClear& one) {
                  one.stencil_mask = 0xFF;
                  one.depth.reset();
              }),
              2U + 3U + 5U);
}

TEST_F(RecordingCut, AWindowWithoutAlphaIsSetByAClearOfThreeChannels) {
    recording_.states[0].write_mask[0] = 7;
    for (traces::RecordedFrame& frame : recording_.frames)
        for (traces::RecordedCommand& command : frame.commands)
            if (auto* const clear = std::get_if<RecordedClear>(&command)) clear->write_mask[0] = 7;
    EXPECT_EQ(names_of(frames(6, 7).frames.at(0)), (Names{"clear map", "map", "all", "a", "use", "c", "all"}));
    recording_.states[0].write_mask[0] = 8;
    EXPECT_EQ(names_of(frames(6, 7).frames.at(0)).size(), 4U + 3U + 5U); // all of the frames before
}

TEST_F(RecordingCut, ContentsThatAreSetFirstAreForgotten) {
    for (std::size_t surface : {0U, 1U})
        recording_.surfaces[surface].levels[0] = std::vector(std::size_t{16} * 12 * 4, std::byte{0x55});
    const auto window = [&] { return frames(5, 6).surfaces.at(0).levels.at(0); };
    EXPECT_TRUE(window().empty());
    EXPECT_TRUE(frames(5, 6).surfaces.at(1).levels.at(0).empty());
    EXPECT_EQ(frames(5, 6).surfaces.at(2), recording_.surfaces[2]); // nobody writes it
    // What nothing writes keeps its value.
    recording_.states[0].write_mask[0] = 7;
    for (traces::RecordedFrame& frame : recording_.frames)
        for (traces::RecordedCommand& command : frame.commands)
            if (auto* const clear = std::get_if<RecordedClear>(&command)) clear->write_mask[0] = 7;
    ASSERT_EQ(window().size(), std::size_t{16} * 12 * 4);
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(window()[i], std::byte{static_cast<unsigned char>(i % 4 == 3 ? 0x55 : 0)}) << i;
    // A part that stays unset is seen.
    for (traces::RecordedFrame& frame : recording_.frames)
        std::get<RecordedClear>(frame.commands[frame.number == 4 ? 2 : 0]).scissor =
            pipeline::PixelRectangle{0, 0, 16, 11};
    EXPECT_EQ(window(), recording_.surfaces[0].levels[0]);
    EXPECT_EQ(frames(5, 6).surfaces.at(1), recording_.surfaces[1]);
}

TEST_F(RecordingCut, CopiesCarryOnWhatTheyRead) {
    RecordedCopy copy{"copy", {0, 0, 0}, {3, 0, 0}, {0, 0, 16, 12}, 0, 0};
    recording_.frames[1].commands.emplace_back(copy);
    // The whole map is copied from the window of frame 5, so nobody needs what frame 4 drew.
    EXPECT_EQ(names_of(frames(6, 7).frames.at(0)), (Names{"all", "one", "two", "copy", "all", "a", "use", "c", "all"}));
    std::get<RecordedCopy>(recording_.frames[1].commands.back()).rectangle.width = 15;
    EXPECT_EQ(names_of(frames(6, 7).frames.at(0)),
              (Names{"clear map", "map", "all", "one", "two", "copy", "all", "a", "use", "c", "all"}));
}

TEST_F(RecordingCut, BlitsOfTheWholeSetItWhole) {
    traces::RecordedBlit blit;
    blit.name = "blit";
    blit.to = {3, 0, 0};
    blit.source = {0, 0, 8, 6};
    blit.destination = {0, 0, 16, 12};
    const auto kept = [&] {
        recording_.frames[1].commands.emplace_back(blit);
        const Names names = names_of(frames(6, 7).frames.at(0));
        recording_.frames[1].commands.pop_back();
        return names.size();
    };
    constexpr std::size_t of_the_map = 2; // what frame 4 did with it
    const std::size_t whole = kept();
    EXPECT_EQ(whole, 4U + 5U);
    blit.scissor = pipeline::PixelRectangle{0, 0, 16, 11};
    EXPECT_EQ(kept(), whole + of_the_map);
    blit.scissor.reset();
    blit.source.x = -1;
    EXPECT_EQ(kept(), whole + of_the_map);
    blit.source.x = 0;
    blit.destination.width = 15;
    EXPECT_EQ(kept(), whole + of_the_map);
}

TEST_F(RecordingCut, DrawsOfAFrame) {
    const auto draws = [&](std::uint32_t first, std::uint32_t end) {
        return names_of(good({CutRange{6, 7}, CutRange{first, end}}).frames.at(0));
    };
    EXPECT_EQ(draws(0, 1), (Names{"all", "a"}));
    EXPECT_EQ(draws(2, 3), (Names{"all", "c"}));
    EXPECT_EQ(draws(0, 3), (Names{"clear map", "map", "all", "a", "use", "c"}));
    const Recording only_map = good({CutRange{4, 5}, CutRange{0, 1}});
    EXPECT_EQ(names_of(only_map.frames[0]), (Names{"clear map", "map"}));
    // What it shows is what is drawn to.
    const auto& shown = only_map.targets.at(only_map.frames[0].shown);
    EXPECT_EQ(only_map.surfaces.at(shown.colours.at(0)->surface).name, "map");
}

TEST_F(RecordingCut, RangesThatAreNotThereAreRefused) {
    EXPECT_EQ(refusal({CutRange{7, 9}, std::nullopt}), "expected frames within 4:7, at least one, got 7:9");
    EXPECT_EQ(refusal({CutRange{6, 5}, std::nullopt}), "expected frames within 4:7, at least one, got 6:5");
    EXPECT_EQ(refusal({CutRange{5, 7}, CutRange{0, 1}}), "expected draws of one frame, got a range of 2 frames");
    EXPECT_EQ(refusal({std::nullopt, CutRange{0, 1}}), "expected draws of one frame, got a range of 3 frames");
    EXPECT_EQ(refusal({CutRange{6, 7}, CutRange{0, 4}}), "expected draws within 0:3 of frame 6, at least one, got 0:4");
    EXPECT_EQ(refusal({CutRange{6, 7}, CutRange{2, 2}}), "expected draws within 0:3 of frame 6, at least one, got 2:2");
}

TEST(RecordingCompact, WhatIsUsedSaysTheSame) {
    const Recording all = support::rich_recording();
    const Recording used = traces::compact(all);
    traces::check_recording(used, "x");
    // Every draw by what its numbers name.
    ASSERT_EQ(used.frames.size(), all.frames.size());
    for (std::size_t i = 0; i < all.frames.size(); ++i) {
        ASSERT_EQ(names_of(used.frames[i]), names_of(all.frames[i]));
        for (std::size_t k = 0; k < all.frames[i].commands.size(); ++k) {
            const auto* const one = std::get_if<RecordedDraw>(&all.frames[i].commands[k]);
            if (one == nullptr) continue;
            const auto& two = std::get<RecordedDraw>(used.frames[i].commands[k]);
            EXPECT_EQ(all.states.at(one->state), used.states.at(two.state));
            EXPECT_EQ(all.programs.at(one->program), used.programs.at(two.program));
            EXPECT_EQ(all.values.at(one->vertex_values), used.values.at(two.vertex_values));
            EXPECT_EQ(all.values.at(one->fragment_values), used.values.at(two.fragment_values));
            const auto &a = all.resources->geometries.at(one->geometry),
                       &b = used.resources->geometries.at(two.geometry);
            EXPECT_EQ(a.name, b.name);
            for (std::size_t n = 0; n < a.attributes.size(); ++n)
                EXPECT_EQ(all.resources->buffers.at(a.attributes[n].buffer).name,
                          used.resources->buffers.at(b.attributes[n].buffer).name);
            const auto &sky = all.bindings.at(one->bindings), &still = used.bindings.at(two.bindings);
            ASSERT_EQ(sky.size(), still.size());
            for (std::size_t n = 0; n < sky.size(); ++n) {
                EXPECT_EQ(all.surfaces.at(sky[n].surface), used.surfaces.at(still[n].surface));
                EXPECT_EQ(all.samplers.at(sky[n].sampler), used.samplers.at(still[n].sampler));
            }
        }
    }
    // Of all surfaces: window, depth, image, shadow, cube, and the layers that are copied to.
    EXPECT_EQ(used.surfaces.size(), 6U);
    EXPECT_EQ(used.samplers.size(), 3U);
    EXPECT_EQ(used.not_recorded, all.not_recorded);
}

TEST(RecordingCompact, IsTheSameWhenDoneAgainAndLeavesItsSourceAlone) {
    const Recording all = support::rich_recording();
    const Recording once = traces::compact(all), twice = traces::compact(once);
    EXPECT_EQ(once.frames, twice.frames);
    EXPECT_EQ(once.surfaces, twice.surfaces);
    EXPECT_EQ(once.resources->buffers.size(), twice.resources->buffers.size());
    EXPECT_EQ(all.frames, support::rich_recording().frames);
    EXPECT_EQ(all.resources->buffers.size(), support::rich_recording().resources->buffers.size());
}

TEST(RecordingCompact, ClearsLoseWhatIsNotThere) {
    Recording recording = support::quad_recording();
    RecordedClear clear = std::get<RecordedClear>(recording.frames[0].commands[0]);
    recording.targets[0].depth.reset();
    clear.colours = 0xFF;
    recording.frames[0].commands[0] = clear;
    clear.colours = 0xFE;
    recording.frames[0].commands.emplace_back(clear);
    recording = traces::compact(std::move(recording));
    traces::check_recording(recording, "x");
    ASSERT_EQ(recording.frames[0].commands.size(), 2U);
    const auto& left = std::get<RecordedClear>(recording.frames[0].commands[0]);
    EXPECT_EQ(left.colours, 1U);
    EXPECT_FALSE(left.depth || left.stencil);
}

} // namespace recording_cut_test
