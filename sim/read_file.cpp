#include "sim/read_file.hpp"

#include "sim/check.hpp"
#include "sim/counted.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace sim {

namespace {

class OpenFile {
  public:
    explicit OpenFile(const std::filesystem::path& path) : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
    ~OpenFile() {
        if (number_ >= 0) ::close(number_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    int number() const { return number_; }

  private:
    int number_;
};

} // namespace

std::string read_file(const std::filesystem::path& path, std::uint64_t most_bytes) {
    const auto fail = [&path](const std::string& what) {
        throw InputError(fmt::format("{}: {}", path.string(), what));
    };
    const auto unreadable = [&fail](int error) { fail(fmt::format("cannot be read: {}", std::strerror(error))); };
    const OpenFile file(path);
    if (file.number() < 0 && (errno == ENOENT || errno == ENOTDIR)) fail("there is no such file");
    if (file.number() < 0) unreadable(errno);
    std::error_code failed;
    if (std::filesystem::is_directory(path, failed)) fail("expected a file, got a folder");
    std::string text;
    constexpr std::size_t piece = 65536;
    for (;;) {
        const std::size_t before = text.size();
        text.resize(before + piece);
        const ssize_t got = ::read(file.number(), text.data() + before, piece);
        if (got < 0 && errno != EINTR) unreadable(errno);
        text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
        if (got == 0) return text;
        if (text.size() > most_bytes) fail(fmt::format("expected a file of at most {}", counted(most_bytes, "byte")));
    }
}

} // namespace sim
