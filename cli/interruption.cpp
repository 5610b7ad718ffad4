#include "cli/interruption.hpp"

#include "sim/unfinished_file.hpp"

#include <csignal>
#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

namespace cli {

namespace {

// Signal handlers can reach nothing but static variables.
std::atomic<bool> stop{false};
std::atomic<int> signal_number{0};
std::atomic<bool> told{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

constexpr suseconds_t patience_us = 700'000;

void on_patience_over(int) {
    sim::remove_unfinished_files();
    tell_interrupted();
    ::_exit(interrupted_status());
}

void on_signal(int number) {
    if (signal_number != 0) return; // the clock is ticking
    signal_number = number;
    stop = true;
    const itimerval patience{{0, 0}, {0, patience_us}};
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
    // Open for reading only: what is written there fails, as it did before.
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) == -1) ::open("/dev/null", O_RDONLY);
    handle(SIGXFSZ, SIG_IGN);
    handle(SIGPIPE, SIG_IGN);
    handle(SIGALRM, on_patience_over);
    handle(SIGINT, on_signal);
    handle(SIGTERM, on_signal);
}

const std::atomic<bool>& stop_requested() { return stop; }

// Called by the handler, too: the clock may run out while the program is just ending by itself.
void tell_interrupted() {
    if (told.exchange(true)) return;
    constexpr char text[] = "ropsim: interrupted\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, sizeof(text) - 1);
}

int interrupted_status() { return 128 + (signal_number == 0 ? SIGINT : signal_number.load()); }

} // namespace cli
