// Runs the built program, as a user would.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace ropsim_test {

struct ProgramOutcome {
    int status = -1; ///< exit status, or 128 + the signal that ended it
    std::string out;
    std::string error;
    double seconds = 0; ///< from start to exit
};

struct ProgramOptions {
    std::vector<std::string> environment;     ///< "NAME=value", added to the test's own
    std::string stdout_file;                  ///< instead of collecting it in ProgramOutcome::out
    std::size_t file_limit = 0;               ///< bytes a file of the program may have; 0: any
    std::function<void(pid_t)> while_running; ///< called once after the start
};

/// Starts the program with `arguments` and waits for its end. It sees no terminal.
ProgramOutcome run_program(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

/// A new empty folder; removed with all it holds by the destructor.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Names of all files below it, relative, sorted.
    std::vector<std::string> files() const;

  private:
    std::filesystem::path path_;
};

std::string file_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& text);

} // namespace ropsim_test
