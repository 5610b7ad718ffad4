// The bubble pass of A6 (Bavoil 2007, section 4.4).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace models {

/// Entries of `floats` floats, the depth at `slot`.
template <std::uint32_t floats, std::uint32_t slot>
struct Insertion {
    using Entry = std::array<float, floats>;

    /// Exchanges `left`, at first the fragment, with the entries that it is nearer than; `left` is what falls out at
    /// the end. Returns whether the entries changed.
    static bool exchange(float* pixel, std::uint32_t k, Entry& left) {
        return exchange_from(pixel, k, left, [&](float depth) { return left[slot] < depth; });
    }
    /// The same, but it goes before entries of equal depth, too.
    static bool exchange_latest_first(float* pixel, std::uint32_t k, Entry& left) {
        return exchange_from(pixel, k, left, [&](float depth) { return left[slot] <= depth; });
    }

    /// A compare per entry, and a move out and a move in per float of it (specification 004, section 7.3).
    static constexpr std::uint32_t operations(std::uint32_t k) { return k * (1 + 2 * floats); }

  private:
    template <class Nearer>
    static bool exchange_from(float* pixel, std::uint32_t k, Entry& left, Nearer nearer) {
        float* const end = pixel + std::size_t{k} * floats;
        float* entry = pixel;
        while (entry != end && !nearer(entry[slot])) entry += floats;
        if (entry == end) return false;
        std::swap_ranges(left.begin(), left.end(), entry);
        // What is left over now arrived before every entry of equal depth behind it, so it goes before them.
        for (entry += floats; entry != end; entry += floats)
            if (left[slot] <= entry[slot]) std::swap_ranges(left.begin(), left.end(), entry);
        return true;
    }
};

} // namespace models
