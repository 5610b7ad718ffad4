// The wake-ups of one clock domain: a wheel of the next 1024 edges with one bit per component, and a heap for later
// ones.
//
// Components that are busy, or wait for a memory, are within the wheel's reach: waking one sets a bit, waking it twice
// sets the same bit, and the components due at an edge are found in the order in which they were added.
#pragma once

#include "sim/time.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace sim {

class WakeQueue {
  public:
    static constexpr Cycle reach = 1024;
    static constexpr Cycle none = ~Cycle{0};

    /// Numbers from 0.
    std::uint32_t add_component();
    std::size_t component_count() const { return component_count_; }

    /// The edge that is being served, or was last; `none` before the first.
    Cycle current() const { return current_; }

    /// Files a wake-up at an edge after the present one, if the wheel reaches that far.
    bool wake_near(std::uint32_t component, Cycle at) {
        if (at - current_ - 1 >= reach - 1) return false;
        const Cycle slot = at % reach;
        wheel_[slot * words_ + component / 64] |= std::uint64_t{1} << (component % 64);
        occupied_[slot / 64] |= std::uint64_t{1} << (slot % 64);
        return true;
    }
    /// Files a wake-up at any edge after the present one.
    void wake(std::uint32_t component, Cycle at);

    /// The first edge with a wake-up, or `none`.
    Cycle next() const {
        const Cycle first = current_ + 1;
        const Cycle slot = first % reach;
        const std::uint64_t word = occupied_[slot / 64] >> (slot % 64);
        const Cycle later = far_.empty() ? none : far_.front().at;
        if (word == 0) return std::min(later, next_after(first - slot % 64, slot / 64));
        return std::min(later, first + static_cast<Cycle>(std::countr_zero(word)));
    }

    /// Makes `edge` the present one. No wake-up may be filed before it.
    void advance(Cycle edge);

    /// The components due at the present edge, 64 at a time; taking them removes their wake-ups.
    std::size_t words() const { return words_; }
    std::uint64_t take(std::size_t word) {
        const Cycle slot = current_ % reach;
        occupied_[slot / 64] &= ~(std::uint64_t{1} << (slot % 64));
        return std::exchange(wheel_[slot * words_ + word], 0);
    }
    /// Files wake-ups of up to 64 components at the edge after the present one.
    void wake_next(std::size_t word, std::uint64_t components) {
        if (components == 0) return;
        const Cycle slot = (current_ + 1) % reach;
        wheel_[slot * words_ + word] |= components;
        occupied_[slot / 64] |= std::uint64_t{1} << (slot % 64);
    }

  private:
    struct FarWake {
        Cycle at;
        std::uint32_t component;
        bool operator>(const FarWake& other) const {
            return at != other.at ? at > other.at : component > other.component;
        }
    };
    /// The first occupied slot after word `word`, whose first slot is that of edge `edge`.
    Cycle next_after(Cycle edge, Cycle word) const;

    Cycle current_ = none;
    std::uint32_t component_count_ = 0;
    std::size_t words_ = 0;                            ///< of 64 bits, per slot
    std::vector<std::uint64_t> wheel_;                 ///< words_ for each of `reach` slots
    std::array<std::uint64_t, reach / 64> occupied_{}; ///< slots with a wake-up
    std::vector<Cycle> far_asked_; ///< by component, the edge last filed in `far_`: waiting components ask for it again
    std::vector<FarWake> far_;     ///< a heap, the earliest first
};

} // namespace sim
