// Shifts and divisions give the same.
#include "pipeline/memory/divisor.hpp"

#include <gtest/gtest.h>

namespace memory_divisor_test {

TEST(Divisor, QuotientsAndRemaindersAreThoseOfDivision) {
    for (const std::uint64_t number : {1ULL, 2ULL, 3ULL, 12ULL, 256ULL, 4096ULL, 1ULL << 40U, ~0ULL}) {
        const pipeline::Divisor divisor(number);
        for (const std::uint64_t of : {0ULL, 1ULL, 255ULL, 256ULL, 257ULL, 123'456'789'012ULL, ~0ULL}) {
            EXPECT_EQ(divisor.quotient(of), of / number) << of << " / " << number;
            EXPECT_EQ(divisor.remainder(of), of % number) << of << " % " << number;
        }
    }
}

} // namespace memory_divisor_test
