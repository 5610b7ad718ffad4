// Seconds of this machine since it was made.
#pragma once

#include <chrono>
#include <ctime>

namespace reports {

class Stopwatch {
  public:
    /// Of the calling thread, and without the time it waited for a core.
    static double thread_seconds() {
        timespec now{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

} // namespace reports
