// A file appears complete or not at all, and a failure is one line that names it.
#include "reports/atomic_file.hpp"
#include "sim/check.hpp"
#include "sim/unfinished_file.hpp"
#include "tests/support/program_run.hpp"

#include <csignal>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace {

using ropsim_test::TemporaryFolder;

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

/// Files of this process may have at most `bytes` while this lives: like a full disk.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

  private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

TEST(ReportsFiles, WritesAndReplaces) {
    const TemporaryFolder folder;
    reports::write_file(folder.path() / "a.txt", "one");
    reports::write_file(folder.path() / "a.txt", "two");
    EXPECT_EQ(ropsim_test::file_text(folder.path() / "a.txt"), "two");
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.txt"});
}

TEST(ReportsFiles, AFolderThatIsBegunAgainKeepsForeignFilesOnly) {
    const TemporaryFolder folder;
    reports::begin_report_folder(folder.path());
    std::filesystem::create_directory(folder.path() / "design");
    reports::write_file(folder.path() / "a.txt", "one");
    reports::write_file(folder.path() / "design" / "b.txt", "two");
    ropsim_test::write_text(folder.path() / "mine.txt", "three");
    reports::begin_report_folder(folder.path());
    EXPECT_EQ(folder.files(), (std::vector<std::string>{".ropsim-files", "mine.txt"}));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "design"));
}

TEST(ReportsFiles, NotesCannotNameFilesElsewhere) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "out");
    ropsim_test::write_text(folder.path() / "precious.txt", "x");
    ropsim_test::write_text(folder.path() / "out" / ".ropsim-files",
                            "../precious.txt\n" + (folder.path() / "precious.txt").string() + "\n");
    reports::begin_report_folder(folder.path() / "out");
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "precious.txt"));
}

TEST(ReportsFiles, WithoutCommitNothingStays) {
    const TemporaryFolder folder;
    {
        const sim::UnfinishedFile file(folder.path() / "a.txt");
        std::ofstream(file.temporary()) << "half";
        EXPECT_EQ(folder.files().size(), 1U);
    }
    EXPECT_EQ(folder.files().size(), 0U);
}

// A rename would put a file in their place.
TEST(ReportsFiles, FoldersAndDevicesAreNotReplaced) {
    const TemporaryFolder folder;
    for (const std::filesystem::path& path : {folder.path(), std::filesystem::path("/dev/null")}) {
        const std::string expected = path.string() + ": expected the name of a file to write";
        EXPECT_EQ(message_of([&] { sim::check_writable(path); }), expected);
        EXPECT_EQ(message_of([&] { reports::write_file(path, "x"); }), expected);
    }
    EXPECT_EQ(message_of([&] { sim::check_writable(folder.path() / "none" / "a.txt"); }),
              (folder.path() / "none" / "a.txt").string() + ": cannot be written: No such file or directory");
    sim::check_writable(folder.path() / "a.txt");
    EXPECT_EQ(folder.files(), std::vector<std::string>());
}

TEST(ReportsFiles, FullDiskLeavesTheOldFileAndNothingElse) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.txt";
    reports::write_file(path, "old");
    const FileSizeLimit limit(1000);
    const std::string message = message_of([&] { reports::write_file(path, std::string(5000, 'x')); });
    EXPECT_EQ(message, path.string() + ": cannot be written: File too large");
    EXPECT_EQ(ropsim_test::file_text(path), "old");
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.txt"});
}

TEST(ReportsFiles, MissingFolderIsNamed) {
    const std::string message = message_of([] { reports::write_file("/nonexistent/a.txt", "x"); });
    EXPECT_EQ(message, "/nonexistent/a.txt: cannot be written: No such file or directory");
}

TEST(ReportsFiles, FolderIsMadeWithItsParents) {
    const TemporaryFolder folder;
    reports::make_directory(folder.path() / "a" / "b");
    EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "a" / "b"));
    EXPECT_EQ(folder.files().size(), 0U);
}

TEST(ReportsFiles, FileInTheWayOfAFolderIsNamed) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a";
    reports::write_file(path, "x");
    const std::string message = message_of([&] { reports::make_directory(path); });
    EXPECT_EQ(message.substr(0, path.string().size() + 2), path.string() + ": ");
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

} // namespace
