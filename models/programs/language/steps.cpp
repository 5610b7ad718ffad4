#include "models/programs/language/steps.hpp"

#include "models/programs/language/arithmetic.hpp"
#include "sim/check.hpp"

#include <array>
#include <bit>
#include <limits>
#include <utility>

namespace models::language {

namespace {

/// Bits of a mask that says which operands lie in the pixel.
constexpr std::uint32_t a_bit = 1, b_bit = 2, c_bit = 4, d_bit = 8, masks = 16;

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

template <std::uint32_t in_pixel>
float* bank(float* pixel, Frame& frame) {
    return in_pixel != 0 ? pixel : frame.own.data();
}

template <bool in_pixel>
void write(float* pixel, Frame& frame, Operand place, float value) {
    if constexpr (in_pixel) {
        frame.changed |= bits(pixel[place]) ^ bits(value);
        pixel[place] = value;
    } else {
        frame.own[place] = value;
    }
}

// Operations on up to three operands.
float move(float b, float, float) { return b; }
float negate(float b, float, float) { return -b; }
float invert(float b, float, float) { return 1.0F - b; }
float magnitude(float b, float, float) { return std::abs(b); }
float truncate(float b, float, float) { return truncated(b); }
float add(float b, float c, float) { return finite(b + c); }
float subtract(float b, float c, float) { return finite(b - c); }
float multiply(float b, float c, float) { return finite(b * c); }
float divide(float b, float c, float) { return quotient(b, c); }
float divide_whole(float b, float c, float) { return whole_quotient(b, c); }
float least(float b, float c, float) { return std::min(b, c); }
float greatest(float b, float c, float) { return std::max(b, c); }
float less(float b, float c, float) { return b < c ? 1.0F : 0.0F; }
float less_or_equal(float b, float c, float) { return b <= c ? 1.0F : 0.0F; }
float equal(float b, float c, float) { return b == c ? 1.0F : 0.0F; }
float not_equal(float b, float c, float) { return b != c ? 1.0F : 0.0F; }
float choose(float b, float c, float d) { return b != 0.0F ? c : d; }

using Operation = float (*)(float, float, float);

template <std::uint32_t mask, Operation operation>
const Step* compute(const Step* at, float* pixel, Frame& frame) {
    const Step& step = *at++;
    const float b = bank<mask & b_bit>(pixel, frame)[step.b];
    const float c = bank<mask & c_bit>(pixel, frame)[step.c];
    const float d = bank<mask & d_bit>(pixel, frame)[step.d];
    write<(mask & a_bit) != 0>(pixel, frame, step.a, operation(b, c, d));
    return at;
}

float product_added(float b, float c, float d) { return finite(b + finite(c * d)); }

template <std::uint32_t mask>
const Step* multiply_add(const Step* at, float* pixel, Frame& frame) {
    const Step& step = *at++;
    float* const a = bank<mask & a_bit>(pixel, frame) + step.a;
    const float* const b = bank<mask & b_bit>(pixel, frame) + step.b;
    const float* const c = bank<mask & c_bit>(pixel, frame) + step.c;
    const float* const d = bank<mask & d_bit>(pixel, frame) + step.d;
    std::uint32_t changed = 0;
    for (std::uint32_t i = 0, count = step.count; i < count; ++i) {
        float sum = b[i] + *c * d[i];
        if (!(std::abs(sum) <= std::numeric_limits<float>::max())) // else the product was finite, too
            sum = product_added(b[i], *c, d[i]);
        changed |= bits(a[i]) ^ bits(sum);
        a[i] = sum;
    }
    if constexpr ((mask & a_bit) != 0) frame.changed |= changed;
    return at;
}

using Condition = bool (*)(float, float);

bool is_true(float b, float) { return b != 0.0F; }
bool is_less(float b, float c) { return b < c; }
bool is_less_or_equal(float b, float c) { return b <= c; }
bool is_equal(float b, float c) { return b == c; }
bool is_not_equal(float b, float c) { return b != c; }

template <std::uint32_t mask, Condition condition>
const Step* jump_unless(const Step* at, float* pixel, Frame& frame) {
    const Step& step = *at;
    const bool holds = condition(bank<mask & b_bit>(pixel, frame)[step.b], bank<mask & c_bit>(pixel, frame)[step.c]);
    return at + (holds ? 1U : step.d);
}

template <std::uint32_t>
const Step* jump(const Step* at, float*, Frame&) {
    return at + at->d;
}

template <std::uint32_t mask>
const Step* move_many(const Step* at, float* pixel, Frame& frame) {
    const Step& step = *at++;
    const float* const from = bank<mask & b_bit>(pixel, frame) + step.b;
    for (std::uint32_t i = 0; i < step.count; ++i)
        write<(mask & a_bit) != 0>(pixel, frame, static_cast<Operand>(step.a + i), from[i]);
    return at;
}

/// Returns the bits that differed.
template <std::uint32_t count>
inline std::uint32_t exchange(float* a, float* b) {
    std::array<float, count> of_a, of_b;
    std::copy_n(a, count, of_a.begin());
    std::copy_n(b, count, of_b.begin());
    std::copy_n(of_b.begin(), count, a);
    std::copy_n(of_a.begin(), count, b);
    std::uint32_t different = 0;
    for (std::uint32_t i = 0; i < count; ++i) different |= bits(of_a[i]) ^ bits(of_b[i]);
    return different;
}

template <std::uint32_t mask, std::uint32_t other_bit, bool is_target>
inline void exchange(const Step& step, Operand other, float* pixel, Frame& frame) {
    float* const a = bank<mask & a_bit>(pixel, frame) + step.a;
    float* const b = bank<mask & other_bit>(pixel, frame) + other;
    std::uint32_t different = 0;
    if constexpr (is_target)
        different = exchange<4>(a, b);
    else
        for (std::uint32_t i = 0; i < step.count; ++i) different |= exchange<1>(a + i, b + i);
    if constexpr ((mask & (a_bit | other_bit)) != 0) frame.changed |= different;
}

/// @tparam is_target  four floats are exchanged: an entry is a render target most often
template <std::uint32_t mask, bool is_target>
const Step* swap(const Step* at, float* pixel, Frame& frame) {
    const Step& step = *at++;
    exchange<mask, b_bit, is_target>(step, step.b, pixel, frame);
    return at;
}

/// All such steps in a row: sorting is made of them.
template <std::uint32_t mask, Condition condition, bool is_target>
const Step* swap_if(const Step* at, float* pixel, Frame& frame) {
    const Step::Function same = at->run;
    do {
        const Step& step = *at++;
        if (condition(bank<mask & b_bit>(pixel, frame)[step.b], bank<mask & c_bit>(pixel, frame)[step.c]))
            exchange<mask, d_bit, is_target>(step, step.d, pixel, frame);
    } while (at->run == same);
    return at;
}

/// Field c of the entry whose number is in `index`, cut to the entries there are.
std::uint32_t entry_field(const Step& step, float index) {
    const auto entry = static_cast<std::uint32_t>(std::clamp(index, 0.0F, static_cast<float>(step.count)));
    return entry * step.d + step.c;
}

template <std::uint32_t mask>
const Step* load(const Step* at, float* pixel, Frame& frame) {
    const Step& step = *at++;
    const float value = pixel[entry_field(step, bank<mask & b_bit>(pixel, frame)[step.b])];
    write<(mask & a_bit) != 0>(pixel, frame, step.a, value);
    return at;
}

template <std::uint32_t mask>
const Step* store(const Step* at, float* pixel, Frame& frame) {
    const Step& step = *at++;
    const auto place = static_cast<Operand>(entry_field(step, bank<mask & b_bit>(pixel, frame)[step.b]));
    write<true>(pixel, frame, place, bank<mask & a_bit>(pixel, frame)[step.a]);
    return at;
}

using Functions = std::array<Step::Function, masks>;

template <std::size_t... mask, class Make>
constexpr Functions each_mask(std::index_sequence<mask...>, Make make) {
    return {make.template operator()<static_cast<std::uint32_t>(mask)>()...};
}

template <class Make>
constexpr Functions each_mask(Make make) {
    return each_mask(std::make_index_sequence<masks>(), make);
}

/// @tparam operands  bits of those that it reads
template <Operation operation, std::uint32_t operands>
constexpr Functions computing = each_mask([]<std::uint32_t mask>() {
    return &compute<mask&(operands | a_bit), operation>;
});

template <Condition condition, std::uint32_t operands>
constexpr Functions jumping = each_mask([]<std::uint32_t mask>() { return &jump_unless<mask & operands, condition>; });

template <Condition condition, bool is_target>
constexpr Functions swapping = each_mask([]<std::uint32_t mask>() { return &swap_if<mask, condition, is_target>; });

constexpr std::uint32_t of_one = b_bit, of_two = b_bit | c_bit, of_three = b_bit | c_bit | d_bit;

const Functions& functions_of(const Instruction& instruction) {
    static constexpr Functions jumps = each_mask([]<std::uint32_t>() { return &jump<0>; });
    static constexpr Functions moves = each_mask([]<std::uint32_t mask>() { return &move_many<mask & 3U>; });
    static constexpr Functions swaps = each_mask([]<std::uint32_t mask>() { return &swap<mask & 3U, false>; });
    static constexpr Functions target_swaps = each_mask([]<std::uint32_t mask>() { return &swap<mask & 3U, true>; });
    static constexpr Functions products = each_mask([]<std::uint32_t mask>() { return &multiply_add<mask>; });
    static constexpr Functions loads = each_mask([]<std::uint32_t mask>() { return &load<mask & 3U>; });
    static constexpr Functions stores = each_mask([]<std::uint32_t mask>() { return &store<mask & 3U>; });
    const bool is_target = instruction.count == 4;
    switch (instruction.code) {
    case Opcode::end:
        break;
    case Opcode::move:
        return instruction.count == 1 ? computing<move, of_one> : moves;
    case Opcode::swap:
        return is_target ? target_swaps : swaps;
    case Opcode::swap_if_less:
        return is_target ? swapping<is_less, true> : swapping<is_less, false>;
    case Opcode::swap_if_less_or_equal:
        return is_target ? swapping<is_less_or_equal, true> : swapping<is_less_or_equal, false>;
    case Opcode::load:
        return loads;
    case Opcode::store:
        return stores;
    case Opcode::negate:
        return computing<negate, of_one>;
    case Opcode::invert:
        return computing<invert, of_one>;
    case Opcode::magnitude:
        return computing<magnitude, of_one>;
    case Opcode::truncate:
        return computing<truncate, of_one>;
    case Opcode::add:
        return computing<add, of_two>;
    case Opcode::subtract:
        return computing<subtract, of_two>;
    case Opcode::multiply:
        return computing<multiply, of_two>;
    case Opcode::divide:
        return computing<divide, of_two>;
    case Opcode::divide_whole:
        return computing<divide_whole, of_two>;
    case Opcode::least:
        return computing<least, of_two>;
    case Opcode::greatest:
        return computing<greatest, of_two>;
    case Opcode::multiply_add:
        return products;
    case Opcode::less:
        return computing<less, of_two>;
    case Opcode::less_or_equal:
        return computing<less_or_equal, of_two>;
    case Opcode::equal:
        return computing<equal, of_two>;
    case Opcode::not_equal:
        return computing<not_equal, of_two>;
    case Opcode::choose:
        return computing<choose, of_three>;
    case Opcode::jump:
        return jumps;
    case Opcode::jump_if_false:
        return jumping<is_true, of_one>;
    case Opcode::unless_less:
        return jumping<is_less, of_two>;
    case Opcode::unless_less_or_equal:
        return jumping<is_less_or_equal, of_two>;
    case Opcode::unless_equal:
        return jumping<is_equal, of_two>;
    case Opcode::unless_not_equal:
        return jumping<is_not_equal, of_two>;
    }
    CHECK(false);
}

} // namespace

Step::Function function_of(const Instruction& instruction, std::uint32_t in_pixel) {
    return functions_of(instruction)[in_pixel];
}

} // namespace models::language
