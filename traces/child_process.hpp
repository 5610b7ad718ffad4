// Work on data that is not trusted, in a child process: what goes wrong there stays there.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace traces {

struct ChildResult {
    std::vector<unsigned char> bytes; ///< what the work wrote
    std::string failure;              ///< one line why there are none; "" where all went well
};

/// Gives a forked child `size` bytes of zero and room for a line to say what is wrong; `work` returns 0 where it filled
/// the bytes. A crash, an exception, and a child that computes for more than ten minutes are failures, too.
ChildResult in_child_process(std::size_t size,
                             const std::function<int(std::span<unsigned char>, std::span<char>)>& work);

/// A function of a module (ropsim_draco.so), which is loaded once. Throws sim::InputError that names the module and the
/// Debian package that it needs.
void* function_of_module(const char* file, const char* function, const char* purpose, const char* package);

/// The table of functions that it returns.
template <class Module>
const Module* load_module(const char* file, const char* function, const char* purpose, const char* package) {
    return reinterpret_cast<const Module* (*)()>(function_of_module(file, function, purpose, package))();
}

} // namespace traces
