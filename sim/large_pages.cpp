#include "sim/large_pages.hpp"

#include <cstdint>
#include <new>
#include <sys/mman.h>

namespace sim {

namespace {

constexpr std::size_t large_page = std::size_t{1} << 21U;

} // namespace

void prefer_large_pages(const void* begin, std::size_t bytes) {
    const auto address = reinterpret_cast<std::uintptr_t>(begin);
    const std::uintptr_t first = (address + large_page - 1) / large_page * large_page;
    const std::uintptr_t end = (address + bytes) / large_page * large_page;
    auto* const bytes_of_block = const_cast<std::byte*>(static_cast<const std::byte*>(begin));
    if (first < end) ::madvise(bytes_of_block + (first - address), end - first, MADV_HUGEPAGE);
}

std::shared_ptr<std::byte[]> large_block(std::size_t bytes) {
    if (bytes < large_page) return std::shared_ptr<std::byte[]>(new std::byte[bytes]);
    constexpr std::align_val_t alignment{large_page};
    std::shared_ptr<std::byte[]> block(
        static_cast<std::byte*>(::operator new(bytes, alignment)),
        [](std::byte* memory) { ::operator delete (memory, std::align_val_t{large_page}); });
    prefer_large_pages(block.get(), bytes);
    return block;
}

} // namespace sim
