// The register file of a quad: slots of four lanes, one for each 32-bit scalar. GCC's and clang's portable vector
// types, so that each operation on a slot is one instruction of the processor, and the same bytes come out of both
// compilers.
#pragma once

#include <cstdint>

namespace traces::spirv {

using Words [[gnu::vector_size(16)]] = std::uint32_t;
using Wholes [[gnu::vector_size(16)]] = std::int32_t;
using Reals [[gnu::vector_size(16)]] = float;

/// Place in the register file, counted in slots from what a run may change; negative ones hold constants and uniforms.
using Slot = std::int32_t;

inline Words words(Reals lanes) { return (Words)lanes; }
inline Words words(Wholes lanes) { return (Words)lanes; }
inline Words words(Words lanes) { return lanes; }
inline Reals reals(Words lanes) { return (Reals)lanes; }
inline Wholes wholes(Words lanes) { return (Wholes)lanes; }

inline Words same(std::uint32_t word) { return Words{word, word, word, word}; }
inline Reals same(float number) { return Reals{number, number, number, number}; }

/// Lane by lane `a` where the mask is all ones, `b` where it is 0.
inline Words pick(Words mask, Words a, Words b) { return (mask & a) | (~mask & b); }
inline Reals pick(Words mask, Reals a, Reals b) { return reals(pick(mask, words(a), words(b))); }

/// All ones in the lanes whose bits are set.
inline Words mask_of(unsigned lanes) {
    const auto lane = [&](unsigned i) { return (lanes >> i & 1U) != 0 ? ~0U : 0U; };
    return Words{lane(0), lane(1), lane(2), lane(3)};
}
/// The bits of lanes that are not 0.
inline unsigned lanes_of(Words mask) {
    unsigned lanes = 0;
    for (unsigned i = 0; i < 4; ++i) lanes |= mask[i] != 0 ? 1U << i : 0U;
    return lanes;
}

} // namespace traces::spirv
