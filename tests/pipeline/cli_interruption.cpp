// Ctrl-C ends the program within a second, and neither that nor a full disk leaves a half-written file.
#include "tests/support/effort.hpp"
#include "tests/support/program_run.hpp"

#include <algorithm>
#include <csignal>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

namespace cli_interruption_test {

using Clock = std::chrono::steady_clock;
using ropsim_test::run_program;
using ropsim_test::TemporaryFolder;

// A frame that would run for minutes.
const std::vector<std::string> endless{"compare", "gen:quads?n=4000", "--size", "512x512"};

struct Interrupted {
    ropsim_test::ProgramOutcome outcome;
    double seconds = 0; ///< from the signal to the end
};

Interrupted interrupt(const std::vector<std::string>& arguments, int signal, std::chrono::milliseconds after,
                      ropsim_test::ProgramOptions options = {}) {
    Clock::time_point sent;
    options.while_running = [&](pid_t child) {
        std::this_thread::sleep_for(after);
        sent = Clock::now();
        ::kill(child, signal);
    };
    Interrupted result{run_program(arguments, options), 0};
    result.seconds = std::chrono::duration<double>(Clock::now() - sent).count();
    return result;
}

// The limit is a second; the rest is for a machine that has other things to do, and for sanitizers.
constexpr double patience = tests::sanitized ? 10.0 : 2.0;
// Until the program has begun to listen to signals, which a sanitizer delays.
constexpr int start = tests::sanitized ? 2000 : 0; // ms

TEST(CliInterruption, EndsWithinASecond) {
    for (const int after : {300, 1200}) {
        const Interrupted run = interrupt(endless, SIGINT, std::chrono::milliseconds(start + after));
        EXPECT_EQ(run.outcome.status, 130) << run.outcome.error;
        EXPECT_EQ(run.outcome.error, "ropsim: interrupted\n");
        EXPECT_LT(run.seconds, patience) << after;
    }
}

TEST(CliInterruption, TerminationHasItsOwnStatus) {
    const Interrupted run = interrupt(endless, SIGTERM, std::chrono::milliseconds(start + 400));
    EXPECT_EQ(run.outcome.status, 143);
    EXPECT_LT(run.seconds, patience);
}

TEST(CliInterruption, LeavesNoHalfWrittenFileLong) {
    for (int after = 100; after < 1500; after += 100) {
        const TemporaryFolder folder;
        interrupt({"compare", "gen:discs?n=300", "--size", "512x512", "--out", folder.path().string()}, SIGINT,
                  std::chrono::milliseconds(after));
        for (const std::string& file : folder.files()) EXPECT_EQ(file.find(".part"), std::string::npos) << file;
    }
}

// Nothing is left: neither the program that is recorded, nor a part of a trace.
TEST(CliInterruption, ARecordingEndsWithItsProgram) {
    if (tests::sanitized) GTEST_SKIP() << "a sanitizer does not go into other programs";
    const TemporaryFolder folder;
    const auto number = folder.path() / "number";
    ropsim_test::ProgramOptions options;
    options.environment = {"DISPLAY=:none"}; // so that no X server is started
    const Interrupted run = interrupt({"record", "-o", (folder.path() / "x.rtrace").string(), "--", "sh", "-c",
                                       "echo $$ > '" + number.string() + "'; exec sleep 60"},
                                      SIGINT, std::chrono::milliseconds(start + 700), options);
    if (run.outcome.error.find("recording needs") != std::string::npos) GTEST_SKIP() << run.outcome.error;
    EXPECT_EQ(run.outcome.status, 130);
    EXPECT_EQ(run.outcome.error, "ropsim: interrupted\n");
    EXPECT_LT(run.seconds, patience);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"number"});
    EXPECT_EQ(::kill(static_cast<pid_t>(std::stol(ropsim_test::file_text(number))), 0), -1);
}

TEST(CliInterruption, FullDiskBehindStandardOutput) {
    ropsim_test::ProgramOptions options;
    options.stdout_file = "/dev/full";
    const auto outcome = run_program({"compare", "gen:stack", "--size", "16x16", "--json"}, options);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.error, "ropsim: standard output: cannot be written: No space left on device\n");
}

TEST(CliInterruption, FullDiskWhileTheReportIsWritten) {
    const TemporaryFolder folder;
    ropsim_test::ProgramOptions options;
    options.file_limit = 4000;
    const auto outcome = run_program(
        {"compare", "gen:stack", "--size", "64x64", "--no-images", "--out", folder.path().string()}, options);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.error.find("cannot be written: File too large"), std::string::npos) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    for (const std::string& file : folder.files()) EXPECT_EQ(file.find(".part"), std::string::npos) << file;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "report.html")) << "the page comes last";
}

TEST(CliInterruption, UnwritableFolderIsToldBeforeTheRun) {
    const TemporaryFolder folder;
    ropsim_test::write_text(folder.path() / "file", "in the way");
    std::vector<std::string> arguments = endless;
    arguments.insert(arguments.end(), {"--no-images", "--out", (folder.path() / "file").string()});
    const auto outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_LT(outcome.seconds, patience);
    EXPECT_TRUE(outcome.error.starts_with("ropsim: " + (folder.path() / "file").string())) << outcome.error;
}

TEST(CliInterruption, ReadOnlyFolderIsToldBeforeTheRun) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const TemporaryFolder folder;
    std::filesystem::permissions(folder.path(),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    std::vector<std::string> arguments = endless;
    arguments.insert(arguments.end(), {"--no-images", "--out", folder.path().string()});
    const auto outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_LT(outcome.seconds, patience);
}

} // namespace cli_interruption_test
