#include "traces/recording/running_program.hpp"

#include "sim/check.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sstream>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace traces {

namespace {

constexpr std::chrono::milliseconds patience{200}; ///< before a program is killed

/// In the child: what is not the same as here, then the program. Returns errno.
int become(const std::vector<char*>& arguments, const std::vector<char*>& environment, int kept, int told) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL); // whatever happens to ropsim, the program does not go on alone
    // SIGXFSZ stays ignored: what cannot be recorded for lack of room ends with words, not with a signal.
    for (const int number : {SIGINT, SIGTERM, SIGALRM, SIGPIPE}) std::signal(number, SIG_DFL);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    if (kept >= 0) ::fcntl(kept, F_SETFD, 0);
    ::fcntl(told, F_SETFD, FD_CLOEXEC);
    ::execvpe(arguments[0], arguments.data(), environment.data());
    return errno;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
}

std::vector<std::string> with_environment(const RunningProgram::Environment& added) {
    std::vector<std::string> result;
    for (char** each = ::environ; *each != nullptr; ++each) {
        const std::string text = *each;
        const std::string name = text.substr(0, text.find('='));
        bool replaced = false;
        for (const auto& [other, value] : added) replaced = replaced || other == name;
        if (!replaced) result.push_back(text);
    }
    for (const auto& [name, value] : added) result.push_back(fmt::format("{}={}", name, value));
    return result;
}

std::string words_of(int status) {
    if (WIFSIGNALED(status)) return fmt::format("by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("with status {}", WEXITSTATUS(status));
}

} // namespace

std::string find_program(const std::string& name) {
    if (name.find('/') != std::string::npos) return ::access(name.c_str(), X_OK) == 0 ? name : "";
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (std::string file = fmt::format("{}/{}", folder, name); ::access(file.c_str(), X_OK) == 0) return file;
    // Debian puts games where root has no path to.
    if (std::string file = "/usr/games/" + name; ::access(file.c_str(), X_OK) == 0) return file;
    return "";
}

RunningProgram::RunningProgram(const std::vector<std::string>& command, const Environment& environment, int kept) {
    std::vector<std::string> arguments = command, variables = with_environment(environment);
    if (const std::string file = find_program(arguments.at(0)); !file.empty()) arguments[0] = file;
    const std::vector<char*> argument_pointers = pointers(arguments), variable_pointers = pointers(variables);
    std::array<int, 2> told{};
    if (::pipe2(told.data(), O_CLOEXEC) != 0) throw sim::InputError("no pipe to a program that is to be run");
    process_ = ::fork();
    if (process_ == 0) {
        const int problem = become(argument_pointers, variable_pointers, kept, told[1]);
        [[maybe_unused]] const ssize_t written = ::write(told[1], &problem, sizeof problem);
        ::_exit(127);
    }
    ::close(told[1]);
    int problem = process_ < 0 ? errno : 0;
    if (process_ > 0 && ::read(told[0], &problem, sizeof problem) != static_cast<ssize_t>(sizeof problem)) problem = 0;
    ::close(told[0]);
    if (problem == 0) return;
    if (process_ > 0) ::waitpid(process_, nullptr, 0);
    throw sim::InputError(
        fmt::format("{}: expected a program that can be run: {}", command[0], std::strerror(problem)));
}

RunningProgram::~RunningProgram() {
    if (ended()) return;
    ::kill(-process_, SIGTERM);
    for (auto waited = std::chrono::milliseconds(0); waited < patience && !ended();
         waited += std::chrono::milliseconds(10))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::kill(-process_, SIGKILL);
    if (!status_) ::waitpid(process_, nullptr, 0);
}

std::optional<std::string> RunningProgram::ended() {
    int status = 0;
    if (!status_ && ::waitpid(process_, &status, WNOHANG) == process_) status_ = status;
    return status_ ? std::optional(words_of(*status_)) : std::nullopt;
}

bool RunningProgram::ended_with(int status) {
    return ended() && WIFEXITED(*status_) && WEXITSTATUS(*status_) == status;
}

} // namespace traces
