#include "cli/progress_line.hpp"

#include "cli/console.hpp"
#include "reports/numbers.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <fmt/format.h>
#include <unistd.h>

namespace cli {

namespace {

using Clock = std::chrono::steady_clock;
using reports::Progress;

constexpr auto quiet = std::chrono::milliseconds(500);
constexpr auto interval = std::chrono::milliseconds(200);
constexpr std::array<const char*, 7> phase_texts{
    "reading the scene", "shading",     "computing the reference", "simulating", "writing the report",
    "measuring",         "tracing rays"};

double share_of(const Progress& progress) {
    switch (progress.phase.load()) {
    case Progress::Phase::shading:
    case Progress::Phase::measuring:
    case Progress::Phase::tracing:
        return progress.share;
    case Progress::Phase::simulating: {
        const auto total = static_cast<double>(progress.quads_total);
        return total > 0 ? static_cast<double>(progress.quads_done) / total : 0.0;
    }
    default:
        return 0.0;
    }
}

} // namespace

std::string progress_text(const Progress& progress, double seconds) {
    std::string text = phase_texts[static_cast<std::size_t>(progress.phase.load())];
    const double share = std::min(share_of(progress), 1.0);
    if (share > 0.0) text += fmt::format(" {:.0f} %", 100 * share);
    // The first moments say little about the speed.
    if (share > 0.02 && seconds > 1.0)
        text += fmt::format(", about {} left", reports::duration_text(seconds / share - seconds));
    return text;
}

ProgressLine::ProgressLine() : shown_(::isatty(STDERR_FILENO) != 0 && terminal_is_able()) {
    if (shown_) thread_ = std::thread([this] { show(); });
}

ProgressLine::~ProgressLine() {
    if (!shown_) return;
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void ProgressLine::show() {
    std::unique_lock lock(mutex_);
    auto phase = Progress::Phase::reading;
    auto begin = Clock::now();
    if (wake_.wait_for(lock, quiet, [this] { return done_; })) return;
    while (!done_) {
        if (phase != progress_.phase) {
            phase = progress_.phase;
            begin = Clock::now();
        }
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        write_error(fmt::format("\r{}\033[K", progress_text(progress_, seconds)));
        wake_.wait_for(lock, interval, [this] { return done_; });
    }
    write_error("\r\033[K");
}

} // namespace cli
