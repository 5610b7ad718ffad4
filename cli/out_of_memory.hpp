// What is said when memory runs out.
#pragma once

#include <string>

namespace cli {

/// One line: what was being made, how much more was asked for, how much is in use, and what limits it (ulimit -v, or
/// the machine). To be called where std::bad_alloc was caught.
std::string out_of_memory_text();

} // namespace cli
