#include "pipeline/functional/parallel.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace pipeline {

void parallel_for(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& body) {
    if (threads == 1 || count < 2) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    const int limit = threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads);
    tbb::task_arena arena(limit);
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { body(i); }); });
}

} // namespace pipeline
