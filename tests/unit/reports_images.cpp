// PNG and EXR files hold the pixels given, and equal pixels give equal files.
#include "reports/images.hpp"

#include "reports/picture_files.hpp"
#include "sim/check.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/sample_comparison.hpp"

#include <csignal>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <thread>

namespace {

using ropsim_test::TemporaryFolder;

class ReportsImages : public ::testing::Test {
  protected:
    void SetUp() override {
        try {
            reports::require_images();
        } catch (const sim::InputError& error) {
            GTEST_SKIP() << error.what();
        }
    }
    TemporaryFolder folder;
};

reports::Measurement measurement() {
    reports::Measurement result{3, 2, {"R", "layer0.Z"}, {}};
    for (int i = 0; i < 12; ++i) result.values.push_back(0.1F * static_cast<float>(i) - 0.3F);
    result.values[5] = 1e30F;
    return result;
}

TEST_F(ReportsImages, PngKeepsItsPixels) {
    reports::Picture picture(3, 2);
    for (std::uint8_t i = 0; i < 6; ++i) picture.pixels[i] = {i, static_cast<std::uint8_t>(40 * i), 255};
    reports::write_png(folder.path() / "a.png", picture);
    const auto read = reports::read_image(folder.path() / "a.png");
    ASSERT_EQ(read.channels.size(), 3U);
    ASSERT_EQ(read.width, 3U);
    for (std::size_t i = 0; i < 18; ++i)
        EXPECT_EQ(std::lround(read.values[i] * 255.0F), picture.pixels[i / 3][i % 3]) << i;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.png"});
}

TEST_F(ReportsImages, ExrKeepsEveryBit) {
    reports::write_exr(folder.path() / "a.exr", measurement());
    const auto read = reports::read_image(folder.path() / "a.exr");
    ASSERT_EQ(read.width, 3U);
    ASSERT_EQ(read.values.size(), 12U);
    // Channels come back in the file's order, which is alphabetical as here.
    EXPECT_EQ(read.values, measurement().values);
}

TEST_F(ReportsImages, EqualPixelsGiveEqualFilesLongAfterwards) {
    reports::write_exr(folder.path() / "a.exr", measurement());
    reports::write_png(folder.path() / "a.png", reports::Picture(4, 4, {1, 2, 3}));
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    reports::write_exr(folder.path() / "b.exr", measurement());
    reports::write_png(folder.path() / "b.png", reports::Picture(4, 4, {1, 2, 3}));
    for (const char* extension : {".exr", ".png"})
        EXPECT_EQ(ropsim_test::file_text(folder.path() / ("a" + std::string(extension))),
                  ropsim_test::file_text(folder.path() / ("b" + std::string(extension))));
}

TEST_F(ReportsImages, UnwritableFolderIsOneLineWithTheFileItself) {
    try {
        reports::write_png(folder.path() / "missing" / "a.png", reports::Picture(4, 4));
        FAIL();
    } catch (const sim::InputError& error) {
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with((folder.path() / "missing/a.png").string() + ": cannot be written: "))
            << message;
        EXPECT_EQ(message.find(".part"), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

// As on a full disk.
TEST_F(ReportsImages, FileThatCannotBeFinishedLeavesNothing) {
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{2000, before.rlim_max};
    auto* handler = std::signal(SIGXFSZ, SIG_IGN);
    reports::Measurement large{200, 200, {"R"}, std::vector<float>(40000)};
    reports::Picture picture(200, 200);
    for (std::size_t i = 0; i < large.values.size(); ++i) {
        large.values[i] = static_cast<float>(i * 2654435761U % 1000003U);
        picture.pixels[i] = {static_cast<std::uint8_t>(i * 2654435761U >> 8), static_cast<std::uint8_t>(i * 40503U), 0};
    }
    ::setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_THROW(reports::write_exr(folder.path() / "a.exr", large), sim::InputError);
    EXPECT_THROW(reports::write_png(folder.path() / "a.png", picture), sim::InputError);
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(folder.files().size(), 0U);
}

TEST_F(ReportsImages, AllPicturesOfAComparison) {
    const auto comparison = ropsim_test::sample_comparison();
    const auto pictures = reports::write_pictures(comparison, folder.path());
    const std::vector<std::string> expected{"overlap.exr",
                                            "overlap.png",
                                            "racy/composite.exr",
                                            "racy/composite.png",
                                            "racy/difference_x2.png",
                                            "racy/hazards.png",
                                            "racy/layer0.png",
                                            "racy/layer1.png",
                                            "racy/layers.exr",
                                            "reference/composite.exr",
                                            "reference/composite.png",
                                            "reference/layer0.png",
                                            "reference/layer1.png",
                                            "reference/layers.exr",
                                            "safe/composite.exr",
                                            "safe/composite.png",
                                            "safe/difference_x2.png",
                                            "safe/hazards.png",
                                            "safe/layer0.png",
                                            "safe/layer1.png",
                                            "safe/layers.exr"};
    EXPECT_EQ(folder.files(), expected);
    EXPECT_EQ(pictures.size(), 14U);
    for (const auto& picture : pictures) EXPECT_TRUE(std::filesystem::exists(folder.path() / picture.file));
}

TEST_F(ReportsImages, FrameWithoutPictureHasItsFragmentCountsOnly) {
    auto comparison = ropsim_test::sample_comparison();
    auto frame = *comparison.frame;
    frame.program = nullptr;
    comparison.frame = std::make_shared<const pipeline::Frame>(frame);
    comparison.reference = {};
    for (reports::FramePixels& pixels : comparison.pixels) pixels = {};
    EXPECT_EQ(reports::write_pictures(comparison, folder.path()).size(), 1U);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"overlap.exr", "overlap.png"}));
}

TEST_F(ReportsImages, PicturesOfAnEarlierComparisonDoNotStay) {
    std::filesystem::create_directory(folder.path() / "racy");
    for (const char* name : {"difference_x64.png", "layer7.png", "layer_of_mine.png"})
        ropsim_test::write_text(folder.path() / "racy" / name, "old");
    reports::write_pictures(ropsim_test::sample_comparison(), folder.path());
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "racy/difference_x64.png"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "racy/layer7.png"));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "racy/layer_of_mine.png"));
}

TEST_F(ReportsImages, StopEndsTheWriting) {
    const std::atomic<bool> stop{true};
    EXPECT_THROW(reports::write_pictures(ropsim_test::sample_comparison(), folder.path(), &stop), sim::Interrupted);
    EXPECT_EQ(folder.files().size(), 0U);
}

} // namespace
