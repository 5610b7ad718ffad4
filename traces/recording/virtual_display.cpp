#include "traces/recording/virtual_display.hpp"

#include "sim/check.hpp"

#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace traces {

namespace {

constexpr int display_patience_ms = 20'000; ///< until an X server has started

} // namespace

bool has_display() {
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
        if (const char* value = std::getenv(name); value != nullptr && *value != '\0') return true;
    return false;
}

VirtualDisplay::VirtualDisplay(const std::atomic<bool>& stop) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw sim::InputError("no pipe to Xvfb");
    try {
        server_.emplace(std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0",
                                                 "2560x1600x24", "-nolisten", "tcp", "-noreset"},
                        RunningProgram::Environment{}, ends[1]);
        ::close(ends[1]);
        read_number(ends[0], stop);
    } catch (...) {
        ::close(ends[0]);
        throw;
    }
    ::close(ends[0]);
}

void VirtualDisplay::read_number(int descriptor, const std::atomic<bool>& stop) {
    for (int waited = 0; waited < display_patience_ms && !server_->ended(); waited += 20) {
        if (stop) throw sim::Interrupted();
        pollfd one{descriptor, POLLIN, 0};
        if (::poll(&one, 1, 20) <= 0) continue;
        char letter = 0;
        if (::read(descriptor, &letter, 1) != 1) break;
        if (letter == '\n') return;
        number_ += letter;
    }
    throw sim::InputError("Xvfb: expected an X server to start");
}

} // namespace traces
