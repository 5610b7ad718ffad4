// Memory of the host in large pages. A page costs the host a fault when it is first written to, up to 20 microseconds
// in a virtual machine: with 4 KiB at a time that is longer than to fill it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace sim {

/// Asks for large pages (2 MiB) within `bytes` bytes from `begin` on, to which nothing was written yet. No more than a
/// wish: where they hold no whole large page, or the host has none, nothing changes.
void prefer_large_pages(const void* begin, std::size_t bytes);

/// Memory for `bytes` bytes, not cleared, which begins with a large page where it fills one.
std::shared_ptr<std::byte[]> large_block(std::size_t bytes);

/// resize() of an empty vector.
template <class T>
void resize_in_large_pages(std::vector<T>& empty, std::size_t size) {
    empty.reserve(size);
    prefer_large_pages(empty.data(), size * sizeof(T));
    empty.resize(size);
}

} // namespace sim
