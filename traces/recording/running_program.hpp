// A program that was started, in a process group of its own.
#pragma once

#include <optional>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

namespace traces {

/// The file that a name stands for as a shell finds it; empty: none.
std::string find_program(const std::string& name);

class RunningProgram {
  public:
    using Environment = std::vector<std::pair<std::string, std::string>>; ///< added to that of ropsim

    /// Its standard output is ropsim's standard error. `kept` stays open in it, under its number; -1: none.
    /// Throws sim::InputError when it cannot be started.
    RunningProgram(const std::vector<std::string>& command, const Environment& environment, int kept = -1);
    /// Ends it with all that it started.
    ~RunningProgram();
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    /// How it ended, in words ("with status 1"); nothing: it runs.
    std::optional<std::string> ended();
    /// It ended by itself with this exit status.
    bool ended_with(int status);

  private:
    pid_t process_ = -1;
    std::optional<int> status_; ///< as waitpid() gives it
};

} // namespace traces
