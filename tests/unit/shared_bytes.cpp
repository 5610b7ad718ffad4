// Bytes that several owners hold: never copied, compared by what they are.
#include "pipeline/shared_bytes.hpp"

#include <gtest/gtest.h>

namespace shared_bytes_test {

using pipeline::SharedBytes;

TEST(SharedBytes, AVectorIsTakenOverAndCopiesShareIt) {
    std::vector<std::byte> bytes(100, std::byte{1});
    const std::byte* const place = bytes.data();
    SharedBytes one(std::move(bytes));
    const SharedBytes other = one;
    EXPECT_EQ(one.data(), place);
    EXPECT_EQ(other.data(), place);
    one = {};
    EXPECT_TRUE(one.empty());
    EXPECT_EQ(other.size(), 100U);
    EXPECT_EQ(other[99], std::byte{1});
}

TEST(SharedBytes, EqualBytesAreEqualWhereverTheyLie) {
    const std::shared_ptr<std::byte[]> block(new std::byte[4]{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}});
    const SharedBytes three(block, 3);
    EXPECT_TRUE(three == SharedBytes({std::byte{1}, std::byte{2}, std::byte{3}}));
    EXPECT_FALSE(three == SharedBytes(block, 4));
    EXPECT_TRUE(SharedBytes() == SharedBytes(std::vector<std::byte>()));
}

} // namespace shared_bytes_test
