#include "reports/atomic_file.hpp"

#include "sim/check.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace reports {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void cannot_write(const fs::path& path, int error) {
    throw sim::InputError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

// 0 or errno.
int write_all(int file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

} // namespace

AtomicFile::AtomicFile(fs::path path)
    : path_(std::move(path)),
      temporary_(path_.parent_path() / fmt::format(".{}.{}.part", path_.filename().string(), ::getpid())) {}

AtomicFile::~AtomicFile() {
    if (!done_) ::unlink(temporary_.c_str());
}

void AtomicFile::commit() {
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) cannot_write(path_, errno);
    done_ = true;
}

void write_file(const fs::path& path, std::string_view text) {
    AtomicFile file(path);
    const int descriptor = ::open(file.temporary().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) cannot_write(path, errno);
    int error = write_all(descriptor, text);
    // Some file systems notice only here that the disk is full.
    if (::close(descriptor) != 0 && error == 0) error = errno;
    if (error != 0) cannot_write(path, error);
    file.commit();
}

void make_directory(const fs::path& directory) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error && !fs::is_directory(directory))
        throw sim::InputError(fmt::format("{}: cannot be made a folder: {}", directory.string(), error.message()));
    // Asked by doing: access rights alone do not tell about read-only file systems.
    const AtomicFile probe(directory / "probe");
    const int descriptor = ::open(probe.temporary().c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) cannot_write(directory, errno);
    ::close(descriptor);
}

} // namespace reports
