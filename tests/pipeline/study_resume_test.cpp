// A study that was interrupted, or whose folder several processes share, computes every point once.
#include "reports/study_points.hpp"
#include "tests/support/program_run.hpp"

#include <csignal>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace study_resume_test {

using nlohmann::json;
using ropsim_test::file_text;
using ropsim_test::run_program;
using ropsim_test::TemporaryFolder;

/// A study of `points` points.
std::string study_text(int points, const std::string& triangles = "{x}") {
    std::string text = "title = \"t\"\nquestion = \"q\"\nx = \"triangles\"\nsize = \"64x48\"\n"
                       "measures = [ { value = \"cycles\", title = \"cycles\" } ]\npoints = [";
    for (int i = 1; i <= points; ++i) text += " { x = " + std::to_string(1000 * i) + " },";
    return text + " ]\n[[series]]\nname = \"blender\"\nscene = \"gen:blob?triangles=" + triangles +
           "\"\ndesign = \"blender\"\n";
}

class StudyResume : public ::testing::Test {
  protected:
    StudyResume() { write(study_text(6)); }

    void write(const std::string& text) { ropsim_test::write_text(file_, text); }
    ropsim_test::ProgramOutcome run(std::vector<std::string> more = {}, ropsim_test::ProgramOptions options = {}) {
        std::vector<std::string> arguments{"study", file_, "--out", out(), "--threads", "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(arguments, options);
    }
    std::string out() const { return (folder_.path() / "out").string(); }
    std::size_t points() const {
        std::size_t count = 0;
        std::error_code none;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "out" / "points", none))
            count += entry.path().extension() == ".json" ? 1U : 0U;
        return count;
    }

    TemporaryFolder folder_;
    std::string file_ = (folder_.path() / "mine.toml").string();
};

TEST_F(StudyResume, FinishedPointsAreNotComputedAgain) {
    const auto first = run();
    ASSERT_EQ(first.status, 0) << first.error;
    EXPECT_EQ(first.out.find("had been finished"), std::string::npos);
    const std::string table = file_text(out() + "/study.csv");
    EXPECT_EQ(points(), 6U);
    const auto again = run();
    EXPECT_NE(again.out.find("6 of 6 points had been finished before"), std::string::npos) << again.out;
    EXPECT_EQ(file_text(out() + "/study.csv"), table);
    const auto anew = run({"--no-resume"});
    EXPECT_EQ(anew.out.find("had been finished"), std::string::npos);
    EXPECT_EQ(file_text(out() + "/study.csv"), table);
}

TEST_F(StudyResume, AKilledStudyKeepsWhatItHad) {
    write(study_text(40, "{x}"));
    ropsim_test::ProgramOptions options;
    options.while_running = [this](pid_t child) {
        while (points() < 2) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ::kill(child, SIGKILL);
    };
    EXPECT_NE(run({}, options).status, 0);
    const std::size_t had = points();
    EXPECT_LT(had, 40U);
    const auto rest = run({"--json"});
    ASSERT_EQ(rest.status, 0) << rest.error;
    EXPECT_NE(rest.error.find(std::to_string(had) + " of 40 points had been finished before"), std::string::npos)
        << rest.error;
    EXPECT_EQ(rest.out, run({"--json", "--no-resume"}).out);
}

TEST_F(StudyResume, PointsOfOtherInputsAreForgotten) {
    ASSERT_EQ(run().status, 0);
    write(study_text(6, "{x}&seed=2"));
    const auto other = run();
    EXPECT_EQ(other.out.find("had been finished"), std::string::npos) << other.out;
    EXPECT_EQ(points(), 6U);
}

TEST_F(StudyResume, ADamagedPointIsComputedAgain) {
    ASSERT_EQ(run().status, 0);
    const std::string table = file_text(out() + "/study.csv");
    for (const auto& entry : std::filesystem::directory_iterator(out() + "/points"))
        ropsim_test::write_text(entry.path(), "{\"format\": 1");
    ASSERT_EQ(run().status, 0);
    EXPECT_EQ(file_text(out() + "/study.csv"), table);
}

TEST_F(StudyResume, TwoProcessesShareTheFolder) {
    write(study_text(12));
    ropsim_test::ProgramOutcome other;
    std::thread second([&] { other = run({"--json"}); });
    const auto first = run({"--json"});
    second.join();
    EXPECT_EQ(first.status, 0) << first.error;
    EXPECT_EQ(other.status, 0) << other.error;
    EXPECT_EQ(first.out, other.out);
    EXPECT_EQ(points(), 12U);
}

TEST_F(StudyResume, TheHeadingNamesSizesNotVariables) {
    std::string text = study_text(2);
    text.replace(text.find("64x48"), 5, "{x}x8");
    write(text);
    const auto outcome = run();
    ASSERT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_NE(outcome.out.find("1000x8 to 2000x8 pixels"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find('{'), std::string::npos) << outcome.out;
}

TEST(StudyPoints, ALockKeepsOthersOutAndEndsWithItsOwner) {
    const TemporaryFolder folder;
    const reports::StudyPoints points(folder.path(), true);
    {
        const reports::PointLock lock = points.lock("a");
        EXPECT_TRUE(lock.held());
        EXPECT_FALSE(points.lock("a").held());
        EXPECT_TRUE(points.lock("b").held());
    }
    EXPECT_TRUE(points.lock("a").held());
}

} // namespace study_resume_test
