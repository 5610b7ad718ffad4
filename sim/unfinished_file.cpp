#include "sim/unfinished_file.hpp"

#include "sim/check.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace sim {

namespace {

// Signal handlers can reach nothing but static variables. More files at once than there are slots are not registered.
constexpr std::size_t slots = 64, longest_path = 4096;
constexpr int no_slot = -1;
enum class State : int { free, filling, held };
struct Slot {
    std::atomic<State> state{State::free};
    std::array<char, longest_path> path{};
};
std::array<Slot, slots> held_files;
std::atomic<bool> ending{false};
static_assert(std::atomic<State>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

int hold(const std::string& path) {
    while (ending) ::pause();
    if (path.size() + 1 > longest_path) return no_slot;
    for (std::size_t i = 0; i < slots; ++i) {
        State expected = State::free;
        if (!held_files[i].state.compare_exchange_strong(expected, State::filling)) continue;
        std::memcpy(held_files[i].path.data(), path.c_str(), path.size() + 1);
        held_files[i].state = State::held;
        return static_cast<int>(i);
    }
    return no_slot;
}

std::filesystem::path name_of_file(std::filesystem::path path) {
    std::error_code unknown;
    const auto status = std::filesystem::status(path, unknown);
    if (path.filename().empty() || (exists(status) && !is_regular_file(status)))
        throw InputError(fmt::format("{}: expected the name of a file to write", path.string()));
    return path;
}

void release(int slot) {
    if (slot != no_slot) held_files[static_cast<std::size_t>(slot)].state = State::free;
}

} // namespace

UnfinishedFile::UnfinishedFile(std::filesystem::path path)
    : path_(name_of_file(std::move(path))),
      temporary_(path_.parent_path() / fmt::format(".{}.{}.part", path_.filename().string(), ::getpid())),
      slot_(hold(temporary_.string())) {}

UnfinishedFile::~UnfinishedFile() {
    if (!done_) ::unlink(temporary_.c_str());
    release(slot_);
}

int UnfinishedFile::commit() {
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) return errno;
    done_ = true;
    return 0;
}

void check_writable(const std::filesystem::path& path) {
    const UnfinishedFile probe(path);
    const int file = ::open(probe.temporary().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) throw InputError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
    ::close(file);
}

void remove_unfinished_files() {
    ending = true;
    for (Slot& slot : held_files)
        if (slot.state == State::held) ::unlink(slot.path.data());
}

} // namespace sim
