// The only source that includes oneTBB. Neither its library nor what its headers expand to here is instrumented by the
// thread sanitizer, which would see only one half of how they synchronise; see the layer's CMakeLists.txt.
#include "pipeline/functional/task_loop.hpp"

#include <algorithm>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace pipeline {

void TaskLoop::run(unsigned threads, std::size_t count) {
    const auto cores = static_cast<unsigned>(tbb::info::default_concurrency());
    tbb::task_arena arena(static_cast<int>(threads == 0 ? cores : std::min(threads, cores)));
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, [this](std::size_t i) { piece(i); }); });
}

} // namespace pipeline
