// The sort of A7 (Bavoil 2007, section 6.3): of k sorted entries and one more, the nearest leaves, the others stay.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace models {

/// Entries of `floats` floats, the depth at `slot`. Of equal depths the one that came first leaves first. Entries that
/// a torn read left unsorted go through the same exchanges.
template <std::uint32_t floats, std::uint32_t slot>
struct NearlySorted {
    using Entry = std::array<float, floats>;

    static Entry push_pop(float* entries, std::uint32_t k, const float* fragment) {
        Entry popped;
        std::copy_n(fragment, floats, popped.begin());
        const float depth = fragment[slot];
        if (!(entries[slot] <= depth)) return popped;
        std::swap_ranges(popped.begin(), popped.end(), entries);
        for (float *entry = entries + floats, *end = entries + std::size_t{k} * floats; entry != end; entry += floats)
            if (entry[slot] <= depth) std::swap_ranges(entry, entry + floats, entry - floats);
        return popped;
    }

    /// Compares and moves of push_pop: a compare and an exchange for each entry, one of them with the fragment, and a
    /// move that keeps the fragment's depth.
    static constexpr std::uint32_t operations(std::uint32_t k) { return k * (1 + 2 * floats) + 1; }
};

} // namespace models
