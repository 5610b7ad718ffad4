// Loops over independent pieces of work on the machine's cores.
#pragma once

#include <cstddef>
#include <functional>

namespace pipeline {

/// Runs body(i) for every i in [0, count) on at most `threads` threads (0 = all cores, 1 = in order, here). Pieces must
/// not depend on each other; the first exception ends the loop and is thrown on.
void parallel_for(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& body);

} // namespace pipeline
