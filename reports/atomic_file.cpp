#include "reports/atomic_file.hpp"

#include "sim/check.hpp"
#include "sim/read_file.hpp"
#include "sim/unfinished_file.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
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

constexpr const char* notes_name = ".ropsim-files";
constexpr std::uint64_t largest_notes = std::uint64_t{1} << 24U;

// In the notes of the folder or of the one above it, whichever belongs to a run.
void note_file(const fs::path& path) {
    fs::path name = path.filename(), folder = path.parent_path();
    for (int level = 0; level < 2; ++level) {
        const int notes = ::open((folder / notes_name).c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
        if (notes >= 0) {
            write_all(notes, name.generic_string() + "\n"); // without a note the file merely stays
            ::close(notes);
            return;
        }
        name = folder.filename() / name;
        folder = folder.parent_path();
        if (name.has_root_path() || name.string().starts_with("..")) return;
    }
}

// Only what can have been noted: a file here, or in a folder of this one.
void remove_noted(const fs::path& directory, const fs::path& name) {
    const auto parts = std::distance(name.begin(), name.end());
    if (name.is_absolute() || parts < 1 || parts > 2 || *name.begin() == ".." || name.filename() == "..") return;
    std::error_code failed;
    const fs::path file = directory / name;
    if (!fs::is_regular_file(fs::symlink_status(file, failed))) return;
    fs::remove(file, failed);
    if (parts == 2) fs::remove(file.parent_path(), failed); // where it is empty now
}

} // namespace

void write_file(const fs::path& path, std::string_view text, bool noted) {
    sim::UnfinishedFile file(path);
    const int descriptor = ::open(file.temporary().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) cannot_write(path, errno);
    int error = write_all(descriptor, text);
    // Some file systems notice only here that the disk is full.
    if (::close(descriptor) != 0 && error == 0) error = errno;
    if (error != 0) cannot_write(path, error);
    if (noted) note_file(path);
    error = file.commit();
    if (error != 0) cannot_write(path, error);
}

void begin_report_folder(const fs::path& directory) {
    make_directory(directory);
    std::error_code failed;
    const fs::path notes = directory / notes_name;
    if (fs::exists(notes, failed)) {
        std::istringstream list(sim::read_file(notes, largest_notes));
        for (std::string line; std::getline(list, line);) remove_noted(directory, line);
    }
    std::ofstream(notes, std::ios::trunc).flush();
}

void make_directory(const fs::path& directory) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error && !fs::is_directory(directory))
        throw sim::InputError(fmt::format("{}: cannot be made a folder: {}", directory.string(), error.message()));
    // Asked by doing: access rights alone do not tell about read-only file systems.
    const sim::UnfinishedFile probe(directory / ".ropsim-probe");
    const int descriptor = ::open(probe.temporary().c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) cannot_write(directory, errno);
    ::close(descriptor);
}

} // namespace reports
