#include "pipeline/functional/parallel.hpp"

#include "pipeline/functional/task_loop.hpp"

namespace pipeline {

namespace {

class CountAtEnd {
  public:
    explicit CountAtEnd(std::atomic<std::size_t>& count) : count_(count) {}
    ~CountAtEnd() { count_.fetch_add(1, std::memory_order_release); }
    CountAtEnd(const CountAtEnd&) = delete;
    CountAtEnd& operator=(const CountAtEnd&) = delete;

  private:
    std::atomic<std::size_t>& count_;
};

} // namespace

TaskLoop::TaskLoop(const std::function<void(std::size_t)>& body) : body_(&body) {
    begun_.store(1, std::memory_order_release);
}

TaskLoop::~TaskLoop() { static_cast<void>(ended_.load(std::memory_order_acquire)); }

// The load comes before everything else that is read from memory.
void TaskLoop::piece(std::size_t i) {
    static_cast<void>(begun_.load(std::memory_order_acquire));
    const CountAtEnd count(ended_);
    (*body_)(i);
}

void parallel_for(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& body) {
    if (threads == 1 || count < 2) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    TaskLoop(body).run(threads, count);
}

} // namespace pipeline
