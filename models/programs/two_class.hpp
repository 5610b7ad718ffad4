// Modify program two-class: of each pixel the nearest opaque fragment, and the nearest transparent one in front of it.
//
// What deferred shading keeps of a pixel, in one geometry pass and at full resolution. A transparent entry that an
// opaque fragment comes before is dropped for good, which no later fragment would restore: all transparent ones behind
// it lie behind the opaque one, too. So the outcome does not depend on the order of fragments, equal depths aside, of
// which the first arrival stays. Source: specification 003, section 5 (KG, KS).
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <bit>
#include <cstdint>
#include <memory>

namespace models {

/// An entry `wwwz`: three words that a workload packs, carried as the bits of floats, and the window depth. Words have
/// at most 30 bits, so that no float is infinite or NaN. The program reads but this of them:
struct TwoClassWords {
    static constexpr std::uint32_t most = (1U << 30U) - 1;
    static constexpr std::uint32_t class_word = 2, opacity_shift = 16, opaque = 255;

    static float packed(std::uint32_t word) { return std::bit_cast<float>(word); }
    static std::uint32_t word(float packed) { return std::bit_cast<std::uint32_t>(packed); }
    /// Bits 16 to 23 of the third word are the opacity in 255ths.
    static bool is_opaque(const float* entry) { return (word(entry[class_word]) >> opacity_shift & opaque) == opaque; }
};

inline constexpr std::uint32_t transparent_entry = 0, opaque_entry = 1, two_class_floats = 4;

/// Empty entries have depth 1, the far plane, and are opaque and otherwise 0.
std::shared_ptr<const pipeline::ModifyProgram> make_two_class();

} // namespace models
