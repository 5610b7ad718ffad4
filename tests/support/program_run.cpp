#include "tests/support/program_run.hpp"

#include "tests/support/paths.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace ropsim_test {

namespace fs = std::filesystem;

namespace {

// Between fork and exec only async-signal-safe calls are allowed: everything is prepared before.
[[noreturn]] void become_program(char* const* arguments, char* const* environment, int out, int error,
                                 std::size_t file_limit) {
    ::dup2(::open("/dev/null", O_RDONLY), 0);
    ::dup2(out, 1);
    ::dup2(error, 2);
    if (file_limit > 0) {
        const rlimit limit{file_limit, file_limit};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        std::signal(SIGXFSZ, SIG_IGN);
    }
    ::execve(arguments[0], arguments, environment);
    ::_exit(127);
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
}

std::vector<std::string> environment_with(const std::vector<std::string>& further) {
    std::vector<std::string> result;
    for (char** variable = environ; *variable != nullptr; ++variable) result.emplace_back(*variable);
    result.insert(result.begin(), further.begin(), further.end()); // the first of equal names counts
    return result;
}

int create(const fs::path& path) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file < 0) throw std::runtime_error("cannot create " + path.string());
    return file;
}

} // namespace

ProgramOutcome run_program(const std::vector<std::string>& arguments, const ProgramOptions& options) {
    const TemporaryFolder folder;
    std::vector<std::string> words{program().string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> variables = environment_with(options.environment);
    const auto argv = pointers(words), envp = pointers(variables);
    const fs::path out_file = options.stdout_file.empty() ? folder.path() / "out" : fs::path(options.stdout_file);
    const int out = create(out_file), error = create(folder.path() / "error");

    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = ::fork();
    if (child == 0) become_program(argv.data(), envp.data(), out, error, options.file_limit);
    ::close(out);
    ::close(error);
    if (options.while_running) options.while_running(child);
    int state = 0;
    ::waitpid(child, &state, 0);

    ProgramOutcome outcome;
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    outcome.status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    if (options.stdout_file.empty()) outcome.out = file_text(out_file);
    outcome.error = file_text(folder.path() / "error");
    return outcome;
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "ropsim_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::permissions(path_, fs::perms::owner_all, ignored);
    fs::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::files() const {
    std::vector<std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator(path_))
        if (entry.is_regular_file()) result.push_back(fs::relative(entry.path(), path_).generic_string());
    std::sort(result.begin(), result.end());
    return result;
}

std::string file_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

} // namespace ropsim_test
