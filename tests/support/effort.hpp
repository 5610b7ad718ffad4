// How often a test repeats itself.
#pragma once

#include <algorithm>
#include <cstdint>

#ifdef __has_feature
#define ROPSIM_HAS_FEATURE(name) __has_feature(name)
#else
#define ROPSIM_HAS_FEATURE(name) 0
#endif

namespace tests {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || ROPSIM_HAS_FEATURE(address_sanitizer) ||          \
    ROPSIM_HAS_FEATURE(thread_sanitizer)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

/// `count`, and a quarter of it under a sanitizer, where everything takes ten times as long.
constexpr std::uint64_t repetitions(std::uint64_t count) {
    return sanitized ? std::max<std::uint64_t>(1, count / 4) : count;
}

} // namespace tests
