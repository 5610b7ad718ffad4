#include "cli/interruption.hpp"

#include <csignal>
#include <sys/time.h>
#include <unistd.h>

namespace cli {

namespace {

// Signal handlers can reach nothing but static variables.
std::atomic<bool> stop{false};
std::atomic<int> signal_number{0};
std::atomic<int> files_in_progress{0};
std::atomic<bool> told{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

constexpr suseconds_t patience_us = 700'000;
constexpr suseconds_t retry_us = 100'000;

void on_patience_over(int) {
    if (files_in_progress != 0) return; // tried again after retry_us
    tell_interrupted();
    ::_exit(interrupted_status());
}

void on_signal(int number) {
    if (signal_number != 0) return; // the clock is ticking
    signal_number = number;
    stop = true;
    const itimerval patience{{0, retry_us}, {0, patience_us}};
    ::setitimer(ITIMER_REAL, &patience, nullptr); // a plain system call on Linux, safe in a handler
}

void handle(int number, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigaction(number, &action, nullptr);
}

} // namespace

void catch_interruptions() {
    handle(SIGALRM, on_patience_over);
    handle(SIGINT, on_signal);
    handle(SIGTERM, on_signal);
}

const std::atomic<bool>& stop_requested() { return stop; }

FilesInProgress::FilesInProgress() { ++files_in_progress; }

FilesInProgress::~FilesInProgress() { --files_in_progress; }

// Called by the handler, too: the clock may run out while the program is just ending by itself.
void tell_interrupted() {
    if (told.exchange(true)) return;
    constexpr char text[] = "ropsim: interrupted\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, sizeof(text) - 1);
}

int interrupted_status() { return 128 + (signal_number == 0 ? SIGINT : signal_number.load()); }

} // namespace cli
