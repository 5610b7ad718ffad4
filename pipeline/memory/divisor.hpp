// Division by a number that does not change.
#pragma once

#include "sim/check.hpp"

#include <bit>
#include <cstdint>

namespace pipeline {

/// Shifts where the number is a power of two, as sizes in memory mostly are.
class Divisor {
  public:
    explicit Divisor(std::uint64_t number)
        : number_(number), shift_(std::has_single_bit(number) ? std::countr_zero(number) : -1) {
        CHECK(number != 0);
    }
    std::uint64_t number() const { return number_; }
    std::uint64_t quotient(std::uint64_t of) const { return shift_ >= 0 ? of >> shift_ : of / number_; }
    std::uint64_t remainder(std::uint64_t of) const { return shift_ >= 0 ? of & (number_ - 1) : of % number_; }

  private:
    std::uint64_t number_;
    int shift_;
};

} // namespace pipeline
