// Arithmetic of floats: IEEE single precision, each operation rounded once.
#include "pipeline/functional/number_formats.hpp"
#include "traces/spirv/component_wise.hpp"

namespace traces::spirv {

// Named, as other files have functions of the same names.
namespace real_lanes {
namespace {

Reals negative(Reals x) { return reals(words(x) ^ same(sign_bit)); }
Reals sum(Reals x, Reals y) { return x + y; }
Reals difference(Reals x, Reals y) { return x - y; }
Reals product(Reals x, Reals y) { return x * y; }
Reals quotient(Reals x, Reals y) { return x / y; }
/// The sign of the divisor (FMod) or of the dividend (FRem).
Reals floor_modulo(Reals x, Reals y) { return x - y * floored(x / y); }
Reals remainder_of(Reals x, Reals y) { return x - y * truncated(x / y); }

Words ordered(Reals x, Reals y) { return is_number(x) & is_number(y); }
Words equal(Reals x, Reals y) { return words(x == y); }
Words unequal(Reals x, Reals y) { return words(x != y) & ordered(x, y); }
Words less(Reals x, Reals y) { return words(x < y); }
Words greater(Reals x, Reals y) { return words(x > y); }
Words less_or_equal(Reals x, Reals y) { return words(x <= y); }
Words greater_or_equal(Reals x, Reals y) { return words(x >= y); }
// The unordered ones are also true where a NaN is compared.
Words unordered_equal(Reals x, Reals y) { return words(x == y) | ~ordered(x, y); }
Words unordered_unequal(Reals x, Reals y) { return words(x != y); }
Words unordered_less(Reals x, Reals y) { return ~words(x >= y); }
Words unordered_greater(Reals x, Reals y) { return ~words(x <= y); }
Words unordered_less_or_equal(Reals x, Reals y) { return ~words(x > y); }
Words unordered_greater_or_equal(Reals x, Reals y) { return ~words(x < y); }

Words is_nan(Reals x) { return ~is_number(x); }
Words is_infinite(Reals x) { return words((words(x) & same(~sign_bit)) == same(0x7F800000U)); }

/// Towards zero; what does not fit is cut to what does, NaN is 0: the same on every processor.
Wholes to_whole(Reals x) {
    constexpr float end = 0x1p31F;
    const Words fits = words(x >= same(-end)) & words(x < same(end));
    const Wholes whole = __builtin_convertvector(pick(fits, x, same(0.0F)), Wholes);
    return wholes(
        pick(words(x >= same(end)), same(0x7FFFFFFFU), pick(words(x < same(-end)), same(sign_bit), words(whole))));
}
Words to_natural(Reals x) {
    constexpr float half = 0x1p31F;
    const Words upper = words(x >= same(half)), none = ~words(x > same(0.0F));
    const Words low = words(to_whole(pick(upper, x - same(half), x)));
    return pick(none, same(0U), pick(words(x >= same(0x1p32F)), same(~0U), low + (upper & same(sign_bit))));
}
Reals from_whole(Wholes x) { return __builtin_convertvector(x, Reals); }
Reals from_natural(Words x) {
    Reals result{};
    for (int i = 0; i < 4; ++i) result[i] = static_cast<float>(x[i]);
    return result;
}
float through_half(float x) { return pipeline::half_to_float(pipeline::float_to_half(x)); }
Reals to_half(Reals x) { return by_lane<through_half>(x); }

// Differences within the quad; lane i is (i % 2, i / 2). The coarse ones take one pair for all four.
Reals dx(Reals v) {
    const float top = v[1] - v[0], bottom = v[3] - v[2];
    return Reals{top, top, bottom, bottom};
}
Reals dy(Reals v) {
    const float left = v[2] - v[0], right = v[3] - v[1];
    return Reals{left, right, left, right};
}
Reals dx_coarse(Reals v) { return same(v[1] - v[0]); }
Reals dy_coarse(Reals v) { return same(v[2] - v[0]); }
Reals width(Reals v) { return magnitude(dx(v)) + magnitude(dy(v)); }
Reals width_coarse(Reals v) { return magnitude(dx_coarse(v)) + magnitude(dy_coarse(v)); }

constexpr auto table = std::to_array<ComponentWise>({
    row<negative>(Op::f_negate, "rr"),
    row<sum>(Op::f_add, "rrr"),
    row<difference>(Op::f_sub, "rrr"),
    row<product>(Op::f_mul, "rrr"),
    row<quotient>(Op::f_div, "rrr"),
    row<floor_modulo>(Op::f_mod, "rrr"),
    row<remainder_of>(Op::f_rem, "rrr"),
    row<equal>(Op::f_ord_equal, "brr"),
    row<unequal>(Op::f_ord_not_equal, "brr"),
    row<less>(Op::f_ord_less_than, "brr"),
    row<greater>(Op::f_ord_greater_than, "brr"),
    row<less_or_equal>(Op::f_ord_less_than_equal, "brr"),
    row<greater_or_equal>(Op::f_ord_greater_than_equal, "brr"),
    row<unordered_equal>(Op::f_unord_equal, "brr"),
    row<unordered_unequal>(Op::f_unord_not_equal, "brr"),
    row<unordered_less>(Op::f_unord_less_than, "brr"),
    row<unordered_greater>(Op::f_unord_greater_than, "brr"),
    row<unordered_less_or_equal>(Op::f_unord_less_than_equal, "brr"),
    row<unordered_greater_or_equal>(Op::f_unord_greater_than_equal, "brr"),
    row<is_nan>(Op::is_nan, "br"),
    row<is_infinite>(Op::is_inf, "br"),
    row<to_whole>(Op::convert_float_to_signed, "ir"),
    row<to_natural>(Op::convert_float_to_unsigned, "ir"),
    row<from_whole>(Op::convert_signed_to_float, "ri"),
    row<from_natural>(Op::convert_unsigned_to_float, "ri"),
    row<to_half>(Op::quantize_to_half, "rr"),
    row<dx>(Op::dpdx, "rr"),
    row<dy>(Op::dpdy, "rr"),
    row<width>(Op::fwidth, "rr"),
    row<dx>(Op::dpdx_fine, "rr"),
    row<dy>(Op::dpdy_fine, "rr"),
    row<width>(Op::fwidth_fine, "rr"),
    row<dx_coarse>(Op::dpdx_coarse, "rr"),
    row<dy_coarse>(Op::dpdy_coarse, "rr"),
    row<width_coarse>(Op::fwidth_coarse, "rr"),
});

} // namespace
} // namespace real_lanes

std::span<const ComponentWise> real_operations() { return real_lanes::table; }

} // namespace traces::spirv
