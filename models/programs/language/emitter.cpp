#include "models/programs/language/emitter.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <utility>

namespace models::language {

namespace {

constexpr std::size_t most_instructions = 65535; ///< a jump's target has 16 bits

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

void Emitter::aim(std::size_t jump) { code_.instructions[jump].d = static_cast<Operand>(code_.instructions.size()); }

Operand Emitter::temporary() {
    if (next_temporary_ >= most_locals)
        complain(source_, place_, fmt::format("at most {} variables and intermediate results", most_locals), "more");
    code_.locals = std::max(code_.locals, next_temporary_ + 1);
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
        if (place == bank_size) complain(source_, place_, fmt::format("at most {} constants", bank_size), "more");
        code_.constants.push_back(number);
    }
    return operand(Bank::constants, place);
}

Code Emitter::take() {
    emit({});
    code_.locals = std::max(code_.locals, first_temporary_);
    return std::move(code_);
}

} // namespace models::language
