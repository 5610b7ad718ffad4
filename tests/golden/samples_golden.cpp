// Recorded frames of real programs (traces/samples): what they draw, in numbers kept in the tree, and what happens when
// their blended draws go through a k-buffer instead.
//
// When a change is meant: ROPSIM_UPDATE_GOLDEN=1 build/release/bin/golden_tests, then look at the difference.
#include "reports/comparison.hpp"
#include "reports/trace_info.hpp"
#include "sim/described.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/replay.hpp"
#include "traces/trace_text.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace samples_golden {

namespace fs = std::filesystem;

std::vector<std::string> samples() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(ropsim_test::source_dir() / "traces/samples"))
        if (entry.path().extension() == ".rtrace") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

fs::path file_of(const std::string& sample) {
    return ropsim_test::source_dir() / "traces/samples" / (sample + ".rtrace");
}

reports::Comparison replay(const std::string& sample, const std::string& kbuffer, std::vector<std::string> designs) {
    reports::ComparisonRequest request;
    request.scene = file_of(sample).string();
    request.replay = true;
    request.replayed.kbuffer = kbuffer;
    request.replayed.k = 8;
    request.designs = std::move(designs);
    return reports::compare(reports::prepare(request));
}

/// The picture's mean red, green or blue, as a screen takes it, 0 to 255: tenths are what a change of rounding spares.
std::string mean(const std::vector<float>& rgba, std::size_t channel) {
    double sum = 0;
    for (std::size_t i = channel; i < rgba.size(); i += 4) sum += rgba[i];
    return fmt::format("{:.1f}", 4 * 255 * sum / static_cast<double>(std::max<std::size_t>(4, rgba.size())));
}

std::vector<std::string> row_of(const std::string& sample) {
    const auto info = reports::trace_info(file_of(sample));
    const reports::Comparison frame = replay(sample, "", {"blender"});
    EXPECT_EQ(frame.runs[0].wrong_pixels, 0U) << sample;
    std::vector<std::string> cells{sample, fmt::format("{}x{}", frame.width(), frame.height())};
    for (const std::uint64_t number : {info["draws"].get<std::uint64_t>(), info["vertices"].get<std::uint64_t>(),
                                       info["primitives"].get<std::uint64_t>(), frame.runs[0].fragments})
        cells.push_back(std::to_string(number));
    for (std::size_t channel = 0; channel < 3; ++channel) cells.push_back(mean(frame.reference.composite, channel));
    return cells;
}

TEST(SamplesGolden, NumbersAreThoseKeptInTheTree) {
    std::string now =
        sim::csv_line({"sample", "size", "draws", "vertices", "primitives", "fragments", "red", "green", "blue"});
    for (const std::string& sample : samples()) now += sim::csv_line(row_of(sample));
    const auto file = ropsim_test::source_dir() / "tests/golden/samples.csv";
    if (std::getenv("ROPSIM_UPDATE_GOLDEN") != nullptr) ropsim_test::write_text(file, now);
    EXPECT_EQ(now, ropsim_test::file_text(file));
}

TEST(SamplesGolden, FilesAreWholeSmallAndSayTheirLicence) {
    std::uintmax_t bytes = 0;
    for (const std::string& sample : samples()) {
        EXPECT_EQ(traces::trace_faults(file_of(sample)), std::vector<std::string>());
        const auto info = reports::trace_info(file_of(sample));
        EXPECT_NE(info["licence"], "") << sample;
        EXPECT_EQ(info["name"], sample);
        EXPECT_EQ(info["frames"].size(), 1U) << sample;
        EXPECT_TRUE(info["not_recorded"].empty()) << sample << ": " << info["not_recorded"];
        bytes += fs::file_size(file_of(sample));
    }
    EXPECT_LE(bytes, 4'000'000U);
}

struct Blended {
    std::string sample;
    bool hazards =
        false; ///< of unprotected hardware: a pixel gets its next layer before the one before has been stored
};

class SamplesKBufferLong : public ::testing::TestWithParam<Blended> {};

TEST_P(SamplesKBufferLong, ProtectedDesignsDrawTheReference) {
    const auto& [sample, hazards] = GetParam();
    const reports::Comparison frame = replay(sample, "blended", {"existing", "scoreboard", "blender"});
    for (const pipeline::RunResult& run : frame.runs) {
        if (support::protects(run.design)) {
            EXPECT_EQ(run.hazards.total(), 0U) << run.design;
            EXPECT_EQ(run.wrong_pixels, 0U) << run.design;
        } else {
            EXPECT_EQ(run.hazards.total() > 0, hazards) << run.design;
        }
        EXPECT_EQ(run.unexplained_pixels(), 0U) << run.design;
        EXPECT_EQ(run.fragments, frame.runs[0].fragments) << run.design;
    }
}

INSTANTIATE_TEST_SUITE_P(Frames, SamplesKBufferLong,
                         ::testing::Values(Blended{"neverball", true}, Blended{"glmark2-jellyfish", true},
                                           Blended{"glmark2-desktop", true}),
                         [](const auto& one) {
                             std::string name = one.param.sample;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

} // namespace samples_golden
