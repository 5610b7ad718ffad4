// Arithmetic of whole numbers, bits, truths. It wraps; what GLSL leaves undefined has one value here: a division by
// zero gives 0, a shift counts modulo 32, bit fields end at bit 31.
#include "traces/spirv/component_wise.hpp"

#include <algorithm>
#include <bit>

namespace traces::spirv {

// Named, as other files have functions of the same names.
namespace whole_lanes {
namespace {

Words negative(Words x) { return -x; }
Words sum(Words x, Words y) { return x + y; }
Words difference(Words x, Words y) { return x - y; }
Words product(Words x, Words y) { return x * y; }

template <std::uint32_t (*function)(std::uint32_t, std::uint32_t)>
Words by_word(Words x, Words y) {
    return Words{function(x[0], y[0]), function(x[1], y[1]), function(x[2], y[2]), function(x[3], y[3])};
}
template <std::uint32_t (*function)(std::uint32_t)>
Words by_word(Words x) {
    return Words{function(x[0]), function(x[1]), function(x[2]), function(x[3])};
}

std::int64_t wide(std::uint32_t word) { return static_cast<std::int32_t>(word); }
std::uint32_t narrow(std::int64_t number) { return static_cast<std::uint32_t>(number); }

std::uint32_t quotient(std::uint32_t x, std::uint32_t y) { return y == 0 ? 0 : x / y; }
std::uint32_t modulo(std::uint32_t x, std::uint32_t y) { return y == 0 ? 0 : x % y; }
std::uint32_t signed_quotient(std::uint32_t x, std::uint32_t y) { return y == 0 ? 0 : narrow(wide(x) / wide(y)); }
std::uint32_t signed_remainder(std::uint32_t x, std::uint32_t y) { return y == 0 ? 0 : narrow(wide(x) % wide(y)); }
std::uint32_t signed_modulo(std::uint32_t x, std::uint32_t y) { // the sign of the divisor
    if (y == 0) return 0;
    const std::int64_t rest = wide(x) % wide(y);
    return narrow(rest != 0 && (rest < 0) != (wide(y) < 0) ? rest + wide(y) : rest);
}

Words left(Words x, Words y) { return x << (y & same(31U)); }
Words right(Words x, Words y) { return x >> (y & same(31U)); }
Words right_signed(Words x, Words y) { return words(wholes(x) >> wholes(y & same(31U))); }
Words both(Words x, Words y) { return x & y; }
Words either(Words x, Words y) { return x | y; }
Words one_of(Words x, Words y) { return x ^ y; }
Words inverted(Words x) { return ~x; }
Words same_truth(Words x, Words y) { return ~(x ^ y); }
Words chosen(Words mask, Words x, Words y) { return pick(mask, x, y); }

Words equal(Words x, Words y) { return words(x == y); }
Words unequal(Words x, Words y) { return words(x != y); }
Words less(Words x, Words y) { return words(x < y); }
Words greater(Words x, Words y) { return words(x > y); }
Words less_or_equal(Words x, Words y) { return words(x <= y); }
Words greater_or_equal(Words x, Words y) { return words(x >= y); }
Words signed_less(Wholes x, Wholes y) { return words(x < y); }
Words signed_greater(Wholes x, Wholes y) { return words(x > y); }
Words signed_less_or_equal(Wholes x, Wholes y) { return words(x <= y); }
Words signed_greater_or_equal(Wholes x, Wholes y) { return words(x >= y); }

std::uint32_t reversed(std::uint32_t x) {
    std::uint32_t result = 0;
    for (unsigned i = 0; i < 32; ++i) result |= (x >> i & 1U) << (31U - i);
    return result;
}
std::uint32_t ones(std::uint32_t x) { return static_cast<std::uint32_t>(std::popcount(x)); }

constexpr auto table = std::to_array<ComponentWise>({
    row<negative>(Op::s_negate, "ii"),
    row<sum>(Op::i_add, "iii"),
    row<difference>(Op::i_sub, "iii"),
    row<product>(Op::i_mul, "iii"),
    row<by_word<quotient>>(Op::u_div, "iii"),
    row<by_word<modulo>>(Op::u_mod, "iii"),
    row<by_word<signed_quotient>>(Op::s_div, "iii"),
    row<by_word<signed_remainder>>(Op::s_rem, "iii"),
    row<by_word<signed_modulo>>(Op::s_mod, "iii"),
    row<left>(Op::shift_left_logical, "iii"),
    row<right>(Op::shift_right_logical, "iii"),
    row<right_signed>(Op::shift_right_arithmetic, "iii"),
    row<both>(Op::bitwise_and, "iii"),
    row<either>(Op::bitwise_or, "iii"),
    row<one_of>(Op::bitwise_xor, "iii"),
    row<inverted>(Op::bitwise_not, "ii"),
    row<by_word<reversed>>(Op::bit_reverse, "ii"),
    row<by_word<ones>>(Op::bit_count, "ii"),
    row<equal>(Op::i_equal, "bii"),
    row<unequal>(Op::i_not_equal, "bii"),
    row<less>(Op::u_less_than, "bii"),
    row<greater>(Op::u_greater_than, "bii"),
    row<less_or_equal>(Op::u_less_than_equal, "bii"),
    row<greater_or_equal>(Op::u_greater_than_equal, "bii"),
    row<signed_less>(Op::s_less_than, "bii"),
    row<signed_greater>(Op::s_greater_than, "bii"),
    row<signed_less_or_equal>(Op::s_less_than_equal, "bii"),
    row<signed_greater_or_equal>(Op::s_greater_than_equal, "bii"),
    row<both>(Op::logical_and, "bbb"),
    row<either>(Op::logical_or, "bbb"),
    row<inverted>(Op::logical_not, "bb"),
    row<same_truth>(Op::logical_equal, "bbb"),
    row<one_of>(Op::logical_not_equal, "bbb"),
    row<chosen>(Op::select, "xbxx"),
});

} // namespace
} // namespace whole_lanes

namespace {

struct Field {
    std::uint32_t offset = 0, mask = 0;
};
/// `count` bits from `offset` on, as far as the word has them.
Field field_of(std::uint32_t offset, std::uint32_t count) {
    const std::uint32_t first = std::min(offset, 32U), size = std::min(count, 32U - first);
    return {first & 31U, size == 0 ? 0U : (size == 32 ? ~0U : (1U << size) - 1)};
}

} // namespace

std::span<const ComponentWise> whole_operations() { return whole_lanes::table; }

void bit_field_extract(Run& run, const Operation& operation) {
    for (int lane = 0; lane < 4; ++lane) {
        const Field field = field_of(run.file[operation.b][lane], run.file[operation.d][lane]);
        for (Slot i = 0; i < operation.c; ++i)
            run.file[operation.result + i][lane] = run.file[operation.a + i][lane] >> field.offset & field.mask;
    }
}

void bit_field_extract_signed(Run& run, const Operation& operation) {
    bit_field_extract(run, operation);
    for (int lane = 0; lane < 4; ++lane) {
        const std::uint32_t mask = field_of(run.file[operation.b][lane], run.file[operation.d][lane]).mask;
        const std::uint32_t top = mask ^ mask >> 1U;
        for (Slot i = 0; i < operation.c; ++i) {
            std::uint32_t word = run.file[operation.result + i][lane];
            if ((word & top) != 0) word |= ~mask;
            run.file[operation.result + i][lane] = word;
        }
    }
}

void bit_field_insert(Run& run, const Operation& operation) {
    const auto* places = run.program->lists.data() + operation.d;
    const Words offsets = run.file[static_cast<Slot>(places[0])], counts = run.file[static_cast<Slot>(places[1])];
    for (int lane = 0; lane < 4; ++lane) {
        const Field field = field_of(offsets[lane], counts[lane]);
        for (Slot i = 0; i < operation.c; ++i) {
            const std::uint32_t base = run.file[operation.a + i][lane], inserted = run.file[operation.b + i][lane];
            run.file[operation.result + i][lane] = (base & ~(field.mask << field.offset)) | (inserted & field.mask)
                                                                                                << field.offset;
        }
    }
}

// The second part of each pair is a carry, a borrow or the high words.
void add_carry(Run& run, const Operation& operation) {
    for (Slot i = 0; i < operation.c; ++i) {
        const Words a = run.file[operation.a + i], total = a + run.file[operation.b + i];
        run.file[operation.result + i] = total;
        run.file[operation.result + operation.c + i] = words(total < a) & same(1U);
    }
}

void subtract_borrow(Run& run, const Operation& operation) {
    for (Slot i = 0; i < operation.c; ++i) {
        const Words a = run.file[operation.a + i], b = run.file[operation.b + i];
        run.file[operation.result + i] = a - b;
        run.file[operation.result + operation.c + i] = words(a < b) & same(1U);
    }
}

namespace {

template <class Wide, class Narrow>
void multiply(Run& run, const Operation& operation) {
    for (Slot i = 0; i < operation.c; ++i)
        for (int lane = 0; lane < 4; ++lane) {
            const auto a = static_cast<Narrow>(run.file[operation.a + i][lane]);
            const auto b = static_cast<Narrow>(run.file[operation.b + i][lane]);
            const auto whole = static_cast<std::uint64_t>(Wide{a} * Wide{b});
            run.file[operation.result + i][lane] = static_cast<std::uint32_t>(whole);
            run.file[operation.result + operation.c + i][lane] = static_cast<std::uint32_t>(whole >> 32U);
        }
}

} // namespace

void multiply_extended(Run& run, const Operation& operation) { multiply<std::uint64_t, std::uint32_t>(run, operation); }
void multiply_extended_signed(Run& run, const Operation& operation) {
    multiply<std::int64_t, std::int32_t>(run, operation);
}

} // namespace traces::spirv
