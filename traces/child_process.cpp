#include "traces/child_process.hpp"

#include "ropsim_build.hpp"
#include "sim/check.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace traces {

namespace {

constexpr std::size_t line_size = 256;
constexpr rlim_t most_seconds = 600;

/// Memory that parent and child share.
class Shared {
  public:
    explicit Shared(std::size_t size) : size_(size) {
        memory_ = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    }
    ~Shared() {
        if (good()) ::munmap(memory_, size_);
    }
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;

    bool good() const { return memory_ != MAP_FAILED; }
    unsigned char* data() const { return static_cast<unsigned char*>(memory_); }

  private:
    std::size_t size_;
    void* memory_;
};

[[noreturn]] void be_child(const std::function<int()>& work) {
    for (const int number : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) std::signal(number, SIG_DFL);
    const rlimit time{most_seconds, most_seconds}, no_core{0, 0};
    ::setrlimit(RLIMIT_CPU, &time);
    ::setrlimit(RLIMIT_CORE, &no_core);
    int status = 2;
    try {
        status = work();
    } catch (...) { // a line that says more is the work's own
    }
    ::_exit(status == 0 ? 0 : 1);
}

} // namespace

ChildResult in_child_process(std::size_t size,
                             const std::function<int(std::span<unsigned char>, std::span<char>)>& work) {
    const Shared shared(line_size + size);
    if (!shared.good()) return {{}, fmt::format("no memory for {} bytes", size)};
    char* const line = reinterpret_cast<char*>(shared.data());
    const std::span<unsigned char> bytes(shared.data() + line_size, size);
    const pid_t child = ::fork();
    if (child < 0) return {{}, fmt::format("no process to run it in: {}", std::strerror(errno))};
    if (child == 0) be_child([&] { return work(bytes, {line, line_size}); });
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return {{}, fmt::format("the process was lost: {}", std::strerror(errno))};
    if (WIFSIGNALED(status))
        return {{},
                fmt::format("the library ended with signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)))};
    if (WEXITSTATUS(status) == 0) return {{bytes.begin(), bytes.end()}, {}};
    line[line_size - 1] = '\0';
    std::string failure = line;
    for (char& letter : failure)
        if (letter < ' ') letter = ' ';
    return {{}, failure.empty() ? "the library failed" : failure};
}

void* function_of_module(const char* file, const char* function, const char* purpose, const char* package) {
    const auto fail = [&](const std::string& reason) {
        throw sim::InputError(fmt::format("{} needs {} and {} (Debian): {}", purpose, file, package, reason));
    };
    const auto path = ropsim_build::find_module(file);
    if (!path) fail(fmt::format("{} was not found", file));
    void* library = ::dlopen(path->c_str(), RTLD_NOW | RTLD_LOCAL); // a second time gives the same one
    if (library == nullptr) fail(::dlerror());
    void* address = ::dlsym(library, function);
    if (address == nullptr) fail(path->string() + " is of another version of ropsim");
    return address;
}

} // namespace traces
