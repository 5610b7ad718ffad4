// GLSL.std.450, component by component. Transcendental functions are those of the C library: the same for g++ and
// clang.
#include "traces/spirv/component_wise.hpp"

#include <algorithm>
#include <bit>

namespace traces::spirv {

// Named, as other files have functions of the same names.
namespace std450_lanes {
namespace {

Reals round_even(Reals x) {
    // Adding 2^23 with the sign of x leaves no bits for a fraction.
    const Words small = words(magnitude(x) < same(0x1p23F));
    const Reals magic = reals(words(same(0x1p23F)) | (words(x) & same(sign_bit)));
    const Reals rounded = reals(words(magnitude((x + magic) - magic)) | (words(x) & same(sign_bit)));
    return pick(small, rounded, x);
}
Reals ceiled(Reals x) { return -floored(-x); }
Reals fraction(Reals x) { return x - floored(x); }
Reals sign(Reals x) {
    const Words one = words(same(1.0F));
    return reals((words(x > same(0.0F)) & one) | (words(x < same(0.0F)) & words(same(-1.0F))));
}
Words whole_magnitude(Words x) { return pick(words(wholes(x) < wholes(same(0U))), -x, x); }
Words whole_sign(Words x) {
    return words(wholes(x) < wholes(same(0U))) | (words(wholes(x) > wholes(same(0U))) & same(1U));
}

Reals radians(Reals x) { return x * same(0.017453292519943295F); }
Reals degrees(Reals x) { return x * same(57.29577951308232F); }

float sine(float x) { return std::sin(x); }
float cosine(float x) { return std::cos(x); }
float tangent(float x) { return std::tan(x); }
float arc_sine(float x) { return std::asin(x); }
float arc_cosine(float x) { return std::acos(x); }
float arc_tangent(float x) { return std::atan(x); }
float sine_h(float x) { return std::sinh(x); }
float cosine_h(float x) { return std::cosh(x); }
float tangent_h(float x) { return std::tanh(x); }
float arc_sine_h(float x) { return std::asinh(x); }
float arc_cosine_h(float x) { return std::acosh(x); }
float arc_tangent_h(float x) { return std::atanh(x); }
float arc_tangent_2(float y, float x) { return std::atan2(y, x); }
float power(float x, float y) { return std::pow(x, y); }
float exponential(float x) { return std::exp(x); }
float logarithm(float x) { return std::log(x); }
float exponential_2(float x) { return std::exp2(x); }
float logarithm_2(float x) { return std::log2(x); }
float scaled(float x, float exponent) { return std::ldexp(x, static_cast<int>(std::bit_cast<std::int32_t>(exponent))); }

Reals inverse_root(Reals x) { return same(1.0F) / roots(x); }
Reals load_exponent(Reals x, Wholes exponent) { return by_lane<scaled>(x, reals(words(exponent))); }

Reals clamped(Reals x, Reals low, Reals high) { return least(greatest(x, low), high); }
Reals mix(Reals x, Reals y, Reals a) { return x * (same(1.0F) - a) + y * a; }
Reals step(Reals edge, Reals x) { return pick(words(x < edge), same(0.0F), same(1.0F)); }
Reals smooth_step(Reals low, Reals high, Reals x) {
    const Reals t = clamped((x - low) / (high - low), same(0.0F), same(1.0F));
    return t * t * (same(3.0F) - same(2.0F) * t);
}
Reals multiply_add(Reals a, Reals b, Reals c) { return a * b + c; } // rounded twice, which GLSL allows

// Of a number and a NaN these give the number.
Reals number_least(Reals x, Reals y) { return pick(is_number(x), pick(is_number(y), least(x, y), x), y); }
Reals number_greatest(Reals x, Reals y) { return pick(is_number(x), pick(is_number(y), greatest(x, y), x), y); }
Reals number_clamped(Reals x, Reals low, Reals high) { return number_least(number_greatest(x, low), high); }

Words natural_least(Words x, Words y) { return pick(words(y < x), y, x); }
Words natural_greatest(Words x, Words y) { return pick(words(x < y), y, x); }
Words natural_clamped(Words x, Words low, Words high) { return natural_least(natural_greatest(x, low), high); }
Words whole_least(Wholes x, Wholes y) { return pick(words(y < x), words(y), words(x)); }
Words whole_greatest(Wholes x, Wholes y) { return pick(words(x < y), words(y), words(x)); }
Words whole_clamped(Wholes x, Wholes low, Wholes high) { return whole_least(wholes(whole_greatest(x, low)), high); }

template <std::uint32_t (*function)(std::uint32_t)>
Words by_word(Words x) {
    return Words{function(x[0]), function(x[1]), function(x[2]), function(x[3])};
}
/// Number of a bit; all ones when there is none.
std::uint32_t lowest_bit(std::uint32_t x) { return x == 0 ? ~0U : static_cast<std::uint32_t>(std::countr_zero(x)); }
std::uint32_t highest_bit(std::uint32_t x) { return static_cast<std::uint32_t>(std::bit_width(x)) - 1; }
std::uint32_t highest_signed_bit(std::uint32_t x) { return highest_bit((x & sign_bit) != 0 ? ~x : x); }

constexpr auto table = std::to_array<ComponentWise>({
    row<round_even>(Std450::round, "rr"),
    row<round_even>(Std450::round_even, "rr"),
    row<truncated>(Std450::trunc, "rr"),
    row<magnitude>(Std450::f_abs, "rr"),
    row<whole_magnitude>(Std450::s_abs, "ii"),
    row<sign>(Std450::f_sign, "rr"),
    row<whole_sign>(Std450::s_sign, "ii"),
    row<floored>(Std450::floor, "rr"),
    row<ceiled>(Std450::ceil, "rr"),
    row<fraction>(Std450::fract, "rr"),
    row<radians>(Std450::radians, "rr"),
    row<degrees>(Std450::degrees, "rr"),
    row<by_lane<sine>>(Std450::sin, "rr"),
    row<by_lane<cosine>>(Std450::cos, "rr"),
    row<by_lane<tangent>>(Std450::tan, "rr"),
    row<by_lane<arc_sine>>(Std450::asin, "rr"),
    row<by_lane<arc_cosine>>(Std450::acos, "rr"),
    row<by_lane<arc_tangent>>(Std450::atan, "rr"),
    row<by_lane<sine_h>>(Std450::sinh, "rr"),
    row<by_lane<cosine_h>>(Std450::cosh, "rr"),
    row<by_lane<tangent_h>>(Std450::tanh, "rr"),
    row<by_lane<arc_sine_h>>(Std450::asinh, "rr"),
    row<by_lane<arc_cosine_h>>(Std450::acosh, "rr"),
    row<by_lane<arc_tangent_h>>(Std450::atanh, "rr"),
    row<by_lane<arc_tangent_2>>(Std450::atan2, "rrr"),
    row<by_lane<power>>(Std450::pow, "rrr"),
    row<by_lane<exponential>>(Std450::exp, "rr"),
    row<by_lane<logarithm>>(Std450::log, "rr"),
    row<by_lane<exponential_2>>(Std450::exp2, "rr"),
    row<by_lane<logarithm_2>>(Std450::log2, "rr"),
    row<roots>(Std450::sqrt, "rr"),
    row<inverse_root>(Std450::inverse_sqrt, "rr"),
    row<least>(Std450::f_min, "rrr"),
    row<greatest>(Std450::f_max, "rrr"),
    row<natural_least>(Std450::u_min, "iii"),
    row<natural_greatest>(Std450::u_max, "iii"),
    row<whole_least>(Std450::s_min, "iii"),
    row<whole_greatest>(Std450::s_max, "iii"),
    row<clamped>(Std450::f_clamp, "rrrr"),
    row<natural_clamped>(Std450::u_clamp, "iiii"),
    row<whole_clamped>(Std450::s_clamp, "iiii"),
    row<number_least>(Std450::n_min, "rrr"),
    row<number_greatest>(Std450::n_max, "rrr"),
    row<number_clamped>(Std450::n_clamp, "rrrr"),
    row<mix>(Std450::f_mix, "rrrr"),
    row<step>(Std450::step, "rrr"),
    row<smooth_step>(Std450::smooth_step, "rrrr"),
    row<multiply_add>(Std450::fma, "rrrr"),
    row<load_exponent>(Std450::ldexp, "rri"),
    row<by_word<lowest_bit>>(Std450::find_i_lsb, "ii"),
    row<by_word<highest_signed_bit>>(Std450::find_s_msb, "ii"),
    row<by_word<highest_bit>>(Std450::find_u_msb, "ii"),
});

} // namespace
} // namespace std450_lanes

std::span<const ComponentWise> std450_operations() { return std450_lanes::table; }

} // namespace traces::spirv
