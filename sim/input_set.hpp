// The inputs of one component that hold messages, for units with many ports.
#pragma once

#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace sim {

template <class T>
class In;

/// Which of a component's inputs hold a message, one that is on its way included: a unit with many ports asks here
/// and not at each of them. Belongs to the component and outlives its ports; for up to 256 of them.
class InputSet {
  public:
    static constexpr std::uint32_t most = 256;

    /// Calls `visit` with the numbers of those from `begin` to before `end` in turn, until it returns true; whether it
    /// did.
    template <class Visit>
    bool any(std::uint32_t begin, std::uint32_t end, Visit visit) const {
        for (std::uint32_t word = begin / 64; word < words_ && 64 * word < end; ++word) {
            std::uint64_t left = held_[word];
            if (word == begin / 64) left &= ~std::uint64_t{0} << begin % 64;
            for (; left != 0; left &= left - 1) {
                const std::uint32_t input = word * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
                if (input >= end) return false;
                if (visit(input)) return true;
            }
        }
        return false;
    }
    /// All of them in turn, from `first` on and round.
    template <class Visit>
    bool any_from(std::uint32_t first, Visit visit) const {
        return any(first, most, visit) || any(0, first, visit);
    }
    bool empty() const {
        return std::all_of(held_.begin(), held_.begin() + words_, [](std::uint64_t word) { return word == 0; });
    }

  private:
    template <class T>
    friend class In;
    std::uint64_t& word_of(std::uint32_t input) {
        CHECK(input < most);
        words_ = std::max(words_, input / 64 + 1);
        return held_[input / 64];
    }
    std::array<std::uint64_t, most / 64> held_{};
    std::uint32_t words_ = 0; ///< in use
};

} // namespace sim
