#include "models/programs/language/emitter.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace models::language {

namespace {

constexpr std::size_t most_instructions = 65535; ///< a jump's target has 16 bits

/// Lets `before` do `next` as well, if both are products of one factor whose other operands lie side by side.
bool continue_products(Instruction& before, Instruction& next) {
    if (before.code != Opcode::multiply_add || before.count == std::numeric_limits<std::uint8_t>::max()) return false;
    if (before.count == 1 && before.c != next.c && before.c != next.d) std::swap(before.c, before.d);
    if (before.c != next.c) std::swap(next.c, next.d);
    const auto is_beside = [&before](Operand first, Operand now) { return now == first + before.count; };
    if (before.c != next.c || !is_beside(before.a, next.a) || !is_beside(before.b, next.b) ||
        !is_beside(before.d, next.d))
        return false;
    ++before.count;
    return true;
}

} // namespace

void Emitter::emit(Instruction instruction) {
    if (code_.instructions.size() == most_instructions)
        complain(source_, place_, fmt::format("at most {} instructions when loops are unrolled", most_instructions),
                 "more");
    code_.instructions.push_back(instruction);
}

std::size_t Emitter::emit_jump(Instruction instruction) {
    emit(instruction);
    return code_.instructions.size() - 1;
}

void Emitter::aim(std::size_t jump) {
    last_aim_ = code_.instructions.size();
    code_.instructions[jump].d = static_cast<Operand>(last_aim_);
}

void Emitter::emit_product(Instruction instruction) {
    if (code_.instructions.size() > last_aim_ && continue_products(code_.instructions.back(), instruction)) return;
    emit(instruction);
}

bool Emitter::join_swap(std::size_t jump) {
    if (code_.instructions.size() != jump + 2) return false;
    const Instruction swap = code_.instructions[jump + 1];
    Instruction& test = code_.instructions[jump];
    const bool strict = test.code == Opcode::unless_less;
    if (swap.code != Opcode::swap || (!strict && test.code != Opcode::unless_less_or_equal)) return false;
    test = {strict ? Opcode::swap_if_less : Opcode::swap_if_less_or_equal, swap.count, swap.a, test.b, test.c, swap.b};
    code_.instructions.pop_back();
    return true;
}

Operand Emitter::temporary() {
    if (next_temporary_ >= most_locals)
        complain(source_, place_, fmt::format("at most {} variables and intermediate results", most_locals), "more");
    return operand(Bank::locals, next_temporary_++);
}

Operand Emitter::read(const Value& value) { return value.constant ? pooled(value.number) : value.operand; }

Operand Emitter::pooled(float number) {
    const auto same = [number](float other) {
        return std::bit_cast<std::uint32_t>(other) == std::bit_cast<std::uint32_t>(number);
    };
    const auto found = std::find_if(code_.constants.begin(), code_.constants.end(), same);
    const auto place = static_cast<std::uint32_t>(found - code_.constants.begin());
    if (found == code_.constants.end()) {
        if (place == most_constants)
            complain(source_, place_, fmt::format("at most {} constants", most_constants), "more");
        code_.constants.push_back(number);
    }
    return operand(Bank::constants, place);
}

Operand Emitter::placed(Operand operand) const {
    const std::uint32_t place = operand % bank_size;
    switch (static_cast<Bank>(operand / bank_size)) {
    case Bank::pixel:
        break;
    case Bank::locals:
        return static_cast<Operand>(own_floats + code_.constants.size() + place);
    case Bank::constants:
        return static_cast<Operand>(own_floats + place);
    }
    return operand;
}

Code Emitter::take() {
    emit({});
    code_.constants.resize((code_.constants.size() + 3) / 4 * 4);
    for (Instruction& one : code_.instructions) {
        const bool names_field = one.code == Opcode::load || one.code == Opcode::store;
        one.a = placed(one.a);
        one.b = placed(one.b);
        if (!names_field) one.c = placed(one.c);
        if (!jumps(one.code)) one.d = placed(one.d);
    }
    return std::move(code_);
}

} // namespace models::language
