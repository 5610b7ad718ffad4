// Pieces of work on oneTBB's threads; the loop behind parallel.hpp.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace pipeline {

/// What its maker wrote happens before every piece, and every piece happens before what follows its end of life, also
/// when an exception ends the loop. oneTBB promises the same, but the thread sanitizer does not see it. There are two
/// counters, so that no order is stated between pieces, whose races it is meant to find.
class TaskLoop {
  public:
    explicit TaskLoop(const std::function<void(std::size_t)>& body);
    ~TaskLoop();
    TaskLoop(const TaskLoop&) = delete;
    TaskLoop& operator=(const TaskLoop&) = delete;

    /// Runs body(i) for every i in [0, count) on at most `threads` threads (0 = all cores); the first exception ends
    /// the loop and is thrown on.
    void run(unsigned threads, std::size_t count);

  private:
    void piece(std::size_t i);

    const std::function<void(std::size_t)>* body_;
    std::atomic<std::size_t> begun_{0};
    std::atomic<std::size_t> ended_{0}; ///< pieces
};

} // namespace pipeline
