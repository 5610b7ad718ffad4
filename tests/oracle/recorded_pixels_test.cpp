// Recorded frames of tests/programs/draws_with_opengl.cpp, drawn by the reference, beside the pixels that Mesa's
// llvmpipe drew.
#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/reference.hpp"
#include "sim/check.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"
#include "traces/glsl.hpp"
#include "traces/recording/lower.hpp"
#include "traces/recording/record_program.hpp"

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <optional>

namespace recorded_pixels_test {

constexpr std::uint32_t width = 64, height = 48;
using Pixels = std::vector<unsigned char>; ///< RGBA, rows from the bottom

struct RecordedFrame {
    Pixels ours, mesas;
};

class RecordedPixels : public ::testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        program_ = ropsim_test::program().parent_path() / "draws_with_opengl";
        if (!std::filesystem::exists(program_))
            GTEST_SKIP() << "built without EGL (packages libegl-dev, libopengl-dev)";
        if (!traces::can_compile_glsl()) GTEST_SKIP() << "built without glslang (packages glslang-dev and spirv-tools)";
    }

    /// Nothing where there is no such OpenGL.
    std::optional<RecordedFrame> record(const std::string& scenario) {
        const std::filesystem::path file = folder_.path() / "pixels";
        traces::RecordRequest request;
        request.command = {program_.string(), "--pixels=" + file.string(), scenario};
        request.end = 1;
        const std::atomic<bool> stop{false};
        try {
            const traces::Recording recording = traces::record_program(request, stop).recording;
            EXPECT_TRUE(recording.not_recorded.empty());
            std::ifstream stream(file, std::ios::binary);
            const Pixels mesas{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
            return RecordedFrame{drawn(recording), mesas};
        } catch (const sim::InputError& error) {
            if (std::string(error.what()).find("with status 77") == std::string::npos) throw;
            return std::nullopt;
        }
    }

  private:
    static Pixels drawn(const traces::Recording& recording) {
        const pipeline::Frame frame = traces::lower(recording, {}, "recording");
        const auto streams = pipeline::rasterize_frame(frame);
        const pipeline::ReferenceImage image = pipeline::run_reference(frame, streams);
        const bool top_first = recording.targets.at(recording.frames.at(0).shown).top_row_first;
        Pixels pixels;
        for (std::uint32_t row = 0; row < height; ++row) {
            const std::size_t first = std::size_t{top_first ? height - 1 - row : row} * width * 4;
            for (std::size_t i = 0; i < width * 4; ++i)
                pixels.push_back(static_cast<unsigned char>(std::lround(image.colour.at(first + i) * 255.0F)));
        }
        return pixels;
    }

    std::filesystem::path program_;
    ropsim_test::TemporaryFolder folder_;
};

TEST_P(RecordedPixels, AreThoseOfMesa) {
    const auto frame = record(GetParam());
    if (!frame) GTEST_SKIP() << "no surfaceless EGL with desktop OpenGL";
    ASSERT_EQ(frame->mesas.size(), std::size_t{width} * height * 4);
    ASSERT_EQ(frame->ours.size(), frame->mesas.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < frame->ours.size(); ++i) {
        const int distance = std::abs(int{frame->ours[i]} - int{frame->mesas[i]});
        if (distance > 2 && ++different <= 5)
            ADD_FAILURE() << "channel " << i % 4 << " of pixel (" << i / 4 % width << ", " << i / 4 / width
                          << "): " << int{frame->ours[i]} << " instead of " << int{frame->mesas[i]};
    }
    EXPECT_EQ(different, 0U);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, RecordedPixels,
                         ::testing::Values("arrays", "elements", "immediate", "lists", "texture", "targets",
                                           "alpha_tests", "depth_ranges", "interpolations", "parts", "blits"),
                         [](const auto& one) { return std::string(one.param); });

} // namespace recorded_pixels_test
