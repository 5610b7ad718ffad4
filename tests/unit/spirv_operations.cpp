// What each operation computes, against the same formula in plain C++.
#include "tests/support/spirv_assembler.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace spirv_operations_test {

namespace {

using tests::SpirvAssembler;
using tests::SpirvRun;
using traces::spirv::LaneWords;
using traces::spirv::Op;
using traces::spirv::Std450;

constexpr float infinity = std::numeric_limits<float>::infinity(),
                not_a_number = std::numeric_limits<float>::quiet_NaN();

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }
std::uint32_t bits(std::int32_t value) { return static_cast<std::uint32_t>(value); }

enum class Of { real, whole, natural, truth };

SpirvAssembler::Id type_of(SpirvAssembler& a, Of of) {
    switch (of) {
    case Of::real:
        return a.real();
    case Of::whole:
        return a.whole();
    case Of::natural:
        return a.natural();
    default:
        return a.truth();
    }
}

/// Runs `op` (or a function of the extended set) on vectors of `n` equal components and returns the last of them.
/// Truths go in and come out as whole numbers.
LaneWords apply(Op op, Std450 function, Of result, const std::vector<Of>& kinds, const std::vector<LaneWords>& operands,
                std::uint32_t n) {
    SpirvAssembler a;
    SpirvAssembler::Words ids;
    const auto shape = [&](Of of) { return a.vector(type_of(a, of), n); };
    const auto zero = [&] {
        return n == 1 ? a.constant(0) : a.composite(shape(Of::whole), SpirvAssembler::Words(n, a.constant(0)));
    };
    const auto one = [&] {
        return n == 1 ? a.constant(1) : a.composite(shape(Of::whole), SpirvAssembler::Words(n, a.constant(1)));
    };
    for (std::uint32_t i = 0; i < kinds.size(); ++i) {
        const Of outside = kinds[i] == Of::truth ? Of::whole : kinds[i];
        const auto loaded = a.load(a.input(shape(outside), i), shape(outside));
        ids.push_back(kinds[i] == Of::truth ? a.result(Op::i_not_equal, shape(Of::truth), {loaded, zero()}) : loaded);
    }
    auto computed = op == Op::ext_inst ? a.extended(function, shape(result), ids) : a.result(op, shape(result), ids);
    const Of outside = result == Of::truth ? Of::whole : result;
    if (result == Of::truth) computed = a.result(Op::select, shape(outside), {computed, one(), zero()});
    a.store(a.output(shape(outside), 0), computed);
    SpirvRun run(a.module());
    for (std::uint32_t i = 0; i < operands.size(); ++i)
        for (std::uint32_t k = 0; k < n; ++k) run.quad.set_words(run.input(i), k, operands[i]);
    run.run();
    for (std::uint32_t k = 1; k < n; ++k) EXPECT_EQ(run.words(0, k), run.words(0, 0)) << "component " << k;
    return run.words(0, n - 1);
}

LaneWords apply(Op op, Of result, const std::vector<Of>& kinds, const std::vector<LaneWords>& operands,
                std::uint32_t n = 3) {
    return apply(op, {}, result, kinds, operands, n);
}
LaneWords apply(Std450 function, Of result, const std::vector<Of>& kinds, const std::vector<LaneWords>& operands,
                std::uint32_t n = 2) {
    return apply(Op::ext_inst, function, result, kinds, operands, n);
}

LaneWords reals(float a, float b, float c, float d) { return {bits(a), bits(b), bits(c), bits(d)}; }
LaneWords wholes(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    return {bits(a), bits(b), bits(c), bits(d)};
}

using Binary = std::function<float(float, float)>;
using Unary = std::function<float(float)>;

void expect_binary(Op op, const Binary& formula) {
    const std::array<float, 4> x{1.5F, -7.25F, 0.0F, 3e30F}, y{-0.5F, 2.0F, 4.0F, 1e30F};
    const LaneWords got =
        apply(op, Of::real, {Of::real, Of::real}, {reals(x[0], x[1], x[2], x[3]), reals(y[0], y[1], y[2], y[3])});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(got[i], bits(formula(x[i], y[i]))) << name_of(op) << " lane " << i;
}

} // namespace

TEST(SpirvOperations, ArithmeticOfFloats) {
    expect_binary(Op::f_add, [](float x, float y) { return x + y; });
    expect_binary(Op::f_sub, [](float x, float y) { return x - y; });
    expect_binary(Op::f_mul, [](float x, float y) { return x * y; });
    expect_binary(Op::f_div, [](float x, float y) { return x / y; });
    expect_binary(Op::f_mod, [](float x, float y) { return x - y * std::floor(x / y); });
    expect_binary(Op::f_rem, [](float x, float y) { return x - y * std::trunc(x / y); });
    EXPECT_EQ(apply(Op::f_negate, Of::real, {Of::real}, {reals(0.0F, -0.0F, 1.0F, infinity)}),
              reals(-0.0F, 0.0F, -1.0F, -infinity));
    EXPECT_EQ(apply(Op::f_div, Of::real, {Of::real, Of::real}, {reals(1, -1, 0, 4), reals(0, 0, 5, infinity)}),
              reals(infinity, -infinity, 0, 0));
}

TEST(SpirvOperations, ComparisonsOfFloatsWithNan) {
    const LaneWords x = reals(1, 2, not_a_number, -0.0F), y = reals(2, 2, 1, 0);
    const auto compare = [&](Op op) { return apply(op, Of::truth, {Of::real, Of::real}, {x, y}); };
    EXPECT_EQ(compare(Op::f_ord_equal), (LaneWords{0, 1, 0, 1}));
    EXPECT_EQ(compare(Op::f_ord_not_equal), (LaneWords{1, 0, 0, 0}));
    EXPECT_EQ(compare(Op::f_ord_less_than), (LaneWords{1, 0, 0, 0}));
    EXPECT_EQ(compare(Op::f_ord_greater_than), (LaneWords{0, 0, 0, 0}));
    EXPECT_EQ(compare(Op::f_ord_less_than_equal), (LaneWords{1, 1, 0, 1}));
    EXPECT_EQ(compare(Op::f_ord_greater_than_equal), (LaneWords{0, 1, 0, 1}));
    EXPECT_EQ(compare(Op::f_unord_equal), (LaneWords{0, 1, 1, 1}));
    EXPECT_EQ(compare(Op::f_unord_not_equal), (LaneWords{1, 0, 1, 0}));
    EXPECT_EQ(compare(Op::f_unord_less_than), (LaneWords{1, 0, 1, 0}));
    EXPECT_EQ(compare(Op::f_unord_greater_than), (LaneWords{0, 0, 1, 0}));
    EXPECT_EQ(compare(Op::f_unord_less_than_equal), (LaneWords{1, 1, 1, 1}));
    EXPECT_EQ(compare(Op::f_unord_greater_than_equal), (LaneWords{0, 1, 1, 1}));
    EXPECT_EQ(apply(Op::is_nan, Of::truth, {Of::real}, {reals(not_a_number, infinity, 0, 1)}), (LaneWords{1, 0, 0, 0}));
    EXPECT_EQ(apply(Op::is_inf, Of::truth, {Of::real}, {reals(not_a_number, infinity, -infinity, 1)}),
              (LaneWords{0, 1, 1, 0}));
}

TEST(SpirvOperations, ArithmeticOfWholeNumbersWraps) {
    const std::int32_t least = std::numeric_limits<std::int32_t>::min();
    const auto both = [](Op op, LaneWords x, LaneWords y) {
        return apply(op, Of::whole, {Of::whole, Of::whole}, {x, y});
    };
    EXPECT_EQ(both(Op::i_add, wholes(1, -1, least, 7), wholes(2, 1, least, -9)), wholes(3, 0, 0, -2));
    EXPECT_EQ(both(Op::i_sub, wholes(1, -1, least, 7), wholes(2, 1, 1, -9)), wholes(-1, -2, 0x7FFFFFFF, 16));
    EXPECT_EQ(both(Op::i_mul, wholes(3, -3, 65536, 7), wholes(5, 5, 65536, -9)), wholes(15, -15, 0, -63));
    EXPECT_EQ(both(Op::s_div, wholes(7, -7, least, 5), wholes(2, 2, -1, 0)), wholes(3, -3, least, 0));
    EXPECT_EQ(both(Op::s_rem, wholes(7, -7, least, 5), wholes(4, 4, -1, 0)), wholes(3, -3, 0, 0));
    EXPECT_EQ(both(Op::s_mod, wholes(7, -7, 7, -8), wholes(4, 4, -4, 4)), wholes(3, 1, -1, 0));
    EXPECT_EQ(both(Op::u_div, wholes(7, -1, 9, 5), wholes(2, 2, 3, 0)), wholes(3, 0x7FFFFFFF, 3, 0));
    EXPECT_EQ(both(Op::u_mod, wholes(7, -1, 9, 5), wholes(2, 16, 3, 0)), wholes(1, 15, 0, 0));
    EXPECT_EQ(apply(Op::s_negate, Of::whole, {Of::whole}, {wholes(1, -5, 0, least)}), wholes(-1, 5, 0, least));
}

TEST(SpirvOperations, Bits) {
    const auto both = [](Op op, LaneWords x, LaneWords y) {
        return apply(op, Of::natural, {Of::natural, Of::natural}, {x, y});
    };
    const LaneWords x{0xF0F0F0F0, 1, 0x80000000, 12}, y{4, 31, 31, 33};
    EXPECT_EQ(both(Op::shift_left_logical, x, y), (LaneWords{0x0F0F0F00, 0x80000000, 0, 24}));
    EXPECT_EQ(both(Op::shift_right_logical, x, y), (LaneWords{0x0F0F0F0F, 0, 1, 6}));
    EXPECT_EQ(both(Op::shift_right_arithmetic, x, y), (LaneWords{0xFF0F0F0F, 0, 0xFFFFFFFF, 6}));
    EXPECT_EQ(both(Op::bitwise_and, x, y), (LaneWords{0, 1, 0, 0}));
    EXPECT_EQ(both(Op::bitwise_or, x, y), (LaneWords{0xF0F0F0F4, 31, 0x8000001F, 45}));
    EXPECT_EQ(both(Op::bitwise_xor, x, y), (LaneWords{0xF0F0F0F4, 30, 0x8000001F, 45}));
    EXPECT_EQ(apply(Op::bitwise_not, Of::natural, {Of::natural}, {x}),
              (LaneWords{0x0F0F0F0F, 0xFFFFFFFE, 0x7FFFFFFF, 0xFFFFFFF3}));
    EXPECT_EQ(apply(Op::bit_reverse, Of::natural, {Of::natural}, {x}),
              (LaneWords{0x0F0F0F0F, 0x80000000, 1, 0x30000000}));
    EXPECT_EQ(apply(Op::bit_count, Of::natural, {Of::natural}, {x}), (LaneWords{16, 1, 1, 2}));
    const auto field = [](Op op, LaneWords base, LaneWords offset, LaneWords count) {
        return apply(op, Of::natural, {Of::natural, Of::natural, Of::natural}, {base, offset, count}, 1);
    };
    const LaneWords offset{4, 0, 31, 8}, count{8, 32, 5, 0};
    EXPECT_EQ(field(Op::bit_field_u_extract, x, offset, count), (LaneWords{0x0F, 1, 1, 0}));
    EXPECT_EQ(field(Op::bit_field_s_extract, x, {4, 0, 31, 0}, {4, 32, 1, 4}),
              (LaneWords{0xFFFFFFFF, 1, 0xFFFFFFFF, 0xFFFFFFFC}));
    EXPECT_EQ(apply(Op::bit_field_insert, Of::natural, {Of::natural, Of::natural, Of::natural, Of::natural},
                    {x, {0xA, 0x1234, 1, 9}, offset, count}, 1),
              (LaneWords{0xF0F0F0A0 & ~0xF00U, 0x1234, 0x80000000, 12}));
}

TEST(SpirvOperations, ComparisonsOfWholeNumbers) {
    const LaneWords x = wholes(1, 2, -1, -5), y = wholes(2, 2, 1, -6);
    const auto compare = [&](Op op) { return apply(op, Of::truth, {Of::whole, Of::whole}, {x, y}); };
    EXPECT_EQ(compare(Op::i_equal), (LaneWords{0, 1, 0, 0}));
    EXPECT_EQ(compare(Op::i_not_equal), (LaneWords{1, 0, 1, 1}));
    EXPECT_EQ(compare(Op::s_less_than), (LaneWords{1, 0, 1, 0}));
    EXPECT_EQ(compare(Op::s_greater_than), (LaneWords{0, 0, 0, 1}));
    EXPECT_EQ(compare(Op::s_less_than_equal), (LaneWords{1, 1, 1, 0}));
    EXPECT_EQ(compare(Op::s_greater_than_equal), (LaneWords{0, 1, 0, 1}));
    EXPECT_EQ(compare(Op::u_less_than), (LaneWords{1, 0, 0, 0}));
    EXPECT_EQ(compare(Op::u_greater_than), (LaneWords{0, 0, 1, 1}));
    EXPECT_EQ(compare(Op::u_less_than_equal), (LaneWords{1, 1, 0, 0}));
    EXPECT_EQ(compare(Op::u_greater_than_equal), (LaneWords{0, 1, 1, 1}));
}

TEST(SpirvOperations, Logic) {
    const LaneWords x{0, 0, 1, 1}, y{0, 1, 0, 1};
    const auto both = [&](Op op) { return apply(op, Of::truth, {Of::truth, Of::truth}, {x, y}); };
    EXPECT_EQ(both(Op::logical_and), (LaneWords{0, 0, 0, 1}));
    EXPECT_EQ(both(Op::logical_or), (LaneWords{0, 1, 1, 1}));
    EXPECT_EQ(both(Op::logical_equal), (LaneWords{1, 0, 0, 1}));
    EXPECT_EQ(both(Op::logical_not_equal), (LaneWords{0, 1, 1, 0}));
    EXPECT_EQ(apply(Op::logical_not, Of::truth, {Of::truth}, {x}), (LaneWords{1, 1, 0, 0}));
    EXPECT_EQ(apply(Op::select, Of::real, {Of::truth, Of::real, Of::real}, {x, reals(1, 2, 3, 4), reals(5, 6, 7, 8)}),
              reals(5, 6, 3, 4));
}

TEST(SpirvOperations, Conversions) {
    EXPECT_EQ(apply(Op::convert_float_to_signed, Of::whole, {Of::real}, {reals(1.9F, -1.9F, 3e9F, not_a_number)}),
              wholes(1, -1, 0x7FFFFFFF, 0));
    EXPECT_EQ(
        apply(Op::convert_float_to_signed, Of::whole, {Of::real},
              {reals(-infinity, -0.5F, 2147483520.0F, -2147483648.0F)}),
        wholes(std::numeric_limits<std::int32_t>::min(), 0, 2147483520, std::numeric_limits<std::int32_t>::min()));
    EXPECT_EQ(apply(Op::convert_float_to_unsigned, Of::natural, {Of::real}, {reals(1.9F, -1.9F, 3e9F, infinity)}),
              (LaneWords{1, 0, 3000000000U, 0xFFFFFFFF}));
    EXPECT_EQ(apply(Op::convert_signed_to_float, Of::real, {Of::whole}, {wholes(1, -1, 16777217, 0)}),
              reals(1, -1, 16777216, 0));
    EXPECT_EQ(apply(Op::convert_unsigned_to_float, Of::real, {Of::natural}, {LaneWords{1, 0xFFFFFFFF, 0x80000000, 0}}),
              reals(1, 4294967296.0F, 2147483648.0F, 0));
    EXPECT_EQ(apply(Op::quantize_to_half, Of::real, {Of::real}, {reals(1.0F, 1.0001F, 1e6F, -0.1F)}),
              reals(1.0F, 1.0F, infinity, -0.0999755859375F));
    EXPECT_EQ(apply(Op::bitcast, Of::natural, {Of::real}, {reals(1, 2, 3, 4)}), reals(1, 2, 3, 4));
}

TEST(SpirvOperations, DifferencesWithinTheQuad) {
    const LaneWords v = reals(1, 3, 10, 17);
    const auto difference = [&](Op op) { return apply(op, Of::real, {Of::real}, {v}); };
    EXPECT_EQ(difference(Op::dpdx), reals(2, 2, 7, 7));
    EXPECT_EQ(difference(Op::dpdy), reals(9, 14, 9, 14));
    EXPECT_EQ(difference(Op::fwidth), reals(11, 16, 16, 21));
    EXPECT_EQ(difference(Op::dpdx_fine), reals(2, 2, 7, 7));
    EXPECT_EQ(difference(Op::dpdy_fine), reals(9, 14, 9, 14));
    EXPECT_EQ(difference(Op::fwidth_fine), reals(11, 16, 16, 21));
    EXPECT_EQ(difference(Op::dpdx_coarse), reals(2, 2, 2, 2));
    EXPECT_EQ(difference(Op::dpdy_coarse), reals(9, 9, 9, 9));
    EXPECT_EQ(difference(Op::fwidth_coarse), reals(11, 11, 11, 11));
}

TEST(SpirvOperations, RoundingKeepsSignsAndLargeNumbers) {
    const auto unary = [](Std450 f, LaneWords x) { return apply(f, Of::real, {Of::real}, {x}); };
    const LaneWords x = reals(2.5F, -2.5F, -0.25F, 1e20F);
    EXPECT_EQ(unary(Std450::floor, x), reals(2, -3, -1, 1e20F));
    EXPECT_EQ(unary(Std450::ceil, x), reals(3, -2, -0.0F, 1e20F));
    EXPECT_EQ(unary(Std450::trunc, x), reals(2, -2, -0.0F, 1e20F));
    EXPECT_EQ(unary(Std450::round_even, x), reals(2, -2, -0.0F, 1e20F));
    EXPECT_EQ(unary(Std450::round, reals(3.5F, -3.5F, 0.49999997F, -infinity)), reals(4, -4, 0, -infinity));
    EXPECT_EQ(unary(Std450::fract, reals(2.75F, -2.75F, 3.0F, 0.5F)), reals(0.75F, 0.25F, 0, 0.5F));
    EXPECT_EQ(unary(Std450::f_abs, x), reals(2.5F, 2.5F, 0.25F, 1e20F));
    EXPECT_EQ(unary(Std450::f_sign, reals(2, -2, 0, not_a_number)), reals(1, -1, 0, 0));
}

TEST(SpirvOperations, TranscendentalsAreThoseOfTheLibrary) {
    const std::array<float, 4> x{0.25F, 0.5F, 0.75F, 0.9375F};
    const auto expect = [&](Std450 function, const Unary& formula) {
        const LaneWords got = apply(function, Of::real, {Of::real}, {reals(x[0], x[1], x[2], x[3])});
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_EQ(got[i], bits(formula(x[i]))) << static_cast<std::uint32_t>(function) << " of " << x[i];
    };
    expect(Std450::sin, [](float v) { return std::sin(v); });
    expect(Std450::cos, [](float v) { return std::cos(v); });
    expect(Std450::tan, [](float v) { return std::tan(v); });
    expect(Std450::asin, [](float v) { return std::asin(v); });
    expect(Std450::acos, [](float v) { return std::acos(v); });
    expect(Std450::atan, [](float v) { return std::atan(v); });
    expect(Std450::sinh, [](float v) { return std::sinh(v); });
    expect(Std450::cosh, [](float v) { return std::cosh(v); });
    expect(Std450::tanh, [](float v) { return std::tanh(v); });
    expect(Std450::asinh, [](float v) { return std::asinh(v); });
    expect(Std450::acosh, [](float v) { return std::acosh(v); });
    expect(Std450::atanh, [](float v) { return std::atanh(v); });
    expect(Std450::exp, [](float v) { return std::exp(v); });
    expect(Std450::log, [](float v) { return std::log(v); });
    expect(Std450::exp2, [](float v) { return std::exp2(v); });
    expect(Std450::log2, [](float v) { return std::log2(v); });
    expect(Std450::sqrt, [](float v) { return std::sqrt(v); });
    expect(Std450::inverse_sqrt, [](float v) { return 1.0F / std::sqrt(v); });
    expect(Std450::radians, [](float v) { return v * 0.017453292519943295F; });
    expect(Std450::degrees, [](float v) { return v * 57.29577951308232F; });
    const LaneWords y = reals(1, -2, 0.5F, 3), a = reals(x[0], x[1], x[2], x[3]);
    EXPECT_EQ(apply(Std450::pow, Of::real, {Of::real, Of::real}, {a, y}),
              reals(0.25F, 4.0F, std::pow(0.75F, 0.5F), std::pow(0.9375F, 3.0F)));
    EXPECT_EQ(
        apply(Std450::atan2, Of::real, {Of::real, Of::real}, {a, y}),
        reals(std::atan2(0.25F, 1.0F), std::atan2(0.5F, -2.0F), std::atan2(0.75F, 0.5F), std::atan2(0.9375F, 3.0F)));
}

TEST(SpirvOperations, MinimaMixesAndSteps) {
    const std::vector<Of> two{Of::real, Of::real}, three{Of::real, Of::real, Of::real};
    EXPECT_EQ(apply(Std450::f_min, Of::real, two, {reals(1, 2, -3, 4), reals(2, 1, -4, 4)}), reals(1, 1, -4, 4));
    EXPECT_EQ(apply(Std450::f_max, Of::real, two, {reals(1, 2, -3, 4), reals(2, 1, -4, 4)}), reals(2, 2, -3, 4));
    EXPECT_EQ(
        apply(Std450::n_min, Of::real, two, {reals(not_a_number, 2, not_a_number, 4), reals(2, not_a_number, 5, 3)}),
        reals(2, 2, 5, 3));
    EXPECT_EQ(
        apply(Std450::n_max, Of::real, two, {reals(not_a_number, 2, not_a_number, 4), reals(2, not_a_number, 5, 3)}),
        reals(2, 2, 5, 4));
    EXPECT_EQ(apply(Std450::f_clamp, Of::real, three, {reals(-1, 0.5F, 2, 9), reals(0, 0, 0, 1), reals(1, 1, 1, 3)}),
              reals(0, 0.5F, 1, 3));
    EXPECT_EQ(apply(Std450::f_mix, Of::real, three, {reals(0, 1, 2, 4), reals(1, 3, 4, 8), reals(0.5F, 0, 1, 0.25F)}),
              reals(0.5F, 1, 4, 5));
    EXPECT_EQ(apply(Std450::step, Of::real, two, {reals(1, 1, 1, 1), reals(0.5F, 1, 2, -1)}), reals(0, 1, 1, 0));
    EXPECT_EQ(
        apply(Std450::smooth_step, Of::real, three, {reals(0, 0, 0, 0), reals(1, 1, 2, 1), reals(-1, 2, 1, 0.25F)}),
        reals(0, 1, 0.5F, 0.15625F));
    EXPECT_EQ(apply(Std450::fma, Of::real, three, {reals(2, 3, 4, 5), reals(6, 7, 8, 9), reals(1, 1, 1, 1)}),
              reals(13, 22, 33, 46));
    EXPECT_EQ(apply(Std450::ldexp, Of::real, {Of::real, Of::whole}, {reals(1, 1.5F, -1, 0), wholes(3, -1, 0, 200)}),
              reals(8, 0.75F, -1, 0));
    const std::vector<Of> signed_two{Of::whole, Of::whole}, natural_two{Of::natural, Of::natural};
    const LaneWords x = wholes(1, -2, -3, 4), y = wholes(2, 1, -4, 4);
    EXPECT_EQ(apply(Std450::s_min, Of::whole, signed_two, {x, y}), wholes(1, -2, -4, 4));
    EXPECT_EQ(apply(Std450::s_max, Of::whole, signed_two, {x, y}), wholes(2, 1, -3, 4));
    EXPECT_EQ(apply(Std450::u_min, Of::natural, natural_two, {x, y}), wholes(1, 1, -4, 4));
    EXPECT_EQ(apply(Std450::u_max, Of::natural, natural_two, {x, y}), wholes(2, -2, -3, 4));
    EXPECT_EQ(apply(Std450::s_clamp, Of::whole, {Of::whole, Of::whole, Of::whole},
                    {x, wholes(0, 0, 0, 0), wholes(2, 2, 2, 2)}),
              wholes(1, 0, 0, 2));
    EXPECT_EQ(apply(Std450::u_clamp, Of::natural, {Of::natural, Of::natural, Of::natural},
                    {x, wholes(0, 0, 0, 0), wholes(2, 2, 2, 2)}),
              wholes(1, 2, 2, 2));
    EXPECT_EQ(apply(Std450::s_abs, Of::whole, {Of::whole}, {x}), wholes(1, 2, 3, 4));
    EXPECT_EQ(apply(Std450::s_sign, Of::whole, {Of::whole}, {wholes(5, 0, -5, 1)}), wholes(1, 0, -1, 1));
    EXPECT_EQ(apply(Std450::find_i_lsb, Of::whole, {Of::whole}, {wholes(8, 0, 1, -1)}), wholes(3, -1, 0, 0));
    EXPECT_EQ(apply(Std450::find_u_msb, Of::natural, {Of::natural}, {wholes(8, 0, 1, -1)}), wholes(3, -1, 0, 31));
    EXPECT_EQ(apply(Std450::find_s_msb, Of::whole, {Of::whole}, {wholes(8, 0, -8, -1)}), wholes(3, -1, 2, -1));
}

} // namespace spirv_operations_test
