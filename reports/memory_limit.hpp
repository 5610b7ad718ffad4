// How much memory the process may have.
#pragma once

#include <string_view>
#include <sys/resource.h>
#include <unistd.h>

namespace reports {

struct MemoryLimit {
    double bytes = 0;
    std::string_view whose; ///< "this machine has", "ulimit -v allows"
};

/// The smaller of the machine's memory and the limit on addresses (ulimit -v).
inline MemoryLimit memory_limit() {
    const double here = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
    rlimit limit{};
    const bool limited = ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
                         static_cast<double>(limit.rlim_cur) < here;
    if (limited) return {static_cast<double>(limit.rlim_cur), "ulimit -v allows"};
    return {here, "this machine has"};
}

} // namespace reports
