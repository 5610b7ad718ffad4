// Replays of recorded programs beside Mesa's replay of the same (tests/replay_oracle): counters, positions, pictures.
#include "sim/check.hpp"
#include "tests/replay_oracle/comparison.hpp"
#include "tests/replay_oracle/own_replay.hpp"
#include "tests/replay_oracle/programs.hpp"
#include "tests/support/drawn_recording.hpp"
#include "tests/support/paths.hpp"
#include "traces/glsl.hpp"
#include "traces/recording/running_program.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>
#include <iterator>
#include <sstream>
#include <thread>

namespace replay_oracle {

void PrintTo(const DebianProgram& program, std::ostream* stream) { *stream << program.name; }

} // namespace replay_oracle

namespace replayed_programs_test {

using replay_oracle::Comparison;
using replay_oracle::OwnFrame;
using replay_oracle::Picture;

namespace {

/// Runs `work`; returns why it is to be skipped, or nothing.
std::string reason_to_skip(const std::function<void()>& work) {
    if (!traces::can_compile_glsl()) return "built without glslang (packages glslang-dev and spirv-tools)";
    if (!std::filesystem::exists(replay_oracle::measuring_library())) return "built without what measures in glretrace";
    try {
        const replay_oracle::SoftwareGraphics graphics;
        work();
    } catch (const sim::InputError& error) {
        if (std::string(error.what()).find("which was not found: Debian package") == std::string::npos) throw;
        return error.what();
    }
    return {};
}

void expect_no_fault(const Comparison& comparison) {
    std::cout << replay_oracle::table_of({comparison});
    EXPECT_EQ(replay_oracle::faults_of({comparison}), std::vector<std::string>{});
}

std::string content_of(const std::filesystem::path& file) {
    std::ostringstream content;
    content << std::ifstream(file, std::ios::binary).rdbuf();
    return content.str();
}

/// What a shell command writes.
std::string output_of(const std::string& command) {
    const replay_oracle::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "output";
    traces::RunningProgram program({"sh", "-c", command + " >" + file.string() + " 2>/dev/null"}, {});
    while (!program.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return content_of(file);
}

/// Samples of each draw as glretrace says: column 11 of its lines.
std::vector<std::int64_t> profiled_samples(const std::filesystem::path& trace) {
    std::istringstream lines(output_of("glretrace -b --ppd " + trace.string()));
    std::vector<std::int64_t> samples;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream columns(line);
        const std::vector<std::string> words{std::istream_iterator<std::string>(columns), {}};
        if (words.size() > 11 && words[0] == "call" && words.back().starts_with("glDraw"))
            samples.push_back(std::stoll(words[10]));
    }
    return samples;
}

/// Pictures of the frames as glretrace takes them: binary PPM, one behind the other.
std::vector<Picture> snapshots(const std::filesystem::path& trace) {
    const std::string output = output_of("glretrace -b -s - -S frame " + trace.string());
    std::vector<Picture> pictures;
    std::size_t at = 0;
    while (output.compare(at, 2, "P6") == 0) {
        std::array<std::uint32_t, 3> numbers{}; // width, height, largest code
        at += 2;
        for (std::uint32_t& number : numbers) {
            while (std::isspace(static_cast<unsigned char>(output.at(at))) != 0 || output[at] == '#')
                at = output[at] == '#' ? output.find('\n', at) : at + 1;
            number = static_cast<std::uint32_t>(std::stoul(output.substr(at, 8)));
            at = output.find_first_of(" \n", at);
        }
        ++at;
        Picture& picture = pictures.emplace_back(Picture{numbers[0], numbers[1], {}});
        for (std::size_t i = 0; i < std::size_t{numbers[0]} * numbers[1]; ++i, at += 3) {
            for (std::size_t c = 0; c < 3; ++c) picture.rgba.push_back(static_cast<std::uint8_t>(output.at(at + c)));
            picture.rgba.push_back(255);
        }
    }
    return pictures;
}

} // namespace

TEST(ReplayedPrograms, LongBunnyIsAsMesaReplaysIt) {
    const auto trace = ropsim_test::shared_file("traces/bunny_glmark2_3frames.trace");
    if (!trace) GTEST_SKIP() << "no bunny_glmark2_3frames.trace";
    const std::string reason = reason_to_skip([&] {
        const Comparison bunny = replay_oracle::compare("bunny", *trace, {});
        expect_no_fault(bunny);
        EXPECT_EQ(bunny.frames, 3U);
        EXPECT_EQ(bunny.agreement.all(), 3U);
        EXPECT_EQ(bunny.of_draws.count, 3U);
        EXPECT_EQ(bunny.positions, 3U * 21516U);
        EXPECT_EQ(bunny.samples.mesa, 111'972U);
    });
    if (!reason.empty()) GTEST_SKIP() << reason;
}

TEST(ReplayedPrograms, LongIdeasIsAsMesaReplaysIt) {
    const auto trace = ropsim_test::shared_file("traces/ideas_glmark2_2frames.trace");
    if (!trace) GTEST_SKIP() << "no ideas_glmark2_2frames.trace";
    const std::string reason = reason_to_skip([&] {
        const Comparison ideas = replay_oracle::compare("ideas", *trace, {});
        expect_no_fault(ideas);
        EXPECT_EQ(ideas.frames, 2U);
        EXPECT_EQ(ideas.agreement.all(), 360U);
        EXPECT_EQ(ideas.of_draws.count, 72U); // one of five
        EXPECT_EQ(ideas.positions, 2U * 3370U);
        EXPECT_EQ(ideas.samples.mesa, 192'746U);
    });
    if (!reason.empty()) GTEST_SKIP() << reason;
}

// What is measured within glretrace is what glretrace says and shows of itself.
TEST(ReplayedPrograms, LongMeasuringLeavesMesasReplayAsItIs) {
    const auto trace = ropsim_test::shared_file("traces/bunny_glmark2_3frames.trace");
    if (!trace) GTEST_SKIP() << "no bunny_glmark2_3frames.trace";
    const std::string reason = reason_to_skip([&] {
        replay_oracle::MesaRequest request;
        request.trace = *trace;
        request.strides = {1, 1, 1};
        request.isotropic = false;
        const std::vector<replay_oracle::MesaFrame> frames = replay_oracle::replay_by_mesa(request);
        const std::vector<Picture> pictures = snapshots(*trace);
        std::vector<std::int64_t> samples;
        ASSERT_EQ(pictures.size(), frames.size());
        for (std::size_t i = 0; i < frames.size(); ++i) {
            for (const replay_oracle::MesaCall& call : frames[i].calls) samples.push_back(call.samples);
            ASSERT_TRUE(frames[i].shown.has_value());
            EXPECT_EQ(replay_oracle::share_within(*frames[i].shown, pictures[i], 0), 1.0) << i;
        }
        EXPECT_EQ(samples, profiled_samples(*trace));
    });
    if (!reason.empty()) GTEST_SKIP() << reason;
}

class LongDebianPrograms : public ::testing::TestWithParam<replay_oracle::DebianProgram> {};

TEST_P(LongDebianPrograms, AreAsMesaReplaysThem) {
    const replay_oracle::DebianProgram& program = GetParam();
    if (!replay_oracle::is_installed(program)) GTEST_SKIP() << "Debian package " << program.package;
    const std::string reason = reason_to_skip([&] {
        const replay_oracle::TemporaryFolder folder;
        const std::filesystem::path trace = folder.path() / "program.trace";
        replay_oracle::trace_program(program, trace);
        replay_oracle::ComparisonOptions options;
        options.first = program.first;
        options.end = program.end;
        const Comparison comparison = replay_oracle::compare(program.name, trace, options);
        expect_no_fault(comparison);
        EXPECT_EQ(comparison.frames, program.end - program.first);
        EXPECT_GT(comparison.draws.own, 0U);
    });
    if (!reason.empty()) GTEST_SKIP() << reason;
}

INSTANTIATE_TEST_SUITE_P(Programs, LongDebianPrograms, ::testing::ValuesIn(replay_oracle::debian_programs()),
                         [](const auto& program) { return program.param.name; });

namespace {

using drawn_recording::black;
using drawn_recording::green;
using drawn_recording::height;
using drawn_recording::red;
using drawn_recording::width;
using tests::RecordedFrames;

glm::vec4 pixel_of(const Picture& picture, std::uint32_t x, std::uint32_t row) {
    const std::uint8_t* const rgba = &picture.rgba.at((std::size_t{row} * picture.width + x) * 4);
    return glm::vec4(rgba[0], rgba[1], rgba[2], rgba[3]) / 255.0F;
}

/// Red all over, behind it green in the upper half, then green before it there.
RecordedFrames layered() {
    RecordedFrames frames(width, height);
    const std::uint32_t state = frames.add_state(drawn_recording::depth_tested());
    frames.clear(black);
    frames.draw(RecordedFrames::everything(red, 0.5F), RecordedFrames::Shade::colour, state);
    frames.draw(RecordedFrames::rectangle({-1, 0}, {1, 1}, green, 0.75F), RecordedFrames::Shade::colour, state);
    frames.draw(RecordedFrames::rectangle({-1, 0}, {1, 1}, green, 0.25F), RecordedFrames::Shade::colour, state);
    return frames;
}

} // namespace

TEST(OwnReplay, EachDrawHasItsSamplesAndThePictureBehindIt) {
    const RecordedFrames frames = layered();
    OwnFrame own(frames.recording, 0);
    ASSERT_EQ(own.draws(), 3U);
    EXPECT_EQ(own.execute(0), width * height);
    EXPECT_EQ(pixel_of(*own.picture(), 3, 2), red);
    EXPECT_EQ(own.execute(1), 0U);
    EXPECT_EQ(pixel_of(*own.picture(), 3, 2), red);
    EXPECT_EQ(own.execute(2), width * height / 2);
    EXPECT_EQ(pixel_of(*own.picture(), 3, 2), green);
    EXPECT_EQ(pixel_of(*own.picture(), 3, height - 1), red);
    EXPECT_EQ(replay_oracle::share_within(own.shown(), *own.picture(), 0), 1.0);
    EXPECT_EQ(own.vertices(2), 6U);
    EXPECT_EQ(own.primitives(2), 2U);
    EXPECT_EQ(own.positions(2).at(1), glm::vec4(1, 0, -0.5F, 1));
}

TEST(OwnReplay, DrawByDrawGivesThePictureOfTheWholeFrame) {
    const RecordedFrames frames = layered();
    const drawn_recording::Drawn whole(frames.recording);
    OwnFrame own(frames.recording, 0);
    const Picture shown = own.shown();
    for (std::uint32_t row = 0; row < height; ++row)
        for (std::uint32_t x = 0; x < width; ++x)
            EXPECT_EQ(pixel_of(shown, x, row), whole.at(x, row)) << x << "," << row;
}

// What reaches beyond the sides covers the same pixels, clipped there or not.
TEST(OwnReplay, ClippingAtTheSidesKeepsWhatIsInside) {
    RecordedFrames frames(width, height);
    frames.clear(black);
    frames.draw(RecordedFrames::rectangle({-3, -0.5F}, {0, 2}, red));
    OwnFrame own(frames.recording, 0);
    EXPECT_EQ(own.execute(0), width / 2 * (height * 3 / 4));
    EXPECT_EQ(own.samples_clipped_at_sides(), width / 2 * (height * 3 / 4));
    EXPECT_EQ(pixel_of(*own.picture(), 0, 0), red);
    EXPECT_EQ(pixel_of(*own.picture(), width / 2, 0), black);
}

TEST(ReplayPictures, AgreeInThePixelsWhoseChannelsAllDo) {
    const Picture a{2, 1, {0, 0, 0, 0, 100, 100, 100, 255}};
    Picture b = a;
    EXPECT_EQ(replay_oracle::share_within(a, b, 0), 1.0);
    b.rgba[7] = 247;
    EXPECT_EQ(replay_oracle::share_within(a, b, 8), 1.0);
    EXPECT_EQ(replay_oracle::share_within(a, b, 7), 0.5);
    EXPECT_EQ(replay_oracle::share_within(a, {1, 2, a.rgba}, 8), 0.0);
}

TEST(ReplayFaults, FewCallsMayAgreeOnlyWhenClippedAlike) {
    Comparison one;
    one.agreement.equal = 98;
    one.agreement.clipped = 2;
    EXPECT_TRUE(replay_oracle::faults_of({one}).empty());
    one.agreement.clipped = 3;
    EXPECT_EQ(replay_oracle::faults_of({one}).size(), 1U);
}

} // namespace replayed_programs_test
