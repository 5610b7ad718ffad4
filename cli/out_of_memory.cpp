#include "cli/out_of_memory.hpp"

#include "reports/comparison.hpp"
#include "reports/memory_limit.hpp"
#include "reports/numbers.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <new>
#include <unistd.h>

namespace {

// Of the last request that could not be met, and what was in use then.
std::atomic<std::size_t> refused_bytes{0}, used_bytes{0};

// Addresses that the process has; 0 where the system does not say. Needs no memory itself.
[[maybe_unused]] std::size_t bytes_in_use() {
    std::array<char, 64> text{};
    const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (file < 0) return 0;
    const ssize_t got = ::read(file, text.data(), text.size() - 1);
    ::close(file);
    if (got <= 0) return 0;
    return std::strtoull(text.data(), nullptr, 10) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

} // namespace

#if defined(__has_feature)
#define ROPSIM_HAS_FEATURE(name) __has_feature(name)
#else
#define ROPSIM_HAS_FEATURE(name) 0
#endif
// std::bad_alloc does not say how much was asked for. The usual operator delete gives memory to free(), as it has to be
// for this. The sanitizers have an operator new of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !ROPSIM_HAS_FEATURE(address_sanitizer) &&       \
    !ROPSIM_HAS_FEATURE(thread_sanitizer) && !ROPSIM_HAS_FEATURE(memory_sanitizer)
[[gnu::noinline]] void* operator new(std::size_t bytes) {
    if (void* memory = std::malloc(std::max<std::size_t>(bytes, 1))) return memory;
    refused_bytes = bytes;
    used_bytes = bytes_in_use();
    throw std::bad_alloc();
}
#endif

namespace cli {

std::string out_of_memory_text() {
    const auto refused = static_cast<double>(refused_bytes.load()), used = static_cast<double>(used_bytes.load());
    const reports::MemoryLimit limit = reports::memory_limit();
    const std::string state = refused == 0 ? ""
                                           : fmt::format("{} more needed, {} in use, ", reports::bytes_text(refused),
                                                         reports::bytes_text(used));
    return fmt::format("out of memory while {}: {}{} {}; a smaller scene, --size or --k, fewer --designs or fewer "
                       "--threads need less",
                       reports::latest_activity(), state, limit.whose, reports::bytes_text(limit.bytes));
}

} // namespace cli
