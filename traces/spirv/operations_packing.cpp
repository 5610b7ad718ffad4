// Numbers taken apart: fraction and whole, significand and exponent, several in a word.
#include "pipeline/functional/number_formats.hpp"
#include "traces/spirv/component_wise.hpp"

#include <algorithm>

namespace traces::spirv {

void modf_pair(Run& run, const Operation& operation) {
    for (Slot i = 0; i < operation.c; ++i) {
        const Reals x = reals(run.file[operation.a + i]), whole = truncated(x);
        // An infinity has no fraction.
        const Words same_value = words(x == whole);
        run.file[operation.result + i] = pick(same_value, words(x) & same(sign_bit), words(x - whole));
        run.file[operation.result + operation.c + i] = words(whole);
    }
}

void frexp_pair(Run& run, const Operation& operation) {
    for (Slot i = 0; i < operation.c; ++i) {
        const Reals x = reals(run.file[operation.a + i]);
        Reals significand{};
        Wholes exponent{};
        for (int lane = 0; lane < 4; ++lane) {
            int power = 0;
            significand[lane] = std::frexp(x[lane], &power);
            exponent[lane] = std::isfinite(x[lane]) ? power : 0;
        }
        run.file[operation.result + i] = words(significand);
        run.file[operation.result + operation.c + i] = words(exponent);
    }
}

namespace {

/// `bits` of the word hold code / largest, of [0,1] or of [-1,1].
template <unsigned bits, bool negative>
struct Normalised {
    static constexpr float largest = static_cast<float>((1U << (negative ? bits - 1 : bits)) - 1U);
    static std::uint32_t encode(float value) {
        const float clamped = value > (negative ? -1.0F : 0.0F) ? std::min(value, 1.0F) : (negative ? -1.0F : 0.0F);
        const double code = pipeline::round_even(static_cast<double>(clamped * largest));
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(value != value ? 0.0 : code)) & ((1U << bits) - 1U);
    }
    static float decode(std::uint32_t code) {
        if constexpr (!negative) return static_cast<float>(code) / largest;
        const auto number = static_cast<std::int32_t>(code << (32U - bits)) >> (32U - bits);
        return std::max(-1.0F, static_cast<float>(number) / largest);
    }
};
struct Half {
    static std::uint32_t encode(float value) { return pipeline::float_to_half(value); }
    static float decode(std::uint32_t code) { return pipeline::half_to_float(static_cast<std::uint16_t>(code)); }
};

template <class Format, unsigned bits>
void pack(Run& run, const Operation& operation) {
    Words result{};
    for (unsigned part = 0; part < 32 / bits; ++part) {
        const Reals x = reals(run.file[operation.a + static_cast<Slot>(part)]);
        for (int lane = 0; lane < 4; ++lane) result[lane] |= Format::encode(x[lane]) << (part * bits);
    }
    run.file[operation.result] = result;
}

template <class Format, unsigned bits>
void unpack(Run& run, const Operation& operation) {
    for (unsigned part = 0; part < 32 / bits; ++part) {
        const Words x = run.file[operation.a] >> (part * bits) & ((1U << bits) - 1U);
        run.file[operation.result + static_cast<Slot>(part)] =
            words(Reals{Format::decode(x[0]), Format::decode(x[1]), Format::decode(x[2]), Format::decode(x[3])});
    }
}

} // namespace

Handler packing(Std450 function) {
    switch (function) {
    case Std450::pack_snorm_4x8:
        return pack<Normalised<8, true>, 8>;
    case Std450::pack_unorm_4x8:
        return pack<Normalised<8, false>, 8>;
    case Std450::pack_snorm_2x16:
        return pack<Normalised<16, true>, 16>;
    case Std450::pack_unorm_2x16:
        return pack<Normalised<16, false>, 16>;
    case Std450::pack_half_2x16:
        return pack<Half, 16>;
    case Std450::unpack_snorm_4x8:
        return unpack<Normalised<8, true>, 8>;
    case Std450::unpack_unorm_4x8:
        return unpack<Normalised<8, false>, 8>;
    case Std450::unpack_snorm_2x16:
        return unpack<Normalised<16, true>, 16>;
    case Std450::unpack_unorm_2x16:
        return unpack<Normalised<16, false>, 16>;
    case Std450::unpack_half_2x16:
        return unpack<Half, 16>;
    default:
        return nullptr;
    }
}

std::uint32_t packed_parts(Std450 function) {
    switch (function) {
    case Std450::pack_snorm_4x8:
    case Std450::pack_unorm_4x8:
    case Std450::unpack_snorm_4x8:
    case Std450::unpack_unorm_4x8:
        return 4;
    default:
        return 2;
    }
}

} // namespace traces::spirv
