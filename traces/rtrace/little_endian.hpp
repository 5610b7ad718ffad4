// Whole numbers as little-endian bytes, whatever the host.
#pragma once

#include <concepts>
#include <cstddef>
#include <span>

namespace traces::rtrace {

template <std::unsigned_integral T>
constexpr void put_little(std::byte* to, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) to[i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFU);
}

template <std::unsigned_integral T>
constexpr T get_little(const std::byte* from) {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value | static_cast<T>(from[i]) << (8 * i));
    return value;
}

} // namespace traces::rtrace
