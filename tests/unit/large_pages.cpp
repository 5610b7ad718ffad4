// Memory in large pages is memory as any other.
#include "sim/large_pages.hpp"

#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>

namespace large_pages_test {

constexpr std::size_t large_page = std::size_t{1} << 21U;

TEST(LargePages, ABlockThatFillsOneBeginsWithIt) {
    for (const std::size_t bytes : {std::size_t{1}, large_page - 1, large_page, 3 * large_page + 5}) {
        const auto block = sim::large_block(bytes);
        const bool fills_one = bytes >= large_page;
        EXPECT_TRUE(!fills_one || reinterpret_cast<std::uintptr_t>(block.get()) % large_page == 0) << bytes;
        std::fill(block.get(), block.get() + bytes, std::byte{7});
        EXPECT_EQ(block.get()[bytes - 1], std::byte{7});
    }
}

TEST(LargePages, AWishForThemChangesNothing) {
    std::vector<std::byte> bytes(3 * large_page, std::byte{3});
    for (const std::size_t size : {std::size_t{0}, std::size_t{100}, bytes.size()})
        sim::prefer_large_pages(bytes.data(), size);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), std::byte{3}), static_cast<std::ptrdiff_t>(bytes.size()));
    sim::prefer_large_pages(nullptr, 0);
    std::vector<std::uint64_t> numbers;
    sim::resize_in_large_pages(numbers, large_page);
    EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 0U), static_cast<std::ptrdiff_t>(large_page));
}

} // namespace large_pages_test
