// "simulating 42 %, about 12 s left" on standard error, when that is a terminal.
#pragma once

#include "reports/comparison.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace cli {

class ProgressLine {
  public:
    /// Shows nothing for the first half second, then five times a second.
    ProgressLine();
    /// Wipes the line.
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// Null when nobody would see it.
    reports::Progress* progress() { return shown_ ? &progress_ : nullptr; }

  private:
    void show();

    bool shown_;
    reports::Progress progress_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool done_ = false;
    std::thread thread_;
};

/// The text of the line; `seconds` since the present phase began.
std::string progress_text(const reports::Progress& progress, double seconds);

} // namespace cli
